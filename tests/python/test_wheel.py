"""The wheel is built, installed without a network into a fresh environment, and used there."""

import os
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
USE = """
import wunderlich, sys
assert wunderlich.__file__.startswith(sys.prefix), wunderlich.__file__
assert wunderlich.run("cantilever").outcome == "converged"
print(wunderlich.__version__)
"""


class Wheel(unittest.TestCase):
    def test_wheel(self):
        environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
        environment["PIP_NO_INDEX"] = "1"

        def call(*words):
            result = subprocess.run(words, env=environment, capture_output=True, text=True, timeout=250, check=False)
            self.assertEqual(result.returncode, 0, f"{words}\n{result.stdout}\n{result.stderr}")
            return result.stdout

        with tempfile.TemporaryDirectory() as folder:
            call(sys.executable, "-m", "pip", "wheel", "--no-deps", "--wheel-dir", folder, str(ROOT))
            wheel, = Path(folder).glob("*.whl")
            names = zipfile.ZipFile(wheel).namelist()
            for name in ["wunderlich/py.typed", "wunderlich/_wunderlich.pyi", "wunderlich/__init__.py"]:
                self.assertIn(name, names)
            self.assertEqual(len([name for name in names if name.endswith(".so")]), 1)
            venv = Path(folder) / "venv"
            call(sys.executable, "-m", "venv", "--without-pip", "--system-site-packages", str(venv))
            python = str(venv / "bin" / "python")
            call(sys.executable, "-m", "pip", "--python", python, "install", str(wheel))
            version = call(python, "-c", USE).strip()
            self.assertIn(f"-{version}-", wheel.name)


if __name__ == "__main__":
    unittest.main(verbosity=2)
