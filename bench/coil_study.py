#!/usr/bin/env python3
"""How many rows a conforming shell needs to coil as the ribbon does: table and picture; what came of it is in docs/baselines.md, "Coil".

    python3 bench/coil_study.py [--program FILE] [--rows 4,6,8,10,12] [--picture FILE] [--set KEY=VALUE]

The scene is `coil` up to where it lies loose, without self-contact, which shells do not have. A shell turns for 0.4 s, is loosened for
0.4 s and rests for 1.6 s, in the metric of masses; the ribbon's equilibrium stands beside. Prints Markdown: energy as V l/(D w), distance of
the ends over the length, share of the steps whose lengths missed the tolerance. The picture needs matplotlib (tools/setup.sh validation): the
shells with the fewest, a middle and the most rows half-way through the loosening and at the end, and the ribbon that feels itself.
"""

import argparse
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "validation"))
from common import Surface  # noqa: E402  (this folder has to be on the path first)

LOOSE = 2.0  # load parameter at which the strip lies loosened; the turn is done at 1
ALONG = 36
SHELL = ["compare.metric=mass", "compare.load_time=0.4", "compare.time_step=4e-4", "compare.damping=50"]


def scene(folder, itself):
    """The file of the scene; without self-contact its block says nothing and has to go."""
    shipped = ROOT / "scenes/coil.yaml"
    if itself:
        return shipped
    text, block = shipped.read_text(), "contact:\n  self: true\n"
    if block not in text:
        sys.exit(f"{shipped}: no block {block!r}")
    path = folder / "coil-without-contact.yaml"
    path.write_text(text.replace(block, ""))
    return path


def compare(program, folder, model, settings, itself=False):
    """(figures, final Surface). A shell that does not come to rest is taken as it stands."""
    words = [word for setting in settings for word in ("--set", setting)]
    result = subprocess.run([program, "compare", scene(folder, itself), "--models", model, "--quiet", "--out", folder / "out", *words],
                            capture_output=True, text=True, check=False)
    if result.returncode not in (0, 3):
        sys.exit(f"{model}: exit code {result.returncode}: {result.stderr.strip()}")
    figures = json.loads((folder / "out/comparison.json").read_text())["models"][0]
    lines = (folder / f"out/{model}.obj").read_text().splitlines()
    points = [tuple(map(float, line.split()[1:4])) for line in lines if line.startswith("v ")]
    across = len(points) // ALONG if model != "ribbon" else 9
    return figures, Surface(0, across, points, {})


def shell(program, folder, rows, until=LOOSE, rest=1.6):
    return compare(program, folder, "shell-conforming",
                   [*SHELL, f"solver.duration={until}", f"compare.settle_time={rest}",
                    f"compare.shell_conforming={{along: {ALONG}, across: {rows}}}"])


def ribbon(program, folder, itself):
    return compare(program, folder, "ribbon", [f"solver.duration={LOOSE}"], itself)


def ends_apart(surface):
    """Distance of the middles of the two ends; the strip is of length 1."""
    first, last = ([surface.line(row)[k] for row in (0, -1)] for k in (0, -1))
    return math.dist(*([sum(c) / 2 for c in zip(*end)] for end in (first, last)))


def draw(program, folder, path, rows, ends):
    import drawing

    chosen = [rows[0], rows[len(rows) // 2], rows[-1]]
    figure, axes = drawing.panels(len(chosen) + 1, size=(3.2, 3.2))
    for axis, count in zip(axes, chosen):
        forming = shell(program, folder, count, until=0.5 * (1 + LOOSE), rest=0)[1]
        drawing.ribbons(axis, [forming, ends[count]], drawing.rainbow(2), (25, -62), f"shell, {count} rows", apart=0.95)
    drawing.ribbons(axes[-1], [ribbon(program, folder, True)[1]], drawing.rainbow(1), (25, -62), "ribbon that feels itself")
    drawing.same_scale(axes)
    drawing.save(figure, path)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=Path, default=ROOT / "build/release/wunderlich")
    parser.add_argument("--rows", default="4,6,8,10,12", help="vertices across, separated by commas")
    parser.add_argument("--picture", type=Path)
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="of the shells' runs, beside those above")
    chosen = parser.parse_args()
    SHELL.extend(chosen.set)
    program, rows = chosen.program.resolve(), [int(m) for m in chosen.rows.split(",")]
    ends = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        print(f"| m×{ALONG} | energy | distance of the ends | steps that missed | |\n|---|---|---|---|---|")
        for m in rows:
            figures, ends[m] = shell(program, folder, m)
            print(f"| {m} | {figures['normalized']:.3g} | {ends_apart(ends[m]):.3f} l | {100 * figures['missed_steps']:.0f} % | "
                  f"{figures.get('failure', '')} |", flush=True)
        figures, surface = ribbon(program, folder, False)
        print(f"| ribbon | {figures['normalized']:.3g} | {ends_apart(surface):.3f} l | – | {figures.get('failure', '')} |")
        if chosen.picture:
            draw(program, folder, chosen.picture, rows, ends)


if __name__ == "__main__":
    main()
