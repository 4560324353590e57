#!/usr/bin/env python3
"""Builds the documentation as a site that needs no server and no network; `./run --docs` calls this.

usage: tools/site/build.py [--out DIR]       default build/site; needs what `tools/setup.sh docs` installs
"""

import argparse
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import api
from pages import Stage

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
KATEX = Path("/usr/share/javascript/katex")

API_PAGE = """# C++ reference

The library by its headers, in the order in which the [layers](../architecture.md) build on one another: comments and
declarations as they stand in the code. How to build a program on it is in [the library's page](../library.md).
Folders of the program, which `cmake --install` does not lay down, come last.

"""


def add_reference(stage):
    """The C++ reference; returns what is not documented."""
    pages, faults = api.pages(ROOT)
    rows = ["| folder | headers |\n|---|---|\n"]
    for name, text in pages.items():
        headers = ", ".join(f"`{header}`" for header in re.findall(r"^## (\w+)\.hpp$", text, re.M))
        rows.append(f"| [{text.splitlines()[0][2:]}]({name}) | {headers} |\n")
    stage.write("api/index.md", API_PAGE + "".join(rows))
    for name, text in pages.items():
        stage.write(f"api/{name}", text)
    return faults


def add_katex(folder):
    """Styles and fonts of the maths; browsers that want older fonts than WOFF2 are older than the rest of the site."""
    style = (KATEX / "katex.min.css").read_text(encoding="utf-8")
    style = re.sub(r',url\([^)]*\.(?:woff|ttf)\) format\([^)]*\)', "", style)
    (folder / "katex/fonts").mkdir(parents=True)
    (folder / "katex/katex.min.css").write_text(style, encoding="utf-8")
    for font in (KATEX / "fonts").glob("*.woff2"):
        shutil.copy(font, folder / "katex/fonts")


def stage_pages(folder):
    """Lays out what the generator reads; returns its `nav` and what the reference found undocumented."""
    stage = Stage(ROOT, folder)
    names = [path.relative_to(ROOT).as_posix() for path in sorted((ROOT / "docs").rglob("*.md"))]
    for name in ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", *names]:
        stage.add_page(name)
    faults = add_reference(stage)
    stage.add_files()
    shutil.copytree(ROOT / "docs/images", folder / "images")
    add_katex(folder)
    for name in ("site.css", "icon.svg"):
        shutil.copy(HERE / name, folder / name)
    return stage.navigation(), faults


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--out", type=Path, default=ROOT / "build/site")
    out = parser.parse_args().out.resolve()
    source = out.with_name(out.name + "-source")
    shutil.rmtree(source, ignore_errors=True)
    (source / "pages").mkdir(parents=True)
    navigation, faults = stage_pages(source / "pages")
    settings = {"INHERIT": str(HERE / "mkdocs.yml"), "docs_dir": str(source / "pages"), "site_dir": str(out),
                "hooks": [str(HERE / "hooks.py")], "theme": {"custom_dir": str(HERE / "theme")}, "nav": navigation}
    (source / "mkdocs.yml").write_text(json.dumps(settings, indent=1), encoding="utf-8")  # JSON is YAML
    command = ["mkdocs", "build", "--strict", "--quiet", "--config-file", source / "mkdocs.yml"]
    built = subprocess.run(command, check=False)
    print("\n".join(faults), file=sys.stderr, end="\n" if faults else "")
    if built.returncode or faults:
        return 1
    print(f"site: {out / 'index.html'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
