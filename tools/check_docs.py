#!/usr/bin/env python3
"""Checks the pages: links lead somewhere, code blocks run, and what pages list is what there is.

    tools/check_docs.py [--program FILE]   check this repository; with a program also run the code blocks
    tools/check_docs.py --self-test        plant faults in a temporary tree and see each reported

Code blocks: in ```sh blocks every line that calls `build/release/wunderlich` is run (in a temporary folder), every
preset named after `--preset` and every script called by its path must exist; ```yaml blocks with a `ribbon:` key
must pass `wunderlich check`.
"""

import argparse
import json
import re
import shlex
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


def presets(root):
    path = root / "CMakePresets.json"
    return {p["name"] for p in json.loads(path.read_text())["configurePresets"]} if path.exists() else set()


def check_command(root, line, known_presets):
    """What is wrong with one line of a shell block, without running it."""
    words = shlex.split(line, comments=True)
    for word, following in zip(words, words[1:] + [""]):
        if word == "--preset" and following not in known_presets:
            yield f"no preset '{following}'"
    script = words[0].removeprefix("./") if words else ""
    is_path = script.startswith(("tools/", ".ci/")) or words[:1] in (["./run"], ["./test"])
    if is_path and not (root / script).exists():
        yield f"no script {script}"


def run_command(root, program, line):
    """Runs one line that calls the program; yields what went wrong."""
    words = [str(program) if word == "build/release/wunderlich" else word for word in shlex.split(line, comments=True)]
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "scenes").symlink_to(root / "scenes")
        result = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=120, check=False)
    if result.returncode != 0:
        yield f"exit code {result.returncode}: {result.stderr.strip() or result.stdout.strip()}"


def check_yaml(program, block):
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "snippet.yaml"
        scene.write_text(block, encoding="utf-8")
        result = subprocess.run([program, "check", scene], capture_output=True, text=True, timeout=60, check=False)
    if result.returncode != 0:
        yield f"not a valid scene: {result.stderr.strip() or result.stdout.strip()}"


def check_blocks(root, page, text, program):
    """Faults of the code blocks of a page, and how many lines or blocks were run."""
    faults, ran = [], 0
    for match in FENCE.finditer(text):
        language, block = match.groups()
        first = line_of(text, match.start()) + 1
        name = page.relative_to(root)
        if language == "sh":
            for offset, line in enumerate(block.splitlines()):
                found = list(check_command(root, line, presets(root)))
                if program and line.startswith("build/release/wunderlich"):
                    found += run_command(root, program, line)
                    ran += 1
                faults += [f"{name}:{first + offset}: {line.strip()}: {fault}" for fault in found]
        elif language == "yaml" and program and re.search(r"^ribbon:", block, re.M):
            faults += [f"{name}:{first}: {fault}" for fault in check_yaml(program, block)]
            ran += 1
    return faults, ran


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
    faults, ran = list(check_generated(root, program)) if program else [], 0
    for page in pages(root):
        text = page.read_text(encoding="utf-8")
        faults += check_links(root, page, text)
        found, count = check_blocks(root, page, text, program)
        faults, ran = faults + found, ran + count
    return faults + list(check_scenes_listed(root)), ran


CLEAN_TREE = {
    "README.md": "# A b\n[x](docs/a.md#c-d) [y](#a-b) [z](https://example.org/q)\n## Scenes\n| `one` | a scene |\n```sh\n./run\n```\n## Files\n| `file` | x |\n",
    "docs/a.md": "## C, d\n",
    "scenes/one.yaml": "",
    "run": "",
}
PLANTED = [
    ("README.md", "[x](docs/b.md)\n## Scenes\n| `one` |\n", "README.md:1: link to docs/b.md"),
    ("docs/a.md", "## E\n", "no heading 'c-d'"),
    ("docs/a.md", "## C, d\n```sh\ncmake --preset nix\n```\n", "docs/a.md:3: cmake --preset nix: no preset 'nix'"),
    ("docs/a.md", "## C, d\n```sh\ntools/nix.sh\n```\n", "no script tools/nix.sh"),
    ("docs/a.md", "## C, d\n```sh\nbuild/release/wunderlich x\n```\n", "exit code 1"),
    ("docs/a.md", "## C, d\n```yaml\nribbon: 1\n```\n", "not a valid scene"),
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
        return check(Path(folder), "/bin/false")[0]


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
    faults, ran = check(Path(__file__).resolve().parent.parent, program)
    print("\n".join(faults) or f"check_docs: links lead somewhere, {ran} code blocks and commands ran")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
