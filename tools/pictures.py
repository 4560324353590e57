#!/usr/bin/env python3
"""Draws docs/images/*.png: runs the shipped scenes and photographs the 3D view of their report pages.

usage: tools/pictures.py [--program PATH] [--compare] [SCENE...]     needs the distribution's chromium, which draws in software
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SIZE = (1200, 750)

# Keys that the page understands, from its usual view, and what the program is asked beside the scene's name.
MORE = {
    "moebius": {"set": ["ribbon.segments=100"]},
    "coil": {"set": ["solver.duration=2"]},  # where it lies loosened
    # Motions are shown where they are busy, not where they end.
    "belt-release-stiff": {"set": ["solver.duration=0.3"]},
    "belt-release-soft": {"set": ["solver.duration=0.3"]},
    "twist-release-stiff": {"set": ["solver.duration=0.3"]},
    "twist-release-soft": {"set": ["solver.duration=0.3"]},
    "slide-cylinder": {"set": ["solver.duration=0.4"]},
    "swing": {"set": ["solver.duration=0.72"]},
    "knot": {"set": ["solver.duration=4.2"], "keys": ["ArrowUp"] * 9 + ["+"] * 18},
    "whip": {"set": ["solver.duration=0.6"]},
}

COMPARED = ["twist-pi", "twist-2pi", "twist-and-shorten"]  # the paper's Fig. 8, and the case of other programs

STAGE = """<style>
  .tools, .player, .legend, .top, .figures, .card, footer, #warnings { display: none !important }
  .stage, .view { position: fixed !important; inset: 0; width: 100vw !important; height: 100vh !important;
                  border: 0 !important; border-radius: 0 !important }
  .view { background: #f6f3ec !important }
  .view::before, .view::after { display: none !important }
</style>
<script>addEventListener('load', () => setTimeout(() => {
  const view = document.getElementById('view');
  for (const key of %s) view.dispatchEvent(new KeyboardEvent('keydown', { key }));
  document.getElementById('rulings').click();
}, 500));</script>
<footer id="""


def photograph(page: pathlib.Path, picture: pathlib.Path, keys: list[str]) -> None:
    text = page.read_text(encoding="utf-8").replace("<footer id=", STAGE % json.dumps(keys), 1)
    shoot(page, text, picture, SIZE)


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


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=str(ROOT / "build/release/wunderlich"))
    parser.add_argument("--compare", action="store_true", help="draw the comparisons of models instead")
    parser.add_argument("scenes", nargs="*")
    options = parser.parse_args()
    images = ROOT / "docs/images"
    images.mkdir(exist_ok=True)
    if options.compare:
        for scene in options.scenes or COMPARED:
            with tempfile.TemporaryDirectory() as folder:
                out = pathlib.Path(folder) / scene
                code = subprocess.run([options.program, "compare", scene, "--out", str(out), "--quiet"]).returncode
                if code not in (0, 3):  # 3: a model did not converge; its last state is drawn
                    raise SystemExit(f"{scene}: exit code {code}")
                photograph_models(out / "report.html", images / f"compare-{scene}.png")
        return
    for scene in options.scenes or sorted(path.stem for path in (ROOT / "scenes").glob("*.yaml")):
        more = MORE.get(scene, {})
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / scene
            command = [options.program, "run", scene, "--out", str(out), "--formats", "html", "--quiet"]
            for setting in more.get("set", []):
                command += ["--set", setting]
            subprocess.run(command, check=True)
            picture = images / f"{scene}.png"
            photograph(out / "report.html", picture, more.get("keys", []))
            energy = json.loads((out / "summary.json").read_text())["energy"]["normalized"]
            print(f"{scene}: V l/(D w) = {energy:.6g}, {picture.stat().st_size // 1000} kB")


if __name__ == "__main__":
    main()
