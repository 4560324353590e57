"""Which pages the site has and in what order, and how links of the repository's Markdown lead inside the site."""

import os
import re
from pathlib import Path, PurePosixPath

LINK = re.compile(r"(!?\[[^\]]*\]\()([^)\s]+)(\))")
FENCE = re.compile(r"^```.*?^```", re.M | re.S)
AT_ROOT = {"README.md": "index.md", "CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md",
           "src/wunderlich": "api/index.md"}

# Pages that are not named here come under "More"; names without a page are passed over.
NAVIGATION = {
    "Use": ["start", "scene-format", "exports", "sweeps", "python", "browser", "library", "limits"],
    "Results": ["gallery", "validation", "baselines", "performance"],
    "Theory": ["theory", "implicit", "contact", "two-stage", "notation", "equation-map"],
    "C++ reference": ["api/*"],
    "Project": ["architecture", "decisions/*", "contributing", "changelog"],
}


def page_of(name):
    """The site's page of a Markdown file of the repository, or None."""
    if name in AT_ROOT:
        return AT_ROOT[name]
    if name.startswith("docs/") and name.endswith(".md"):
        return name.removeprefix("docs/").replace("decisions/README.md", "decisions/index.md")
    return None


def language_of(path):
    """What highlights a file."""
    known = {".hpp": "cpp", ".cpp": "cpp", ".py": "python", ".sh": "sh", ".yaml": "yaml", ".toml": "toml", ".ts": "ts",
             ".json": "json", ".cmake": "cmake", ".bib": "bibtex", ".md": "md"}
    return "cmake" if path.name == "CMakeLists.txt" else known.get(path.suffix, "text")


class Stage:
    """The folder of Markdown that the generator reads, made from the repository at `root`."""

    def __init__(self, root, folder):
        self.root, self.folder = Path(root), Path(folder)
        self.files, self.pages = {}, []  # files shown as they are by what they are called in the repository

    def write(self, page, text):
        path = self.folder / page
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        self.pages.append(page)

    def add_page(self, name):
        """A Markdown file of the repository, its links turned."""
        page, text = page_of(name), (self.root / name).read_text(encoding="utf-8")
        pieces, last = [], 0
        for fence in FENCE.finditer(text):
            pieces += [self.with_links(text[last:fence.start()], name, page), fence.group()]
            last = fence.end()
        self.write(page, "".join(pieces) + self.with_links(text[last:], name, page))

    def with_links(self, text, name, page):
        return LINK.sub(lambda match: self.turned(match, name, page), text)

    def turned(self, match, name, page):
        """A link of the file `name`, as it is on its page of the site."""
        target, mark, anchor = match.group(2).partition("#")
        if not target or re.match(r"[a-z]+:", target):
            return match.group(0)
        there = os.path.normpath((PurePosixPath(name).parent / target).as_posix())
        to = page_of(there) or (there.removeprefix("docs/") if there.startswith("docs/images/") else self.shown(there))
        return match.group(1) + os.path.relpath(to, PurePosixPath(page).parent) + mark + anchor + match.group(3)

    def shown(self, name):
        """The page that shows a file, or lists a folder, of the repository."""
        to = f"files/{name.rstrip('/')}.md"
        if to not in self.files:
            self.files[to] = name
        return to

    def add_files(self):
        """Pages of all files that others link to."""
        done = set()
        while todo := [to for to in self.files if to not in done]:
            for to in todo:
                done.add(to)
                self.write(to, self.file_page(to, self.root / self.files[to]))

    def file_page(self, to, path):
        name = path.relative_to(self.root).as_posix()
        if path.is_dir():
            listed = ""
            for child in sorted(child for child in path.iterdir() if child.is_file()):
                page = self.shown(child.relative_to(self.root).as_posix())
                listed += f"- [`{child.name}`]({os.path.relpath(page, Path(to).parent)})\n"
            return f"# `{name}/`\n\n{listed}"
        text = path.read_text(encoding="utf-8").rstrip("\n")
        return f"# `{name}`\n\n~~~~~~{language_of(path)}\n{text}\n~~~~~~\n"

    def navigation(self):
        """The generator's `nav`: every page but those of files."""
        left = [page for page in self.pages if not page.startswith("files/") and page != "index.md"]
        tree = [{"Home": "index.md"}]
        for title, names in NAVIGATION.items():
            found = []
            for name in names:
                if name.endswith("/*"):
                    group = [page for page in left if page.startswith(name[:-1])]
                    group.sort(key=lambda page: (not page.endswith("index.md"),))
                    found += group if name == "api/*" else [{name[:-2].capitalize(): group}] if group else []
                    left = [page for page in left if page not in group]
                elif f"{name}.md" in left:
                    found.append(f"{name}.md")
                    left.remove(f"{name}.md")
            tree += [{title: found}] if found else []
        return tree + ([{"More": left}] if left else [])
