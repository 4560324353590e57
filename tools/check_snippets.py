#!/usr/bin/env python3
"""Runs every code block of every page: what a page tells to type works, and prints what the page says.

    tools/check_snippets.py [--build DIR] [PAGE...]   needs a built program, default build/release
    tools/check_snippets.py --self-test               plant faults in a temporary tree and see each reported

A page's blocks run in order in one folder that looks like a fresh checkout with the program built:

- `sh` runs, and every line must succeed; a `text` block under it is what it prints, `...` standing for anything. A
  program of tests or benchmarks, which ./test runs or which take their time, is asked only if it has what is named.
- `yaml` with a ribbon is a scene, with `axes` a sweep, else a part of a scene that is tried in one. `json` is read.
- `cpp` compiles; `python` runs, all blocks of a page together.
- A block whose first line is a comment that names a file, `# CMakeLists.txt`, is written to that file first.

A block under `<!-- not run: REASON -->` is only looked at: its scripts and presets must exist. So is one that would
install, serve or change something. Blocks of pages in ELSEWHERE are run by a test of their own.
"""

import argparse
import concurrent.futures
import json
import os
import re
import shlex
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

FENCE = re.compile(r"(?:^<!-- not run: (?P<why>[^\n]+?) -->\n)?^```(?P<language>\w*)\n(?P<text>.*?)^```", re.M | re.S)
NAMED = re.compile(r"(?:#|//) ([\w./-]+\.\w+)\n")
ELSEWHERE = {"docs/python.md": "tests/python/test_tutorial.py"}  # `python` blocks, and `text` under them
UNSAFE = {r"\bpip3? (install|wheel)": "installs", r"^\./run --web": "serves", r"^\./test": "runs this",
          r"^(sudo|apt)": "installs", r"^tools/(pictures|nightly|setup|fuzz)": "takes long, or changes the checkout"}
SECONDS = 120  # that a block may take
# Stands around a part of a scene that has no strip of its own.
STRIP = "\nribbon: {length: 1, width: 0.1, segments: 20}\n"
HELD = "clamps: [{at: start}]\n"

# ./run as it is, for files and folders of the page's own: `out/` of the checkout is left alone.
RUN = """#!/usr/bin/env bash
case ${1:-} in ''|-*) scene=moebius ;; *) scene=$1; shift ;; esac
out=out/$(basename "${scene%.*}"); more=()
while [ $# -gt 0 ]; do
  case $1 in --out) out=$2; shift ;; *) more+=("$1") ;; esac
  shift
done
[ ! -f "$scene" ] || scene=$PWD/$scene
exec flock ROOT/build ROOT/run "$scene" "${more[@]}" --out "$PWD/$out"
"""


class Block:
    """A code block: what it is, what it says, where it stands."""

    def __init__(self, match, page):
        self.why, self.language, self.text = match.group("why"), match.group("language"), match.group("text")
        if self.language == "sh" and not self.why:
            self.why = next((why for line, why in UNSAFE.items() if re.search(line, self.text, re.M)), None)
        self.line = page.count("\n", 0, match.start("text")) + 1
        named = NAMED.match(self.text)
        self.file = named.group(1) if named else None


def pages(root):
    return sorted([*root.glob("*.md"), *(root / "docs").rglob("*.md")])


def lay_out(root, build, folder):
    """A folder like a checkout, without what runs leave."""
    for path in root.iterdir():
        if path.name not in ("out", "run", "build", ".git"):
            (folder / path.name).symlink_to(path)
    (folder / "build").mkdir()
    (folder / "build/release").symlink_to(build)
    (folder / "run").write_text(RUN.replace("ROOT", shlex.quote(str(root))), encoding="utf-8")
    (folder / "run").chmod(0o755)


def run(command, folder, build, given=None):
    """Runs a command in the page's folder; its exit code and all that it prints."""
    environment = os.environ | {"PATH": f"{build}:{os.environ['PATH']}", "MPLBACKEND": "Agg"}
    process = subprocess.Popen(command, cwd=folder, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True, start_new_session=True)
    try:
        printed = process.communicate(given, SECONDS)[0]
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)  # with all that it started
        return 1, process.communicate()[0] + f"not done in {SECONDS} s"
    return process.returncode, printed


