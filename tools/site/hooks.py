"""What the generator does not do itself: maths set when the site is built, and a search that needs no server."""

import html
import json
import re
import subprocess
from pathlib import Path

HERE = Path(__file__).resolve().parent
MATHS = re.compile(r'<(span|div) class="arithmatex">\\[(\[](.*?)\\[)\]]</\1>', re.S)


def on_post_page(output, page, config):
    """Sets the maths of a page by KaTeX; a formula that it cannot read stops the build."""
    formulas = [(html.unescape(match.group(2)), match.group(1) == "div") for match in MATHS.finditer(output)]
    if not formulas:
        return output
    done = subprocess.run(["node", HERE / "maths.js"], input=json.dumps(formulas), capture_output=True, text=True,
                          check=False)
    if done.returncode:
        raise SystemExit(f"{page.file.src_path}: {done.stderr}")
    rendered = iter(json.loads(done.stdout))
    return MATHS.sub(lambda match: f'<{match.group(1)} class="maths">{next(rendered)}</{match.group(1)}>', output)


def on_post_build(config):
    """Files are not searched. From a folder a page may neither fetch the index nor start the worker that searches it:
    both go into a script."""
    site = Path(config["site_dir"])
    path = site / "search/search_index.json"
    index = json.loads(path.read_text(encoding="utf-8"))
    index["docs"] = [entry for entry in index["docs"] if not entry["location"].startswith("files/")]
    for entry in index["docs"]:
        entry["text"] = re.sub(r"\\[()\[\]]", "", entry["text"])  # what is around TeX
    index = json.dumps(index, ensure_ascii=False)
    path.write_text(index, encoding="utf-8")
    [worker] = (site / "assets/javascripts/workers").glob("search.*.min.js")
    source = json.dumps(worker.read_text(encoding="utf-8"))
    (site / "search/from-folder.js").write_text(
        f"""var __search = {{ index: Promise.resolve({index}) }};
window.Worker = class extends Worker {{
  constructor() {{ super(URL.createObjectURL(new Blob([{source}], {{ type: "text/javascript" }}))); }}
}};
""", encoding="utf-8")
