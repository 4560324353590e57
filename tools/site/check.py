#!/usr/bin/env python3
"""Checks the built site: links, anchors and images lead somewhere inside it, nothing is loaded from another host, all
maths is set, every page is reached.

usage: tools/site/check.py [SITE]       default build/site
       tools/site/check.py --self-test  plant faults in a small site and see each reported
"""

import re
import sys
import tempfile
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

ROOT = Path(__file__).resolve().parent.parent.parent
UNREAD = {"script", "style", "code", "pre", "annotation", "textarea"}  # where a dollar sign is a dollar sign
LOADS = {("script", "src"), ("img", "src"), ("iframe", "src"), ("source", "src"), ("video", "src"), ("audio", "src"),
         ("embed", "src"), ("object", "data"), ("link", "href")}
NO_LOAD = {"canonical", "next", "prev"}  # of <link rel>


class Page(HTMLParser):
    """What a page links to, loads, names and says."""

    def __init__(self, text):
        super().__init__()
        self.links, self.loads, self.names, self.faults, self.open = [], [], [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        known = dict(attrs)
        self.names += [known[key] for key in ("id", "name") if known.get(key) and (key == "id" or tag == "a")]
        if tag == "a" and known.get("href"):
            self.links.append((self.getpos()[0], known["href"]))
        if tag == "img" and not known.get("alt"):
            self.faults.append((self.getpos()[0], f"image {known.get('src')} without a description"))
        for key, value in attrs:
            if (tag, key) in LOADS and value and not (tag == "link" and known.get("rel") in NO_LOAD):
                self.loads.append((self.getpos()[0], value))
        if tag in UNREAD:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if self.open and self.open[-1] == tag:
            self.open.pop()

    def handle_data(self, data):
        if not self.open and re.search(r"\$|\\[(\[]|\\\w+\{", data):
            self.faults.append((self.getpos()[0], f"maths that was not set: {data.strip()[:60]!r}"))


def target_of(site, page, link):
    """The file that a link of a page leads to, and its anchor; None for links to elsewhere."""
    parts = urlsplit(link)
    if parts.scheme or parts.netloc:
        return None
    path = unquote(parts.path)
    base = site if path.startswith("/") else page.parent
    file = (base / path.lstrip("/")).resolve() if path else page
    return (file / "index.html" if file.is_dir() else file), unquote(parts.fragment)


def check_style(path):
    """What a style sheet loads must be beside it."""
    for url in re.findall(r"url\(\s*[\"']?([^\"')]+)|@import\s+[\"']([^\"']+)", path.read_text(encoding="utf-8")):
        url = url[0] or url[1]
        if url.startswith("data:") or url.startswith("#"):
            continue
        if urlsplit(url).scheme or url.startswith("//") or not (path.parent / urlsplit(url).path).exists():
            yield f"loads {url}"


def check(site):
    """All faults of a site, and how many links were followed."""
    site = Path(site).resolve()
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in sorted(site.rglob("*.html"))}
    faults, reached, count = [], {site / "index.html", site / "404.html"}, 0
    for path, page in pages.items():
        where = path.relative_to(site)
        faults += [f"{where}:{line}: {text}" for line, text in page.faults]
        faults += [f"{where}: id '{name}' twice" for name in sorted({n for n in page.names if page.names.count(n) > 1})]
        for line, link in page.loads:
            found = target_of(site, path, link)
            if found is None and not link.startswith("data:"):
                faults.append(f"{where}:{line}: loads {link} from another host")
            elif found and not found[0].exists():
                faults.append(f"{where}:{line}: loads {link}, which is not there")
        for line, link in page.links:
            found, count = target_of(site, path, link), count + 1
            if found is None:
                continue
            file, anchor = found
            reached.add(file)
            if not file.exists() or not file.is_relative_to(site):
                faults.append(f"{where}:{line}: link to {link}, which is not there")
            elif anchor and file in pages and anchor not in pages[file].names:
                faults.append(f"{where}:{line}: no '{anchor}' in {file.relative_to(site)}")
    faults += [f"{path.relative_to(site)}: nothing links to it" for path in pages if path not in reached]
    for path in sorted(site.rglob("*.css")):
        faults += [f"{path.relative_to(site)}: {fault}" for fault in check_style(path)]
    return faults, len(pages), count


CLEAN = {
    "index.html": '<h1 id="a">A</h1><a href="b.html#c">x</a><a href="#a">y</a><a href="https://example.org">z</a>',
    "404.html": "",
    "b.html": '<p id="c"><code>$PATH</code><img src="i.png" alt="i"><link rel="stylesheet" href="s.css">',
    "i.png": "",
    "s.css": "p { background: url(i.png) }",
}
PLANTED = [
    ("index.html", '<a href="b.html">x</a><a href="d.html">x</a>', "index.html:1: link to d.html"),
    ("index.html", '<a href="b.html#d">x</a>', "index.html:1: no 'd' in b.html"),
    ("index.html", "none", "b.html: nothing links to it"),
    ("b.html", '<script src="https://example.org/x.js"></script>', "b.html:1: loads https://example.org/x.js"),
    ("b.html", '<img src="j.png" alt="j">', "b.html:1: loads j.png"),
    ("b.html", '<img src="i.png">', "b.html:1: image i.png without"),
    ("b.html", "<p>so $x$ is", "b.html:1: maths that was not set"),
    ("b.html", r"<p>\(x\)", "b.html:1: maths that was not set"),
    ("b.html", '<p id="c"><p id="c">', "b.html: id 'c' twice"),
    ("s.css", "@import 'https://example.org/f.css'", "s.css: loads https://example.org/f.css"),
]


def faults_of(files):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            (Path(folder) / name).write_text(text, encoding="utf-8")
        return check(folder)[0]


def self_test():
    assert not faults_of(CLEAN), faults_of(CLEAN)
    for name, text, expected in PLANTED:
        faults = faults_of(CLEAN | {name: text})
        assert any(expected in fault for fault in faults), (expected, faults)
    print(f"site/check: self-test found all {len(PLANTED)} planted faults")


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    faults, pages, links = check(sys.argv[1] if sys.argv[1:] else ROOT / "build/site")
    print("\n".join(faults) or
          f"site/check: {links} links on {pages} pages lead somewhere; maths is set; nothing loads from elsewhere")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
