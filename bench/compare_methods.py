#!/usr/bin/env python3
"""The same motions by every method of dynamics: wall time per simulated second, and the ratios.

For each shipped dynamic scene the first part of the motion, before it depends on every rounding, is found once by the
implicit method in very short steps. Then each method is run at the cheapest step at which every node stays within 1 %
of the strip's length of that motion, at ten times:

- `implicit`: steps of 1/10, 1/20, ... of the stretch; of those from which on all are near enough the one counts that costs
  least, because steps that fail are divided and tried again;
- `direct`: the two-stage method, which divides its steps by its own stability bound, so that the step is the longest
  stable one. Its coupling is soft: it converges to the motion only as alpha grows, so alpha is raised until it is near;
- `printed`: Algorithm 1 as printed, with Gauss-Seidel, at that alpha and that step. It is slow: as many of its first
  steps are run as --budget allows, and their time is scaled. It grows as the strip leaves its plane, so that this is
  less than the whole would take. How far it then is from the motion is printed, not asked for;
- `gauss-seidel`: L-BFGS and the Gauss-Seidel projection on the repaired objective, treated in the same way.

All take the paper's kinetic energy (masses on the centerline, no inertia of turning about it), but in free flight, where
that inertia carries the motion.

    python3 bench/compare_methods.py --program build/release/wunderlich [--quick] [--scene NAME]

Timed runs of `implicit` and `direct` are repeated in turn, the shortest counts. A run that takes longer than --timeout
is ended and marked.
"""

import argparse
import json
import math
import struct
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

SAMPLES = 10  # times at which shapes are compared
NEAR = 0.01  # of the strip's length
DIVISIONS = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96]  # steps of `implicit` between two of these times
FINE = 512  # the same of the motion that all are held against
ALPHAS = [10, 30, 100, 300, 1000, 3000, 10000]
TRIAL_STEPS = 10  # of a method too slow to run whole


@dataclass
class Case:
    name: str
    stretch: float  # s
    planar: bool = False
    rotary: bool = False  # the inertia of the width counts
    scene: str = ""
    extra: list = field(default_factory=list)


CASES = [
    Case("swing", 0.4),
    Case("swing in its plane", 0.4, planar=True, scene="swing", extra=["gravity=[0,0,-5]"]),
    Case("twist-release-stiff", 0.25),
    Case("twist-release-soft", 0.25),
    Case("belt-release-stiff", 0.3),
    Case("belt-release-soft", 0.3),
    Case("free-flight", 0.3, rotary=True),
]


@dataclass
class Run:
    seconds: float = math.inf  # of wall time in steps
    shapes: list = field(default_factory=list)  # nodes at the recorded times
    failure: str = ""


class Runner:
    def __init__(self, program, timeout):
        self.program = program
        self.timeout = timeout

    def run(self, case, settings):
        """One run of the program."""
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "run"
            command = [self.program, "run", case.scene or case.name, "--out", str(out), "--quiet", "--formats", "pc2"]
            common = ["output.subdivision=1", "output.across=1", f"output.frames={SAMPLES + 1}"]
            for setting in common + case.extra + settings:
                command += ["--set", setting]
            try:
                done = subprocess.run(command, capture_output=True, text=True, timeout=self.timeout)
            except subprocess.TimeoutExpired:
                return Run(failure=f"> {self.timeout:g} s")
            summary_file = out / "summary.json"
            if not summary_file.exists():
                sys.exit(f"{' '.join(command)}\n{done.stderr}")
            summary = json.loads(summary_file.read_text())
            if done.returncode != 0:
                return Run(failure=(done.stderr.strip().splitlines() or ["failed"])[-1])
            return Run(summary["timing"]["wall_seconds"], read_shapes(out / "ribbon.pc2"))