def check_looked_at(root, block):
    """What is wrong with a block that is not run, as far as looks tell."""
    presets = root / "CMakePresets.json"
    known = {p["name"] for p in json.loads(presets.read_text())["configurePresets"]} if presets.exists() else set()
    for offset, line in enumerate(block.text.splitlines() if block.language == "sh" else []):
        words = shlex.split(line, comments=True)
        for word, following in zip(words, words[1:] + [""]):
            if word == "--preset" and following not in known:
                yield block.line + offset, f"no preset '{following}'"
            if re.match(r"(\./|tools/|validation/|bench/|tests/)\S+$", word) and not (root / word).exists():
                yield block.line + offset, f"no file {word}"


def check_sh(block, folder, build):
    """Runs the lines of a block; yields what failed, and keeps what it printed."""
    script = "set -eE\ntrap 'echo \"at line $LINENO: $BASH_COMMAND\"' ERR\n"
    text = re.sub(r"^build/release/test_.*$", r"\g<0> --gtest_list_tests | grep -q '^ '", block.text, flags=re.M)
    text = re.sub(r"^build/release/bench_.*$", r"\g<0> --benchmark_list_tests | grep -q .", text, flags=re.M)
    path = folder / ".block.sh"
    path.write_text(script + text, encoding="utf-8")
    code, block.printed = run(["bash", path.name], folder, build)
    if code:
        at = re.findall(r"^at line (\d+): ", block.printed, re.M)
        yield block.line + (int(at[-1]) - 3 if at else 0), f"exit code {code}: {block.printed.strip()}"


def check_printed(block, above):
    """The lines of a `text` block must stand in what the block above printed, in this order."""
    if above is None or not hasattr(above, "printed"):
        yield block.line, "a text block stands under the sh block that prints it"
        return
    printed = iter(above.printed.splitlines())
    for offset, line in enumerate(block.text.splitlines()):
        wanted = re.compile(r"\s*" + r".*".join(re.escape(part) for part in line.strip().split("...")) + r"\s*")
        if not any(wanted.fullmatch(found) for found in printed):
            yield block.line + offset, f"not printed: {line.strip()!r}; printed was:\n{above.printed}"
            return


def check_yaml(block, folder, build):
    """A scene, a sweep or a part of a scene is accepted."""
    path = folder / (block.file or "snippet.yaml")
    sweep = re.search(r"^axes:", block.text, re.M)
    text = block.text if sweep or re.search(r"^ribbons?:", block.text, re.M) else block.text + STRIP + (
        "" if re.search(r"^(clamps|pins):", block.text, re.M) else HELD)
    path.write_text(text, encoding="utf-8")
    command = ["sweep", "--out", "out/snippet"] if sweep else ["check"]
    code, printed = run([build / "wunderlich", *command, path.name], folder, build)
    if code:
        yield block.line, f"not accepted: {printed.strip()}"


def check_block(root, build, folder, block, above):
    """What is wrong with one block."""
    if block.why:
        return check_looked_at(root, block)
    if block.language == "sh":
        return check_sh(block, folder, build)
    if block.language == "text":
        return check_printed(block, above)
    if block.language == "yaml":
        return check_yaml(block, folder, build)
    if block.file or block.language == "python":
        return []  # written before anything ran; python blocks run together
    if block.language == "cpp":
        eigen = ["-std=c++20", "-fsyntax-only", f"-I{root / 'src'}", "-I/usr/include/eigen3", "-xc++", "-"]
        code, printed = run(["g++", *eigen], folder, build, block.text)
        return [(block.line, printed)] if code else []
    if block.language == "json":
        try:
            json.loads(block.text)
            return []
        except ValueError as fault:
            return [(block.line, str(fault))]
    return [(block.line, f"nothing is known of how to run '{block.language}'; say why not, `<!-- not run: ... -->`")]


def check_python(mine, folder, build):
    """Runs the python blocks of a page as one program, its lines numbered as in the page."""
    program = ""
    for block in mine:
        program += "\n" * (block.line - 1 - program.count("\n")) + block.text
    code, printed = run([sys.executable, "-"], folder, build, program) if mine else (0, "")
    if code:
        yield mine[0].line, printed


