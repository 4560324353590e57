"""The package is typed: mypy --strict finds nothing, the stub agrees with the module, a user's mistake is found."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
USE = """
import numpy as np
import wunderlich

scene = wunderlich.load("moebius", {"ribbon.segments": 20})
kappa: np.ndarray[tuple[int, ...], np.dtype[np.float64]] = wunderlich.run(scene).strip.kappa
motion = wunderlich.Motion("swing")
motion.gravity = (0, 0, -9.81)
total: float = motion.measure()["total"]
"""


# What pybind11's classes are made by, and what it knows of their constructors.
ALLOWED = r"""
wunderlich\._wunderlich\.(Scene|State|Run|Motion)
wunderlich\._wunderlich\.(Scene|State|Run)\.__init__
"""


def call(*words):
    environment = os.environ | {"MYPYPATH": str(ROOT / "python")}
    result = subprocess.run([sys.executable, "-m", *map(str, words)], env=environment, cwd=ROOT, capture_output=True,
                            text=True, check=False)
    return result.returncode, result.stdout + result.stderr


class Types(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return self.folder / name

    def test_package_and_its_use(self):
        right, wrong = self.write("right.py", USE), self.write("wrong.py", USE + "motion.step('soon')\n")
        code, output = call("mypy", "--strict", "--config-file", "pyproject.toml", "--cache-dir", self.folder / "cache",
                            "python/wunderlich", right, wrong)
        self.assertEqual(code, 1)
        errors = [line for line in output.splitlines() if ": error:" in line]
        self.assertEqual(len(errors), 1, output)
        self.assertRegex(errors[0], r'wrong\.py.*incompatible type "str"')

    def test_stub(self):
        code, output = call("mypy.stubtest", "--mypy-config-file", "pyproject.toml", "--allowlist",
                            self.write("allowed", ALLOWED), "wunderlich._wunderlich")
        self.assertEqual(code, 0, output)


if __name__ == "__main__":
    unittest.main(verbosity=2)
