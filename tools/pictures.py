#!/usr/bin/env python3
"""Draws docs/images/*.png: the shipped scenes by the program itself, comparisons of models as their page has them.

usage: tools/pictures.py [--program PATH] [SCENE...]             needs nothing but the program
       tools/pictures.py [--program PATH] --compare [SCENE...]   photographs the page with the distribution's chromium
       tools/pictures.py [--program PATH] --pages                the report, and the page of `./test web`
"""
import argparse
import json
import pathlib
import shutil
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent

# What the program is asked beside the scene's name, and the export beside the format.
MORE = {
    "moebius": {"set": ["ribbon.segments=100"]},
    "coil": {"set": ["solver.duration=1.98"]},  # where it lies loosened
    # Motions are shown where they are busy, not where they end.
    "belt-release-stiff": {"set": ["solver.duration=0.3"]},
    "belt-release-soft": {"set": ["solver.duration=0.3"]},
    "twist-release-stiff": {"set": ["solver.duration=0.3"]},
    "twist-release-soft": {"set": ["solver.duration=0.3"]},
    "slide-cylinder": {"set": ["solver.duration=0.4"]},
    "swing": {"set": ["solver.duration=0.72"]},
    "knot": {"set": ["solver.duration=4.2"], "export": ["--view", "28.65,80", "--zoom", "5"]},
    "whip": {"set": ["solver.duration=0.6"]},
}

COMPARED = ["twist-pi", "twist-2pi", "twist-and-shorten"]  # the paper's Fig. 8, and the case of other programs


def shoot(page: pathlib.Path, text: str, picture: pathlib.Path, size: tuple[int, int]) -> None:
    stage = page.with_name("stage.html")
    stage.write_text(text, encoding="utf-8")
    with tempfile.TemporaryDirectory() as profile:
        subprocess.run(
            ["chromium", "--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
             "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
             "--hide-scrollbars", f"--user-data-dir={profile}", f"--window-size={size[0]},{size[1]}",
             "--virtual-time-budget=3000", f"--screenshot={picture}", stage.as_uri()],
            check=True, timeout=300, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def photograph_models(page: pathlib.Path, picture: pathlib.Path) -> None:
    """The shapes of a comparison side by side, without the rest of its page."""
    style = """<style>
      body > *:not(.models) { display: none !important }
      .models { display: grid !important; grid-template-columns: repeat(4, 1fr) !important; margin: 0 !important }
    </style><footer id="""
    shoot(page, page.read_text(encoding="utf-8").replace("<footer id=", style, 1), picture, (1400, 440))


def draw_exports(program: str, images: pathlib.Path) -> None:
    """The pictures of docs/exports.md."""
    for name, scene, settings, export in (
        ("export-energy.png", "twist-pi", [], ["--to", "png", "--colour", "energy", "--size", "1000x450"]),
        ("export-pattern.svg", "moebius", ["ribbon.length=0.5", "ribbon.segments=100"], ["--to", "svg-pattern"]),
    ):
        with tempfile.TemporaryDirectory() as folder:
            out = str(pathlib.Path(folder) / "run")
            command = [program, "run", scene, "--out", out, "--formats", "none", "--quiet"]
            subprocess.run(command + [word for setting in settings for word in ("--set", setting)], check=True)
            subprocess.run([program, "export", out, *export, "--out", str(images / name)], check=True,
                           stdout=subprocess.DEVNULL)


def draw_pages(program: str, images: pathlib.Path) -> None:
    """The report of a run, and the page in the browser as its tests left it."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "run"
        subprocess.run([program, "run", "moebius", "--out", str(out), "--formats", "html", "--quiet"], check=True)
        page = out / "report.html"
        shoot(page, page.read_text(encoding="utf-8"), images / "report.png", (1280, 820))
    shot = ROOT / "build/web/shots/still.png"
    if not shot.exists():
        raise SystemExit(f"{shot.relative_to(ROOT)} is missing: `./test web` leaves it there")
    shutil.copy(shot, images / "browser.png")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=str(ROOT / "build/release/wunderlich"))
    parser.add_argument("--compare", action="store_true", help="draw the comparisons of models instead")
    parser.add_argument("--pages", action="store_true", help="draw the pages instead")
    parser.add_argument("scenes", nargs="*")
    options = parser.parse_args()
    images = ROOT / "docs/images"
    images.mkdir(exist_ok=True)
    if options.pages:
        draw_pages(options.program, images)
        return
    if options.compare:
        for scene in options.scenes or COMPARED:
            with tempfile.TemporaryDirectory() as folder:
                out = pathlib.Path(folder) / scene
                code = subprocess.run([options.program, "compare", scene, "--out", str(out), "--quiet"]).returncode
                if code not in (0, 3):  # 3: a model did not converge; its last state is drawn
                    raise SystemExit(f"{scene}: exit code {code}")
                photograph_models(out / "report.html", images / f"compare-{scene}.png")
        return
    if not options.scenes:
        draw_exports(options.program, images)
    for scene in options.scenes or sorted(path.stem for path in (ROOT / "scenes").glob("*.yaml")):
        more = MORE.get(scene, {})
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / scene
            command = [options.program, "run", scene, "--out", str(out), "--formats", "none", "--quiet"]
            for setting in more.get("set", []):
                command += ["--set", setting]
            subprocess.run(command, check=True)
            picture = images / f"{scene}.png"
            subprocess.run([options.program, "export", str(out), "--to", "png", "--out", str(picture), *more.get("export", [])], check=True,
                           stdout=subprocess.DEVNULL)
            energy = json.loads((out / "summary.json").read_text())["energy"]["normalized"]
            print(f"{scene}: V l/(D w) = {energy:.6g}, {picture.stat().st_size // 1000} kB", flush=True)


if __name__ == "__main__":
    main()
