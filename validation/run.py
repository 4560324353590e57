#!/usr/bin/env python3
"""Runs the paper's figures again and compares the numbers.

    python3 validation/run.py [CLAIM...] [--program FILE] [--out DIR] [--quick] [--jobs N] [--no-figures] [--docs]

Prints one table of results, writes it to DIR/results.json and a figure a claim to DIR. The exit code is the number of
failed rows (a claim that breaks off counts as one). `--quick` takes fewer segments and shorter motions; `--docs` puts
the figures where docs/validation.md shows them. Claims do not depend on each other, so that `--jobs N` runs N at a
time; `--list` only names them.
Figures need matplotlib (tools/setup.sh validation); without it the checks run all the same.
"""

import argparse
import dataclasses
import importlib.util
import json
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
from common import Row, Runner  # noqa: E402  (this folder has to be on the path first)

CLAIMS = ["facets", "area", "dynamics-alpha", "moebius-profile", "loop", "coil", "drape", "belts", "models", "taylor"]
FIGURES_OF_DOCS = HERE.parent / "docs" / "images"


def load(claim):
    """The module check.py of a claim: measure(runner) -> (rows, data), draw(data, drawing, path)."""
    name = "claim_" + claim.replace("-", "_")
    spec = importlib.util.spec_from_file_location(name, HERE / claim / "check.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def measure(claim, program, out, quick):
    """(rows, data, seconds); a claim that breaks off is one failed row, without data."""
    start = time.monotonic()
    try:
        rows, data = load(claim).measure(Runner(program, out / claim, quick))
    except Exception as error:  # whatever broke, the other claims go on and the table says so
        rows, data = [Row("ran to its end", "", f"{type(error).__name__}: {error}", "", False)], None
    return rows, data, time.monotonic() - start


def drawing_module():
    try:
        import drawing
    except ImportError as error:
        print(f"no figures are drawn: {error} (tools/setup.sh validation installs it)")
        return None
    return drawing


def print_table(results):
    head = ("claim", "quantity", "paper or reference", "measured", "bound", "ok")
    lines = [(claim, row.quantity, row.paper, row.measured, row.bound, "ok" if row.ok else "FAILED")
             for claim, rows in results.items() for row in rows]
    widths = [max(len(line[i]) for line in [head, *lines]) for i in range(len(head))]
    for line in [head, tuple("-" * width for width in widths), *lines]:
        print("  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip())


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("claims", nargs="*", metavar="CLAIM", help=", ".join(CLAIMS))
    parser.add_argument("--program", type=Path, default=HERE.parent / "build/release/wunderlich")
    parser.add_argument("--out", type=Path, default=HERE.parent / "build/validation")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--no-figures", action="store_true")
    parser.add_argument("--docs", action="store_true")
    parser.add_argument("--list", action="store_true", help="name the claims and do nothing")
    chosen = parser.parse_args()
    for claim in chosen.claims:
        if claim not in CLAIMS:
            parser.error(f"no claim '{claim}'; there are: {', '.join(CLAIMS)}")
    if not chosen.list and not chosen.program.exists():
        parser.error(f"no program {chosen.program}; ./run builds it")
    return chosen


def main():
    chosen = arguments()
    claims = chosen.claims or CLAIMS
    if chosen.list:
        for claim in claims:
            print(f"{claim:16}  {load(claim).__doc__.splitlines()[0]}")
        return 0
    out = chosen.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    with ThreadPoolExecutor(max(1, chosen.jobs)) as pool:
        measured = list(pool.map(lambda claim: measure(claim, chosen.program.resolve(), out, chosen.quick), claims))
    results = {claim: rows for claim, (rows, _, _) in zip(claims, measured)}
    print_table(results)
    print("seconds: " + ", ".join(f"{claim} {seconds:.1f}" for claim, (_, _, seconds) in zip(claims, measured)))
    table = {claim: [dataclasses.asdict(row) for row in rows] for claim, rows in results.items()}
    (out / "results.json").write_text(json.dumps(table, indent=1, ensure_ascii=False), encoding="utf-8")
    drawing = None if chosen.no_figures else drawing_module()
    for claim, (_, data, _) in zip(claims, measured):
        if drawing and data is not None:
            path = (FIGURES_OF_DOCS if chosen.docs else out) / f"validation-{claim}.png"
            load(claim).draw(data, drawing, path)
            print(f"{path}: {path.stat().st_size // 1000} kB")
    failures = sum(not row.ok for rows in results.values() for row in rows)
    print(f"validation: {failures} failed" if failures else "validation: every row is within its bound")
    return min(failures, 100)  # of exit codes 256 would be none


if __name__ == "__main__":
    sys.exit(main())
