#!/usr/bin/env python3
"""Checks that includes point one way through the layers, and that the core stays portable and silent.

    tools/check_layers.py [ROOT]       check a tree (default: this repository)
    tools/check_layers.py --self-test  plant faults in a temporary tree and see each reported
"""

import re
import sys
import tempfile
from pathlib import Path

# layer -> layers it may include besides itself
LAYERS = {
    "base": [],
    "math": ["base"],
    "contact": ["base", "math"],
    "geometry": ["base", "math"],
    "energy": ["base", "math", "geometry"],
    "constraint": ["base", "math", "geometry", "contact"],
    "solver": ["base", "math", "geometry", "energy", "contact", "constraint"],
    "baseline": ["base", "math", "geometry", "contact", "constraint"],
    "scene": ["base", "math", "geometry", "energy", "contact", "constraint", "solver", "baseline"],
    "picture": ["base"],
    "io": ["base"],
    "sweep": ["base", "geometry", "scene", "io"],
}
CORE = ["base", "math", "contact", "geometry", "energy", "constraint", "solver", "baseline"]
# layer -> prefixes of third-party headers it may include; what has no slash and no dot is the standard library
THIRD_PARTY = {layer: ["Eigen/"] for layer in CORE}
THIRD_PARTY["scene"] = ["Eigen/", "yaml-cpp/", "fmt/"]
THIRD_PARTY["sweep"] = ["nlohmann/", "fmt/", "fcntl.h", "poll.h", "sys/", "unistd.h"]  # processes, locks
THIRD_PARTY["picture"] = ["Eigen/", "fmt/", "png.h", "fcntl.h", "spawn.h", "sys/", "unistd.h"]  # PNG, ffmpeg
THIRD_PARTY["io"] = ["Eigen/", "nlohmann/", "fmt/", "fcntl.h", "unistd.h"]  # POSIX: files that survive a power cut

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
# The core does no input or output, starts no threads, and must build with libc++ 13.
FORBIDDEN_IN_CORE = {
    r"#\s*include\s*<(iostream|fstream|cstdio|stdio\.h|filesystem|thread|mutex|future|print)>": "I/O or threads",
    r"\bstd::(cout|cerr|clog|printf|puts)\b": "printing",
    r"\bstd::(ranges|views)::": "not in libc++ 13",
    r"\bstd::(format|jthread|source_location|to_chars|expected|print)\b": "not in libc++ 13",
}


def without_comments(text):
    """Blanks comments, keeping line breaks."""
    blank = lambda match: re.sub(r"[^\n]", " ", match.group(0))
    return re.sub(r"//[^\n]*|/\*.*?\*/", blank, text, flags=re.S)


def layer_of(path):
    """Layer of a header as it is written in an include: wunderlich/<layer>/..."""
    parts = path.split("/")
    return parts[1] if len(parts) > 2 and parts[0] == "wunderlich" else None


def check_include(layer, bracket, header):
    """What is wrong with one include of a file in `layer`, or None."""
    target = layer_of(header)
    if target is not None:
        if bracket == "<":
            return f'write "{header}" with quotes: it is one of ours'
        if target != layer and target not in LAYERS.get(layer, []):
            allowed = ", ".join(LAYERS[layer]) or "nothing"
            return f"{layer} must not include {target} (it may include {allowed})"
        return None
    if bracket == '"':
        return f'write "wunderlich/<layer>/{header}": own headers go by their full path'
    standard = "/" not in header and "." not in header
    if standard or any(header.startswith(prefix) for prefix in THIRD_PARTY[layer]):
        return None
    return f"{layer} must not depend on <{header}> (third-party: {', '.join(THIRD_PARTY[layer])})"


def check_file(path, layer, name):
    """Yields (line, message) for one file of the library."""
    text = without_comments(path.read_text(encoding="utf-8"))
    for number, line in enumerate(text.splitlines(), 1):
        include = INCLUDE.match(line)
        message = check_include(layer, *include.groups()) if include else None
        if message:
            yield number, message
        if layer in CORE:
            for pattern, why in FORBIDDEN_IN_CORE.items():
                if re.search(pattern, line):
                    yield number, f"not in the core: {line.strip()} ({why})"
    namespace = "wunderlich" if layer == "base" else f"wunderlich::{layer}"
    if not re.search(rf"\bnamespace {namespace}\b", text):
        yield 1, f"nothing in namespace {namespace}: folders are namespaces ({name})"


