#!/usr/bin/env python3
"""Checks that no file is longer than 400 lines and no function longer than 80.

    tools/check_size.py              check this repository
    tools/check_size.py --self-test  see long files and functions reported

C++ and TypeScript functions are found by their braces, Python ones by the parser. A TypeScript function does not
count the functions inside it: closures are how modules are written there.
"""

import ast
import re
import sys
from pathlib import Path

FILE_LIMIT = 400
FUNCTION_LIMIT = 80
FOLDERS = ["src", "apps", "bindings", "python", "tests", "bench", "tools", "validation", "web"]
SUFFIXES = {".cpp", ".hpp", ".py", ".ts", ".js"}
SCOPES = re.compile(r"\b(namespace|class|struct|union|enum|extern)\b")


def blank(text):
    """Comments, strings and character literals as spaces, line breaks kept."""
    pattern = r'`(?:\\.|[^`\\])*`|//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\''
    return re.sub(pattern, lambda match: re.sub(r"[^\n]", " ", match.group(0)), text, flags=re.S)


def starts_function(head, inside_function, nesting):
    """Does a brace after `head` open a function? Bodies of C++ lambdas count to the function they stand in."""
    if SCOPES.search(head.split("(")[0]):
        return False
    if nesting:
        return head.rstrip().endswith("=>") or bool(re.search(r"\bfunction\b|^\s*(async )?\w+\(", head)) and not (
            re.match(r"\s*(}?\s*else\b|if|for|while|switch|catch|do)\b", head))
    return not inside_function and "(" in head


def brace_functions(text, nesting=False):
    """Yields (first line, line count) of each function; with `nesting` the lines of functions inside are not counted."""
    text = blank(text)
    head_start, stack = 0, []  # of [first line or None, lines of functions inside]
    for match in re.finditer(r"[{};]", text):
        mark, position = match.group(0), match.start()
        if mark == "{":
            head = text[head_start:position]
            first = None
            if starts_function(head, any(level[0] for level in stack), nesting):
                first = text.count("\n", 0, head_start + len(head) - len(head.lstrip())) + 1
            stack.append([first, 0])
        elif mark == "}" and stack:
            first, inside = stack.pop()
            lines = text.count("\n", 0, position) + 2 - first if first else inside
            if first:
                yield first, lines - inside
            if stack and nesting:
                stack[-1][1] += lines
        head_start = match.end()


def python_functions(text):
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            yield node.lineno, node.end_lineno - node.lineno + 1


def check_text(name, text):
    """Faults of one file as printable lines."""
    faults = []
    lines = text.count("\n") + (not text.endswith("\n"))
    if lines > FILE_LIMIT:
        faults.append(f"{name}:1: {lines} lines; the limit is {FILE_LIMIT}")
    functions = python_functions(text) if name.endswith(".py") else brace_functions(text, name.endswith((".ts", ".js")))
    for first, length in functions:
        if length > FUNCTION_LIMIT:
            faults.append(f"{name}:{first}: a function of {length} lines; the limit is {FUNCTION_LIMIT}")
    return faults


def check(root):
    faults, count = [], 0
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix not in SUFFIXES or "node_modules" in path.parts:
                continue
            count += 1
            faults += check_text(path.relative_to(root).as_posix(), path.read_text(encoding="utf-8"))
    return faults, count


def self_test():
    body = "  f();\n" * 79
    cases = [
        ("a.cpp", "int x;\n" * 401, "401 lines"),
        ("b.cpp", "namespace a {\nint g(int a,\n      int b) {\n" + body + "}\n}\n", "b.cpp:2: a function of 82 lines"),
        ("c.cpp", "struct S {\n  void g() const {\n" + body + "  }\n};\n", "c.cpp:2: a function of 81 lines"),
        ("d.ts", "export function f(): void {\n" + "  g();\n" * 79 + "}\n", "d.ts:1: a function of 81 lines"),
        ("d.py", "def f():\n" + "    pass\n" * 80, "d.py:1: a function of 81 lines"),
    ]
    for name, text, expected in cases:
        faults = check_text(name, text)
        assert len(faults) == 1 and expected in faults[0], (name, expected, faults)
    fine = [
        ("e.cpp", "namespace a {\n" + "void g() {\n  if (x) {\n  }\n}\n" * 60 + "}\n"),
        ("f.cpp", 'const char* s = "{ (";\nvoid g() {\n' + "  f();  // {\n" * 78 + "}\n"),
        ("f.ts", "function f() {\n" + "  const g = () => {\n    if (x) {\n      h();\n    }\n  };\n" * 40 + "}\n"),
        ("g.cpp", "const int t[] = {\n" + "  1,\n" * 200 + "};\n"),
    ]
    for name, text in fine:
        assert not check_text(name, text), (name, check_text(name, text))
    print(f"check_size: self-test found all {len(cases)} planted faults")


def main():
    if "--self-test" in sys.argv:
        return self_test()
    faults, count = check(Path(__file__).resolve().parent.parent)
    limits = f"no file above {FILE_LIMIT} lines, no function above {FUNCTION_LIMIT}"
    print("\n".join(faults) or f"check_size: {count} files, {limits}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