def read_shapes(path):
    """The centerline in each recorded frame: the middles of the surface's two points at each node."""
    data = path.read_bytes()
    points, _, _, frames = struct.unpack("<iffi", data[16:32])
    shapes = []
    for frame in range(frames):
        values = struct.unpack_from(f"<{3 * points}f", data, 32 + 12 * points * frame)
        rims = [values[6 * i : 6 * i + 6] for i in range(points // 2)]
        shapes.append([[0.5 * (rim[i] + rim[i + 3]) for i in range(3)] for rim in rims])
    return shapes


def distance(shapes, reference):
    """Largest distance of two nodes; infinite where one motion is shorter."""
    if len(shapes) != len(reference):
        return math.inf
    return max(math.dist(a, b) for one, other in zip(shapes, reference) for a, b in zip(one, other))


def stretch_of(case, divisions, stretch=None):
    stretch = stretch or case.stretch
    return [f"solver.duration={stretch!r}", f"solver.time_step={stretch / (SAMPLES * divisions)!r}"]


def implicit(case, divisions):
    kinetic = "rotary" if case.rotary else "centerline"
    return ["solver.method=implicit", f"solver.kinetic_energy={kinetic}", *stretch_of(case, divisions)]


def two_stage(case, alpha):
    return [
        "solver.method=two-stage",
        f"solver.weight_scale={alpha}",
        f"solver.torsional_inertia={int(case.rotary)}",
        "solver.substeps=true",
    ]


# Rates instead of the printed factors, which at steps this short would stop the motion.
PRINTED = ["solver.form=printed", "solver.damping.tangent=0", "solver.damping.normal=0"]
GAUSS_SEIDEL = ["solver.projection=gauss-seidel"]


def bound(length, ribbon, alpha):
    """The stability bound of stage ode: 2/sqrt(38.4 alpha D/(rho l^4)), l a segment's length."""
    cell = length / ribbon["segments"]
    return 2 / math.sqrt(38.4 * alpha * ribbon["bending_stiffness"] / (ribbon["area_density"] * cell**4))


def ribbon_of(case, scenes):
    """The strip's numbers, read from the scene's own block of plain keys."""
    ribbon = {}
    for line in (scenes / f"{case.scene or case.name}.yaml").read_text().split("ribbon:")[1].splitlines()[1:]:
        if not line.startswith("  "):
            break
        key, value = line.split("#")[0].split(":")
        ribbon[key.strip()] = float(value)
    return ribbon


def time_of_steps(runner, case, alpha, step, settings, budget, reference):
    """Wall seconds per simulated second of a method that may be too slow to run whole; the share that was run."""

    def first(steps):
        chosen = [f"solver.duration={step * steps!r}", f"solver.time_step={step!r}"]
        return runner.run(case, two_stage(case, alpha) + chosen + settings)

    most = SAMPLES * math.ceil(case.stretch / step / SAMPLES)
    step = case.stretch / most
    steps, run = TRIAL_STEPS, first(TRIAL_STEPS)
    while not run.failure and steps < most and run.seconds < 0.4 * budget:
        steps = min(most, max(2 * steps, int(0.7 * steps * budget / max(run.seconds, 1e-3))), 20 * steps)
        longer = first(steps)
        if longer.failure:
            return run.seconds / (step * steps), steps / most, longer.failure
        run = longer
    if run.failure:
        return math.inf, 0, run.failure
    note = f"{distance(run.shapes, reference.shapes):.1e} m off" if steps == most else ""
    return run.seconds / (step * steps), steps / most, note


def nearest(found):
    return min((entry for entry in found if math.isfinite(entry[1])), key=lambda e: e[1], default=None)


def compare(runner, case, scenes, repeats, budget):
    ribbon = ribbon_of(case, scenes)
    length = ribbon["length"]
    log(f"{case.name}: the motion in {SAMPLES * FINE} steps")
    reference = runner.run(case, implicit(case, FINE))
    coarser = runner.run(case, implicit(case, FINE // 2))
    row = {"scene": case.name, "stretch": case.stretch, "planar": case.planar}
    if reference.failure or coarser.failure:
        row["note"] = f"no motion to hold against: {reference.failure or coarser.failure}"
        return row
    row["own_error"] = distance(coarser.shapes, reference.shapes) / length
    near = []
    for divisions in DIVISIONS:
        run = runner.run(case, implicit(case, divisions))
        error = distance(run.shapes, reference.shapes) / length
        step = 1e3 * case.stretch / SAMPLES / divisions
        log(f"  implicit, step {step:.3g} ms: {run.failure or f'{error:.2%} in {1e3 * run.seconds:.3g} ms'}")
        if error < NEAR:
            near.append((run.seconds, divisions, error))
        else:
            near.clear()  # what came before was near by chance
    if not near:
        row["note"] = "implicit is never near"
        return row
    _, divisions, error = min(near)
    row.update(step=case.stretch / SAMPLES / divisions, error=error)
    tried = []
    for alpha in ALPHAS:
        run = runner.run(case, two_stage(case, alpha) + stretch_of(case, 1))
        error = distance(run.shapes, reference.shapes) / length
        tried.append((alpha, error))
        log(f"  direct, alpha {alpha}: {run.failure or f'{error:.2%} in {run.seconds:.3g} s'}")
        if error < NEAR or run.failure.startswith(">"):
            break
    best = nearest(tried)
    if best is None:
        row["note"] = f"direct: {run.failure}"
        best = (ALPHAS[0], math.inf)
    elif best[1] >= NEAR:
        row["note"] = f"direct is never within 1 %: {best[1]:.1%} at best"
    alpha = best[0]
    step = 0.9 * bound(length, ribbon, alpha)
    row.update(alpha=alpha, direct_step=step, direct_error=best[1])
    times = {"implicit": math.inf, "direct": math.inf, "gauss-seidel": math.inf, "printed": math.inf}
    for _ in range(repeats):
        run = runner.run(case, implicit(case, divisions))
        times["implicit"] = min(times["implicit"], run.seconds / case.stretch)
        if math.isfinite(best[1]):
            run = runner.run(case, two_stage(case, alpha) + stretch_of(case, 1))
            times["direct"] = min(times["direct"], run.seconds / case.stretch)
    for name, settings in (("gauss-seidel", GAUSS_SEIDEL), ("printed", PRINTED)):
        seconds, share, note = time_of_steps(runner, case, alpha, step, settings, budget, reference)
        times[name] = seconds
        row.setdefault("shares", {})[name] = f"{share:.1%} of the stretch run" + (f"; {note}" if note else "")
        log(f"  {name}: {seconds:.3g} s/s, {row['shares'][name]}")
    row["times"] = times
    return row


def log(text):
    print(text, file=sys.stderr, flush=True)


def show(rows):
    print("| scene | stretch [s] | implicit: step [ms] | error | s/s | direct: alpha | step [ms] | error | s/s "
          "| ratio | gauss-seidel s/s | ratio | printed s/s | ratio |")
    print("|" + "---|" * 14)
    for row in rows:
        name = row["scene"] + (" (planar)" if row["planar"] else "")
        if "times" not in row:
            print(f"| {name} | {row['stretch']} | {row.get('note', '')} |" + " |" * 11)
            continue
        times = row["times"]
        cells = [name, f"{row['stretch']:g}", f"{1e3 * row['step']:.3g}", f"{row['error']:.1e}",
                 f"{times['implicit']:.3g}", f"{row['alpha']:g}", f"{1e3 * row['direct_step']:.3g}",
                 f"{row['direct_error']:.1e}"]
        for method in ("direct", "gauss-seidel", "printed"):
            known = math.isfinite(times[method])
            cells.append(f"{times[method]:.3g}" if known else "fails")
            cells.append(f"{times[method] / times['implicit']:.0f}" if known else "")
        print("| " + " | ".join(cells) + " |")
    for row in rows:
        if "own_error" in row:
            print(f"{row['scene']}: the motion held against changes by {row['own_error']:.1e} of the length with half "
                  f"its steps" + (f"; {row['note']}" if "note" in row else ""))
        for method, share in row.get("shares", {}).items():
            print(f"{row['scene']}, {method}: {share}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    root = Path(__file__).resolve().parent.parent
    parser.add_argument("--program", default=str(root / "build/release/wunderlich"))
    parser.add_argument("--quick", action="store_true", help="the scene swing alone")
    parser.add_argument("--scene", help="this scene alone")
    parser.add_argument("--timeout", type=float, default=120, help="of one run [s]")
    parser.add_argument("--budget", type=float, default=20, help="of a run that is scaled [s]")
    parser.add_argument("--repeats", type=int, default=3)
    arguments = parser.parse_args()
    wanted = "swing" if arguments.quick else arguments.scene
    cases = [case for case in CASES if wanted in (None, case.name)]
    if not cases:
        sys.exit(f"no such scene: {wanted}")
    runner = Runner(arguments.program, arguments.timeout)
    began = time.monotonic()
    show([compare(runner, case, root / "scenes", arguments.repeats, arguments.budget) for case in cases])
    log(f"{time.monotonic() - began:.0f} s")


if __name__ == "__main__":
    main()