def check_cycles(graph):
    """Yields a message for each cycle of headers."""
    done = set()

    def visit(node, trail):
        if node in trail:
            yield node, " -> ".join(trail[trail.index(node):] + [node])
        elif node not in done:
            done.add(node)
            for target in graph.get(node, []):
                yield from visit(target, trail + [node])

    for start in sorted(graph):
        yield from visit(start, [])


def check(root):
    """All faults of a tree as printable lines."""
    source = root / "src" / "wunderlich"
    faults, graph = [], {}
    for path in sorted(source.rglob("*.[ch]pp")):
        name = path.relative_to(root).as_posix()
        layer = path.relative_to(source).parts[0]
        if layer not in LAYERS:
            faults.append(f"{name}:1: no layer '{layer}'; add it to LAYERS in tools/check_layers.py")
            continue
        faults += [f"{name}:{line}: {message}" for line, message in check_file(path, layer, name)]
        own = path.relative_to(root / "src").as_posix()
        graph[own] = re.findall(r'#\s*include\s*"(wunderlich/[^"]+)"', path.read_text(encoding="utf-8"))
    faults += [f"src/{start}:1: headers include each other: {trail}" for start, trail in check_cycles(graph)]
    return faults, len(graph)


PLANTED = {
    "math/a.hpp": ('#include "wunderlich/geometry/b.hpp"', "math must not include geometry"),
    "energy/c.hpp": ('#include "wunderlich/constraint/d.hpp"', "energy must not include constraint"),
    "io/e.hpp": ('#include "wunderlich/scene/f.hpp"', "io must not include scene"),
    "solver/g.hpp": ("#include <yaml-cpp/yaml.h>", "solver must not depend on"),
    "geometry/h.hpp": ("#include <iostream>", "I/O or threads"),
    "energy/i.hpp": ("auto s = std::ranges::max(v);", "libc++ 13"),
    "base/j.hpp": ('#include "types.hpp"', "full path"),
    "scene/k.hpp": ("#include <wunderlich/base/types.hpp>", "with quotes"),
    "baseline/m.hpp": ('#include "wunderlich/solver/n.hpp"', "baseline must not include solver"),
    "utils/l.hpp": ("", "no layer 'utils'"),
}
CLEAN = '// #include <iostream>\n#include <vector>\n\n#include <Eigen/Core>\n\n#include "wunderlich/base/a.hpp"\n'


def plant(root, name, line):
    path = root / "src" / "wunderlich" / name
    layer = path.parent.name
    namespace = "wunderlich" if layer == "base" else f"wunderlich::{layer}"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"{line}\nnamespace {namespace} {{}}\n", encoding="utf-8")


def self_test():
    with tempfile.TemporaryDirectory() as folder:
        plant(Path(folder), "base/a.hpp", "")
        plant(Path(folder), "solver/clean.cpp", CLEAN)
        faults, _ = check(Path(folder))
        assert not faults, faults
    for name, (line, expected) in PLANTED.items():
        with tempfile.TemporaryDirectory() as folder:
            plant(Path(folder), name, line)
            faults, _ = check(Path(folder))
            where = f"src/wunderlich/{name}:1: "
            assert any(f.startswith(where) and expected in f for f in faults), (name, expected, faults)
    with tempfile.TemporaryDirectory() as folder:
        plant(Path(folder), "base/a.hpp", '#include "wunderlich/base/b.hpp"')
        plant(Path(folder), "base/b.hpp", '#include "wunderlich/base/a.hpp"')
        faults, _ = check(Path(folder))
        assert any("include each other" in f for f in faults), faults
    print(f"check_layers: self-test found all {len(PLANTED) + 1} planted faults")


def main():
    if "--self-test" in sys.argv:
        return self_test()
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent
    faults, count = check(root)
    print("\n".join(faults) or f"check_layers: {count} files, all includes point the right way")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
