#!/usr/bin/env python3
"""How a sweep scales, and what it costs beside its runs.

    python3 bench/sweep_scaling.py [--program FILE] [--runs N] [--segments N] [--repeats N] [--jobs N]

Moebius bands of many widths and stiffnesses, a thousand of them, by one process and by `--jobs`, in turns; the least time of each
counts. Overhead is the whole command's time, table and page included, over the sum of its runs (from reading the scene to the
record), less one.
"""

import argparse
import csv
import os
import subprocess
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SWEEP = """scene: moebius
set: {{ribbon.segments: {segments}}}
axes:
  - {{name: aspect, key: ribbon.aspect, linear: {{from: 8, to: 20, count: {aspects}}}}}
  - {{name: stiffness, key: ribbon.bending_stiffness, log: {{from: 0.1, to: 10, count: 25}}}}
collect: {{energy: energy.normalized}}
"""


def sweep(program, folder, jobs):
    """(seconds of the command, seconds of its runs)"""
    out = folder / "out"
    subprocess.run(["rm", "-rf", str(out)], check=True)
    start = time.monotonic()
    subprocess.run([str(program), "sweep", str(folder / "sweep.yaml"), "--out", str(out), "--jobs", str(jobs), "--quiet"],
                   check=True)
    seconds = time.monotonic() - start
    with open(out / "table.csv", encoding="utf-8") as file:
        return seconds, sum(float(row["run_seconds"]) for row in csv.DictReader(file))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=Path, default=ROOT / "build/release/wunderlich")
    parser.add_argument("--runs", type=int, default=1000)
    parser.add_argument("--segments", type=int, default=100)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    chosen = parser.parse_args()
    times = {1: [], chosen.jobs: []}
    overheads = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "sweep.yaml").write_text(SWEEP.format(segments=chosen.segments, aspects=chosen.runs // 25))
        for _ in range(chosen.repeats):
            for jobs in times:
                seconds, runs = sweep(chosen.program.resolve(), folder, jobs)
                times[jobs].append(seconds)
                if jobs == 1:
                    overheads.append(seconds / runs - 1)
    one, many = (min(times[jobs]) for jobs in (1, chosen.jobs))
    print(f"{chosen.runs} equilibria of {chosen.segments} segments: {one:.2f} s by one process, {many:.2f} s by {chosen.jobs}: "
          f"{one / many:.2f} times as fast; overhead {100 * min(overheads):.1f} % ({100 * max(overheads):.1f} % at most)")


if __name__ == "__main__":
    main()
