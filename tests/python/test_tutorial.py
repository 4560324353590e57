"""Every ```python block of docs/python.md runs, in the order of the page, in one namespace; a ```text block that follows
is what it prints. `--write` puts there what is printed, and the picture beside the page."""

import contextlib
import io
import os
import re
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGE = DOCS / "python.md"
BLOCK = re.compile(r"^```python\n(?P<code>.*?)^```\n(?:\n```text\n(?P<output>.*?)^```\n)?", re.M | re.S)


def outputs(text):
    """What the blocks of a page print, each with its match; run in the current folder."""
    names = {"__name__": "__main__"}
    for block in BLOCK.finditer(text):
        lines = text.count("\n", 0, block.start("code"))
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile("\n" * lines + block["code"], str(PAGE), "exec"), names)  # noqa: S102
        yield block, printed.getvalue()


@contextlib.contextmanager
def elsewhere():
    before = os.getcwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            yield Path(folder)
        finally:
            os.chdir(before)


class Tutorial(unittest.TestCase):
    def test_page(self):
        text = PAGE.read_text(encoding="utf-8")
        with elsewhere() as folder:
            for block, printed in outputs(text):
                with self.subTest(line=text.count("\n", 0, block.start())):
                    self.assertEqual(printed, block["output"] or "")
            self.assertGreater((folder / "moebius.png").stat().st_size, 20000)
        self.assertGreater(len(BLOCK.findall(text)), 9)


def write():
    text = PAGE.read_text(encoding="utf-8")
    with elsewhere() as folder:
        for block, printed in reversed(list(outputs(text))):
            if block["output"] is not None:
                text = text[:block.start("output")] + printed + text[block.end("output"):]
        shutil.copy(folder / "moebius.png", DOCS / "images" / "python.png")
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    if sys.argv[1:] == ["--write"]:
        write()
    else:
        unittest.main(verbosity=2)
