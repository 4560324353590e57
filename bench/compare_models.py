#!/usr/bin/env python3
"""Ribbon, rod and shells on one motion: how long a simulated second takes each, and how far its end is from the right place.

    python3 bench/compare_models.py [--program FILE] [--duration S]

The scene is `swing`, a strip let go from straight that swings out of its plane; what is right is the ribbon with 200 segments and
steps of 0.25 ms. The error is the mean distance of the free end's two corners from there, over the length, at the end of the motion.
Ratios are to the ribbon by `implicit` that is nearest in error to the best shell, all in one run. Prints Markdown.
"""

import argparse
import json
import math
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RIGHT = ["solver.method=implicit", "ribbon.segments=200", "solver.time_step=2.5e-4"]


def cases():
    """(name, model, settings)."""
    for segments, step in ((10, 2e-2), (20, 1e-2), (35, 5e-3), (50, 5e-3)):
        yield f"ribbon, implicit, {segments}, {1e3 * step:g} ms", "ribbon", ["solver.method=implicit", f"ribbon.segments={segments}",
                                                                           f"solver.time_step={step}"]
    for segments in (20, 35):
        yield f"ribbon, two-stage, {segments}, 5 ms", "ribbon", [f"ribbon.segments={segments}", "solver.method=two-stage",
                                                              "solver.time_step=5e-3"]
    for segments, step in ((20, 1e-3), (35, 1e-3)):
        yield f"rod, {segments}, {1e3 * step:g} ms", "rod", [f"ribbon.segments={segments}", f"compare.time_step={step}"]
    for kind, model in (("conforming", "shell-conforming"), ("nonconforming", "shell-nonconforming")):
        for along, across, step, tolerance in ((20, 4, 1e-3, 1e-2), (36, 4, 1e-3, 1e-2), (36, 4, 1e-3, 1e-3),
                                               (36, 8, 2e-4, 1e-2), (36, 12, 1e-4, 1e-2)):
            name = f"{model}, {along} x {across}, {1e3 * step:g} ms, {100 * tolerance:g} %"
            shape = f"compare.shell_{kind}={{along: {along}, across: {across}, time_step: {step}}}"
            yield name, model, [shape, f"compare.length_tolerance={tolerance}"]


def run(program, folder, model, settings, duration):
    words = [word for setting in [*settings, f"solver.duration={duration}"] for word in ("--set", setting)]
    out = folder / "out"
    subprocess.run([program, "compare", "swing", "--models", model, "--quiet", "--out", out, *words], check=False,
                   stderr=subprocess.DEVNULL)
    result = json.loads((out / "comparison.json").read_text())["models"][0]
    points = [tuple(map(float, line.split()[1:4])) for line in (out / f"{model}.obj").read_text().splitlines()
              if line.startswith("v ")]
    return result, points


def end_corners(points):
    """The mesh ends with the points of the free end, from rim to rim: the last, and the farthest from it at the end."""
    last = points[-1]
    other = max(points[-20:], key=lambda p: math.dist(p, last) if math.dist(p, last) < 0.11 else -1)
    return sorted([last, other])


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
        middle = [sum(c) / 2 for c in zip(*end_corners(right))]
        for case, model, settings in cases():
            result, points = run(program, folder, model, settings, chosen.duration)
            at = [sum(c) / 2 for c in zip(*end_corners(points))]
            rows.append((case, model, result["wall_per_second"], math.dist(at, middle), result["diagonal_strain"],
                         result["converged"]))
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
