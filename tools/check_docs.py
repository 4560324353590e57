#!/usr/bin/env python3
"""Checks the pages: links lead somewhere, and what pages list is what there is; tools/check_snippets.py runs their code.

    tools/check_docs.py [--program FILE]   check this repository; with a program also the pages that it writes
    tools/check_docs.py --self-test        plant faults in a temporary tree and see each reported
"""

import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path

LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#+\s+(.*)$", re.M)
FENCE = re.compile(r"^```(\w*)\n(.*?)^```", re.M | re.S)


GENERATED = {"scene-format.md": ["schema"], "scene.schema.json": ["schema", "--json"]}


def pages(root):
    return sorted(list(root.glob("*.md")) + list((root / "docs").rglob("*.md")))


def anchors(text):
    """GitHub's names of the headings of a page."""
    names = [re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-") for heading in HEADING.findall(text)]
    return set(names)


def line_of(text, position):
    return text.count("\n", 0, position) + 1


def check_links(root, page, text):
    prose = FENCE.sub(lambda match: "\n" * match.group(0).count("\n"), text)
    for match in LINK.finditer(prose):
        target, _, anchor = match.group(1).partition("#")
        if re.match(r"[a-z]+:", target):
            continue
        where = f"{page.relative_to(root)}:{line_of(prose, match.start())}"
        path = page if not target else (page.parent / target)
        if not path.exists():
            yield f"{where}: link to {target}, which does not exist"
        elif anchor and path.suffix == ".md" and anchor not in anchors(path.read_text(encoding="utf-8")):
            yield f"{where}: no heading '{anchor}' in {target or page.name}"


def check_scenes_listed(root):
    """Every shipped scene stands in the README, and every scene in its table is shipped."""
    readme = (root / "README.md").read_text(encoding="utf-8")
    shipped = {path.stem for path in (root / "scenes").glob("*.yaml")}
    table = re.search(r"^## Scenes$(.*?)(?=^## |\Z)", readme, re.M | re.S)
    listed = set(re.findall(r"^\| `([\w-]+)` \|", table.group(1), re.M)) if table else set()
    yield from (f"README.md:1: scene '{name}' is shipped but not in the table" for name in sorted(shipped - listed))
    yield from (f"README.md:1: scene '{name}' is in the table but not shipped" for name in sorted(listed - shipped))


def check_generated(root, program):
    """Pages that the program writes are what it would write now."""
    for name, arguments in GENERATED.items():
        page = root / "docs" / name
        if page.exists():
            result = subprocess.run([program, *arguments], capture_output=True, text=True, timeout=60, check=False)
            if result.stdout != page.read_text(encoding="utf-8"):
                yield f"docs/{name}:1: not up to date; write it with: build/release/wunderlich {' '.join(arguments)}"


def check(root, program=None):
    faults = list(check_generated(root, program)) if program else []
    for page in pages(root):
        faults += check_links(root, page, page.read_text(encoding="utf-8"))
    return faults + list(check_scenes_listed(root))


CLEAN_TREE = {
    "README.md": "# A b\n[x](docs/a.md#c-d) [y](#a-b) [z](https://example.org/q)\n## Scenes\n| `one` | a scene |\n```sh\n./run\n```\n## Files\n| `file` | x |\n",
    "docs/a.md": "## C, d\n",
    "scenes/one.yaml": "",
    "run": "",
}
PLANTED = [
    ("README.md", "[x](docs/b.md)\n## Scenes\n| `one` |\n", "README.md:1: link to docs/b.md"),
    ("docs/a.md", "## E\n", "no heading 'c-d'"),
    ("docs/scene-format.md", "# A\n", "docs/scene-format.md:1: not up to date"),
    ("docs/scene.schema.json", "{}", "docs/scene.schema.json:1: not up to date"),
    ("scenes/two.yaml", "", "scene 'two' is shipped but not in the table"),
    ("README.md", "## Scenes\n| `one` |\n| `six` | ?\n", "scene 'six' is in the table but not shipped"),
]


def faults_of(tree):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in tree.items():
            path = Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return check(Path(folder), "/bin/false")


def self_test():
    assert not faults_of(CLEAN_TREE), faults_of(CLEAN_TREE)
    for name, text, expected in PLANTED:
        faults = faults_of(CLEAN_TREE | {name: text})
        assert any(expected in fault for fault in faults), (expected, faults)
    print(f"check_docs: self-test found all {len(PLANTED)} planted faults")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", type=Path)
    parser.add_argument("--self-test", action="store_true")
    arguments = parser.parse_args()
    if arguments.self_test:
        return self_test()
    program = arguments.program.resolve() if arguments.program else None
    faults = check(Path(__file__).resolve().parent.parent, program)
    print("\n".join(faults) or "check_docs: links lead somewhere, tables list what there is")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