def without_elsewhere(root, page, blocks):
    """The blocks that are left to this script, and what is wrong with the test that has the others."""
    name = page.relative_to(root).as_posix()
    if name not in ELSEWHERE:
        return blocks, []
    test = root / ELSEWHERE[name]
    has = test.exists() and page.name in test.read_text(encoding="utf-8")
    above = [None, *blocks]
    mine = [block for block, before in zip(blocks, above)
            if block.language != "python" and not (block.language == "text" and before.language == "python")]
    return mine, [] if has else [(1, f"{ELSEWHERE[name]} does not run this page")]


def write(folder, block):
    """Writes a block to the file that it names, which must not be one of the checkout's."""
    path = folder / block.file
    assert not path.parent.exists() or path.parent.resolve().is_relative_to(folder.resolve()), block.file
    assert not path.exists(), block.file
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(block.text, encoding="utf-8")


def check_page(root, build, page):
    """Faults of a page, how many of its blocks ran and how many did not."""
    text = page.read_text(encoding="utf-8")
    blocks, faults = without_elsewhere(root, page, [Block(match, text) for match in FENCE.finditer(text)])
    above = None
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        lay_out(root, build, folder)
        for block in blocks:
            if block.file and not block.why:
                write(folder, block)
        for block in blocks:
            faults += check_block(root, build, folder, block, above)
            above = block
        python = [block for block in blocks if block.language == "python" and not block.why and not block.file]
        faults += check_python(python, folder, build)
    where = page.relative_to(root)
    skipped = [f"{where}:{block.line}: not run: {block.why}" for block in blocks if block.why]
    return [f"{where}:{line}: {fault}" for line, fault in faults], len(blocks) - len(skipped), skipped


def check(root, build, chosen=()):
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        done = list(pool.map(lambda page: check_page(root, build, page), chosen or pages(root)))
    return sum((d[0] for d in done), []), sum(d[1] for d in done), sum((d[2] for d in done), [])


CLEAN = """
```sh
echo one; echo two 2 s
```

```text
one
two ... s
```

```json
{}
```

```python
a = 1
```

```python
assert a == 1
```

```sh
# a.sh
```

```sh
. ./a.sh
```

<!-- not run: never ends -->
```sh
sleep inf
```
"""
PLANTED = [
    ("```sh\ntrue\nfalse\n```\n", "a.md:3: exit code 1"),
    ("```sh\necho one\n```\n\n```text\ntwo\n```\n", "a.md:6: not printed: 'two'"),
    ("```sh\necho one; echo two\n```\n\n```text\ntwo\none\n```\n", "a.md:7: not printed: 'one'"),
    ("```text\none\n```\n", "a.md:2: a text block"),
    ("```yaml\nribbon: 1\n```\n", "a.md:2: not accepted"),
    ("```json\n{\n```\n", "a.md:2: Expecting"),
    ("```cpp\nint f( {\n```\n", "a.md:2: <stdin>"),
    ("```python\na = 1\n```\n\n```python\nassert a == 2\n```\n", 'line 6, in <module>'),
    ("```\nanything\n```\n", "a.md:2: nothing is known"),
    ("<!-- not run: long -->\n```sh\ntools/none.sh\n```\n", "a.md:3: no file tools/none.sh"),
    ("<!-- not run: long -->\n```sh\ncmake --preset none\n```\n", "a.md:3: no preset 'none'"),
]


def faults_of(text):
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        (root / "docs").mkdir()
        (root / "wunderlich").symlink_to("/bin/false")
        (root / "README.md").write_text("# A\n", encoding="utf-8")
        (root / "docs/a.md").write_text(text, encoding="utf-8")
        return check(root, root)[0]


def self_test():
    assert not faults_of(CLEAN), faults_of(CLEAN)
    for text, expected in PLANTED:
        faults = faults_of(text)
        assert any(expected in fault for fault in faults), (expected, faults)
    print(f"check_snippets: self-test found all {len(PLANTED)} planted faults")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", type=Path, default=Path("build/release"))
    parser.add_argument("--self-test", action="store_true")
    parser.add_argument("page", nargs="*", type=Path)
    arguments = parser.parse_args()
    if arguments.self_test:
        return self_test()
    root = Path(__file__).resolve().parent.parent
    faults, ran, skipped = check(root, arguments.build.resolve(), [page.resolve() for page in arguments.page])
    print("\n".join(skipped + faults))
    print(f"check_snippets: {len(faults)} faults; {ran} blocks ran, {len(skipped)} did not, for the reasons above")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
