#!/usr/bin/env python3
"""Ribbon, rod and shells on one motion: how long a simulated second takes each, and how far its end is from the right place.

    python3 bench/compare_models.py [--program FILE] [--duration S]

The scene is `swing`, a strip let go from straight that swings out of its plane; what is right is the ribbon with 200 segments and
steps of 0.25 ms. The error is the distance between the middles of the free end, over the length, at the end of the motion.
Ratios are to the cheapest ribbon by `implicit` that is at least as near as the best shell, all in one run. Prints Markdown.
"""

import argparse
import json
import math
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LENGTH = 1  # of the scene's strip [m]
ACROSS = 9  # points of a surface from rim to rim, but for the shells', which have their own
REPEATED = 4  # times more, where a run takes less than half a second: the shortest counts
RIGHT = ["solver.method=implicit", "ribbon.segments=200", "solver.time_step=2.5e-4"]


def cases():
    """(name, model, points across, settings)."""
    for segments, step in ((10, 2e-2), (20, 1e-2), (35, 5e-3), (50, 5e-3)):
        yield (f"ribbon, implicit, {segments}, {1e3 * step:g} ms", "ribbon", ACROSS,
               ["solver.method=implicit", f"ribbon.segments={segments}", f"solver.time_step={step}"])
    for segments in (20, 35):
        yield (f"ribbon, two-stage, {segments}, 5 ms", "ribbon", ACROSS,
               [f"ribbon.segments={segments}", "solver.method=two-stage", "solver.time_step=5e-3"])
    for segments, step in ((20, 1e-3), (35, 1e-3)):
        yield (f"rod, {segments}, {1e3 * step:g} ms", "rod", ACROSS,
               [f"ribbon.segments={segments}", f"compare.time_step={step}"])
    for kind in ("conforming", "nonconforming"):
        for along, across, step, tolerance in ((20, 4, 1e-3, 1e-2), (36, 4, 1e-3, 1e-2), (36, 4, 1e-3, 1e-3),
                                               (36, 8, 2e-4, 1e-2), (36, 12, 1e-4, 1e-2)):
            model = f"shell-{kind}"
            name = f"{model}, {along} x {across}, {1e3 * step:g} ms, {100 * tolerance:g} %"
            shape = f"compare.shell_{kind}={{along: {along}, across: {across}, time_step: {step}}}"
            yield name, model, across, [shape, f"compare.length_tolerance={tolerance}"]


def run(program, folder, model, settings, duration):
    words = [word for setting in [*settings, f"solver.duration={duration}"] for word in ("--set", setting)]
    out = folder / "out"
    subprocess.run([program, "compare", "swing", "--models", model, "--quiet", "--out", out, *words], check=False,
                   stderr=subprocess.DEVNULL)
    result = json.loads((out / "comparison.json").read_text())["models"][0]
    points = [tuple(map(float, line.split()[1:4])) for line in (out / f"{model}.obj").read_text().splitlines()
              if line.startswith("v ")]
    return result, points


def middle_of_end(points, across):
    """The mesh ends with the column of points of the free end, from rim to rim; its first and last are the corners."""
    return [(first + last) / 2 for first, last in zip(points[-across], points[-1])]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=Path, default=ROOT / "build/release/wunderlich")
    parser.add_argument("--duration", type=float, default=0.4)
    chosen = parser.parse_args()
    program = chosen.program.resolve()
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        _, right = run(program, folder, "ribbon", RIGHT, chosen.duration)
        middle = middle_of_end(right, ACROSS)
        for case, model, across, settings in cases():
            result, points = run(program, folder, model, settings, chosen.duration)
            for _ in range(REPEATED if result["wall_seconds"] < 0.5 else 0):
                again, _ = run(program, folder, model, settings, chosen.duration)
                result = min(result, again, key=lambda r: r["wall_seconds"])
            error = math.dist(middle_of_end(points, across), middle) / LENGTH
            rows.append((case, model, result["wall_per_second"], error, result["diagonal_strain"], result["converged"]))
    shells = [row for row in rows if row[1].startswith("shell")]
    best = min(shells, key=lambda row: row[3])
    ribbon = min((row for row in rows if "implicit" in row[0] and row[3] <= best[3]), key=lambda row: row[2], default=rows[0])
    print(f"ratios to `{ribbon[0]}`, the cheapest ribbon that is at least as near as the best shell\n")
    print("| model, resolution, step | s a simulated second | ratio | end is off by, over l | diagonal strain | |\n|---|---|---|---|---|---|")
    for case, _, seconds, error, strain, converged in rows:
        print(f"| {case} | {seconds:.3g} | {seconds / ribbon[2]:.3g} | {error:.2g} | {abs(strain):.1g} | "
              f"{'' if converged else 'stopped early'} |")


if __name__ == "__main__":
    main()
