"""What every claim needs: running the program, reading a run folder, and rows of the table of results.

Plain standard library, so that the checks run anywhere; only drawing.py needs matplotlib.
"""

import csv
import json
import math
import re
import struct
import subprocess
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
REFERENCE = HERE / "reference"
SCENES = HERE.parent / "scenes"


@dataclass
class Row:
    """One line of the table. `paper` is what the paper or the reference says, `bound` what `ok` was decided by."""

    quantity: str
    paper: str
    measured: str
    bound: str
    ok: bool


def at_most(quantity, measured, bound, paper=""):
    return Row(quantity, paper, f"{measured:.3g}", f"<= {bound:.3g}", measured <= bound)


def at_least(quantity, measured, bound, paper=""):
    return Row(quantity, paper, f"{measured:.3g}", f">= {bound:.3g}", measured >= bound)


def between(quantity, measured, low, high, paper=""):
    return Row(quantity, paper, f"{measured:.3g}", f"{low:.3g} ... {high:.3g}", low <= measured <= high)


def equal(quantity, measured, expected, paper=""):
    return Row(quantity, paper, str(measured), f"= {expected}", measured == expected)


@dataclass
class Runner:
    """Runs the program; each run goes to a folder of its own below `out`."""

    program: Path
    out: Path
    quick: bool

    def run(self, name, scene, settings=(), formats="none"):
        """`scene` is a file or a shipped scene's name; `settings` are key=value. Raises if the run fails."""
        scene = scene if Path(scene).exists() else SCENES / f"{scene}.yaml"
        words = [word for setting in settings for word in ("--set", setting)]
        command = [self.program, "run", scene, "--quiet", "--formats", formats, "--out", self.out / name, *words]
        result = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
        if result.returncode != 0:
            raise RuntimeError(f"{name}: exit code {result.returncode}: {result.stderr.strip()}")
        return Run(self.out / name)


class Run:
    """A run folder."""

    def __init__(self, path):
        self.path = path
        self.summary = json.loads((path / "summary.json").read_text())
        self.history = read_csv(path / "history.csv")
        self.centerline = read_csv(path / "centerline.csv")

    def frames(self):
        """The recorded frames in order, as Surface; needs a run with vtp."""
        return [read_vtp(path) for path in sorted((self.path / "frames").glob("*.vtp"))]


def read_csv(path):
    """{column: list of floats}."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    columns = [[float(row[i]) for row in rows[1:]] for i in range(len(rows[0]))]
    return dict(zip(rows[0], columns))


@dataclass
class Surface:
    """The surface of one frame as a grid of points, row by row along the strip; fields have one value a point."""

    time: float
    across: int  # points across
    points: list  # (x, y, z)
    fields: dict  # "u", "kappa", "tau", "eta", ...

    def line(self, index):
        """Points of one line along the strip: 0 the one rim, -1 the other."""
        return self.points[index % self.across::self.across]

    def centerline(self):
        return self.line(self.across // 2)

    def on_centerline(self, name):
        return self.fields[name][self.across // 2::self.across]


def read_vtp(path):
    """Reads what the program writes: appended raw blocks, each after its length, and nothing else."""
    data = path.read_bytes()
    head, _, blocks = data.partition(b'<AppendedData encoding="raw">\n_')
    head = head.decode()
    arrays = {}
    for attributes in re.findall(r"<DataArray ([^>]*)/>", head):
        found = dict(re.findall(r'(\w+)="([^"]*)"', attributes))
        start = int(found["offset"])
        (size,) = struct.unpack_from("<I", blocks, start)
        kind = {"Float32": "f", "Int32": "i"}[found["type"]]
        arrays[found["Name"]] = struct.unpack_from(f"<{size // 4}{kind}", blocks, start + 4)
    time = float(re.search(r'"TimeValue"[^>]*>([^<]*)<', head).group(1))
    flat = arrays.pop("points")
    points = list(zip(flat[0::3], flat[1::3], flat[2::3]))
    across = next(i for i, u in enumerate(arrays["u"]) if u != arrays["u"][0])
    return Surface(time, across, points, {name: arrays[name] for name in ("u", "v", "kappa", "tau", "eta")})


def norm(a):
    return math.sqrt(sum(x * x for x in a))


def distance(a, b):
    return math.dist(a, b)


def root_mean_square(values):
    values = list(values)
    return math.sqrt(sum(x * x for x in values) / len(values))


def slope(x, y):
    """Slope of log y over log x by least squares."""
    x, y = [math.log(v) for v in x], [math.log(v) for v in y]
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)


def interpolate(x, table_x, table_y):
    """Piecewise linear; x within the table."""
    low, high = 0, len(table_x) - 1
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if table_x[middle] <= x else (low, middle)
    weight = (x - table_x[low]) / (table_x[high] - table_x[low])
    return (1 - weight) * table_y[low] + weight * table_y[high]
