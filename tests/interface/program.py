"""Calls the program in a folder of its own, and looks at what it leaves there."""

import hashlib
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ.get("WUNDERLICH_PROGRAM", "build/release/wunderlich")
SCENES = Path(os.environ.get("WUNDERLICH_SCENES", Path(__file__).resolve().parents[2] / "scenes"))
PROGRAM = str(Path(PROGRAM).resolve())

# Small and quick: a strip bent by its own weight.
STRIP = """\
title: A strip for tests
ribbon: {length: 1, width: 0.1, segments: 12}
clamps:
  - at: start
gravity: [0, 0, -1]
solver: {method: equilibrium}
"""


class ProgramTest(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)
        self.folder = Path(self._folder.name)
        self.write("strip.yaml", STRIP)

    def write(self, name, text):
        path = self.folder / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    def call(self, *arguments, timeout=120):
        """The finished process, with stdout and stderr as text."""
        return subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                              timeout=timeout, check=False)

    def expect(self, code, *arguments):
        result = self.call(*arguments)
        self.assertEqual(result.returncode, code, f"{arguments}\n{result.stdout}\n{result.stderr}")
        return result

    def expect_refused(self, *arguments, says=()):
        """Exit code 2, a message that holds every part of `says`, nothing on stdout, no file changed."""
        before = self.tree()
        result = self.expect(2, *arguments)
        self.assertEqual(result.stdout, "")
        for part in [says] if isinstance(says, str) else says:
            self.assertIn(part, result.stderr)
        self.assertEqual(self.tree(), before, "something was written or changed")
        return result.stderr

    def tree(self, below="."):
        """Every path below a folder with a hash of its content."""
        root = self.folder / below
        return {str(path.relative_to(root)): hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else "folder"
                for path in sorted(root.rglob("*"))}


def main():
    unittest.main(verbosity=2)
