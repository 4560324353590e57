"""The C++ reference: each header as its authors wrote it, `///` comments as text and the declarations below them.

A header is split at its blank lines; what stands together, an overload set for instance, has one comment.
"""

import html
import re
import sys
import tempfile
from pathlib import Path

SOURCE = "src/wunderlich"
# What is installed, in the order in which the layers build on one another; the program's own folders come after them.
CORE = ["base", "math", "contact", "geometry", "energy", "constraint", "solver", "baseline"]
INNER = {"four.hpp", "chain_value.hpp"}  # how inner loops are written, not what they do
SPEAKING = CORE[:-1]  # where a comment is asked of every type and function; elsewhere a name may say it all
QUOTED = re.compile(r'//[^\n]*|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'')
# Forward declarations and the like.
NOTHING = re.compile(r"(?:\s*(?:(?:struct|class|enum class|using) [\w:]+;|static_assert\(.*\);|#.*)\n?)+")
TYPE = re.compile(r"^\s*(?:template\s*<.*>\s*)?(?:struct|class|enum class|enum)\s+(\w+)", re.M)
NAME = re.compile(r"(?:\busing\s+(\w+)\s*=|\b(operator\W+|\w+)\()")


def blank(code):
    """Comments and quoted text as spaces, so that braces and parentheses can be counted."""
    return QUOTED.sub(lambda match: " " * len(match.group(0)), code)


def chunks(text):
    """What stands between blank lines directly inside the innermost named namespace."""
    depth, chunk, openings = 0, [], []
    for line in text.splitlines():
        opening = re.match(r"(?:inline )?namespace [\w:]+ \{", line)
        if opening and depth == len(openings):
            openings.append(line)
        bare = blank(line)
        before, depth = depth, depth + bare.count("{") - bare.count("}")
        if depth < len(openings):
            openings.pop()
        elif before and not opening and "namespace detail" not in openings[-1]:
            if line.strip() or before > len(openings):
                chunk.append(line)
                continue
        if chunk and before <= len(openings) + 1:
            yield "\n".join(chunk)
        chunk = []


def without_body(code):
    """Declarations; a function's body of several lines goes."""
    bare, out, depth, position = blank(code), [], 0, 0
    if TYPE.search(bare) and TYPE.search(bare).start() == re.search(r"\S", bare).start():
        return code
    for match in re.finditer(r"[{}]", bare):
        if match.group() == "{":
            if depth == 0:
                start = match.start()
            depth += 1
        else:
            depth -= 1
            if depth == 0 and "\n" in code[start:match.end()] and ")" in bare[position:start]:
                out.append(code[position:start].rstrip() + ";")
                position = match.end()
    return "".join(out) + code[position:]


def names(code):
    """What a chunk declares: its type, or its functions and aliases."""
    bare = blank(code)
    declared = TYPE.search(bare)
    if declared and "(" not in bare[:declared.start()]:
        return [declared.group(1)]
    found, depth = [], 0
    for line in bare.splitlines():
        match = NAME.search(line) if depth == 0 else None
        name = match and (match.group(1) or match.group(2)).strip()
        if name and name not in found and name not in ("noexcept", "requires", "decltype", "alignas"):
            found.append(name)
        depth += line.count("(") + line.count("{") - line.count(")") - line.count("}")
    constants = re.findall(r"^(?:inline )?constexpr [\w:<>]+ (\w+)", bare, re.M)
    return found or constants


def prose(comment):
    """The text of a comment as Markdown."""
    lines = [re.sub(r"^\s*/// ?", "", line) for line in comment.splitlines()]
    parts = re.split(r"(`[^`\n]*`)", "\n".join(lines))
    parts[::2] = [re.sub(r"([*$])", r"\\\1", html.escape(part, quote=False)) for part in parts[::2]]
    text = re.sub(r"\s*@eq (\w+(?::[\w.]+)?)", r" [\1](../equation-map.md)", "".join(parts))
    return re.sub(r"^(- )", r"\n\1", text, count=1, flags=re.M)


def chunk_page(chunk, where, faults):
    """A chunk as Markdown; an undocumented one is a fault."""
    lines = chunk.splitlines()
    leading = next((i for i, line in enumerate(lines) if not line.lstrip().startswith("//")), len(lines))
    comment = "\n".join(line for line in lines[:leading] if line.lstrip().startswith("///"))
    code = without_body("\n".join(lines[leading:])).strip("\n")
    if not code or NOTHING.fullmatch(blank(code)):
        return ""
    title = names(code)
    if "///" not in chunk and re.search(r"[(]|^\s*(?:struct|class|enum)\b", blank(code), re.M):
        faults.append(f"{where}: {', '.join(title) or code.splitlines()[0]}: no `///` says what it is")
    heading = "".join(f"### {', '.join(title)}\n\n") if title else ""
    code = re.sub(r"///<?(?= )", "//", code)
    return f"{heading}{prose(comment)}\n\n```cpp\n{code}\n```\n\n"


def header_page(path, root, faults):
    """A header as a section of its folder's page."""
    text = path.read_text(encoding="utf-8")
    about = re.match(r"((?:///[^\n]*\n)*)", text).group(1)
    if not about:
        faults.append(f"{path.relative_to(root)}:1: no `///` says what the header is for")
    name = path.relative_to(root / "src")
    body = "".join(chunk_page(chunk, path.relative_to(root), faults) for chunk in chunks(text))
    return f"## {path.name}\n\n`#include \"{name}\"`\n\n{prose(about)}\n\n{body}"


def pages(root):
    """Markdown of each page by its name, and what is not documented."""
    root, faults, out = Path(root), [], {}
    folders = {path.parent.relative_to(root / SOURCE).as_posix() for path in (root / SOURCE).rglob("*.hpp")}
    rank = {layer: place for place, layer in enumerate(CORE)}
    for folder in sorted(folders, key=lambda folder: (rank.get(folder.split("/")[0], len(rank)), folder)):
        headers = [path for path in sorted((root / SOURCE / folder).glob("*.hpp")) if path.name not in INNER]
        layer = folder.split("/")[0]
        sections = "".join(header_page(path, root, faults if layer in SPEAKING else []) for path in headers)
        installed = "" if layer in CORE else "Part of the program; not installed.\n\n"
        out[f"{folder.replace('/', '-')}.md"] = f"# {folder}\n\n{installed}{sections}"
    return out, faults


HEADER = """/// What it is for.
#pragma once

#include <vector>

namespace wunderlich::geometry {

struct Later;

/// A pair. @eq Shen2015:11
struct Pair {
  int a;  ///< one

  int b;
};

/// Their sum,
/// and that of `more * 2`.
inline int sum(const Pair& pair) {
  return pair.a;
}
int sum(int a, int b);
UNDOCUMENTED
}  // namespace wunderlich::geometry
"""


def faults_and_page(more):
    with tempfile.TemporaryDirectory() as root:
        folder = Path(root) / SOURCE / "geometry"
        folder.mkdir(parents=True)
        (folder / "pair.hpp").write_text(HEADER.replace("UNDOCUMENTED", more), encoding="utf-8")
        made, faults = pages(root)
        return faults, made["geometry.md"]


def self_test():
    faults, page = faults_and_page("")
    wanted = ["## pair.hpp", "### Pair", "[Shen2015:11]", "  int a;  // one\n\n  int b;\n", "### sum",
              "and that of `more * 2`.", "inline int sum(const Pair& pair);\nint sum(int a, int b);"]
    assert not faults and "Later" not in page and all(text in page for text in wanted), (faults, page)
    for code, name in (("\nint twice(int a);", "twice"), ("\nstruct Bare {\n  int a;\n};", "Bare")):
        [fault] = faults_and_page(code)[0]
        assert f"pair.hpp: {name}: no `///`" in fault, fault
    print("site/api: self-test read a header and found both planted faults")


if __name__ == "__main__" and sys.argv[1:] == ["--self-test"]:
    self_test()
