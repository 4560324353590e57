"""The paper's Fig. 8: ribbon, rod and shells twisted under tension, and how far each is from an isometry."""

import json
import math
import subprocess

from common import at_most, between

PAPER = {"twist-pi": 0.0186, "twist-2pi": 0.0719}
TURN = {"twist-pi": math.pi, "twist-2pi": 2 * math.pi}
HALF_WIDTH = 0.5 / 7.853981633974483  # of a strip of length 1


def helicoid(turn):
    """Relative excess of area and of rims of a strip twisted evenly about a straight centerline of length 1."""
    a = turn * HALF_WIDTH
    return 0.5 * (math.sqrt(1 + a * a) + math.asinh(a) / a) - 1, math.sqrt(1 + a * a) - 1


# The paper's meshes, in the measure of its projection.
SHELLS = ["compare.metric=mass", "compare.shell_conforming={along: 36, across: 4}", "compare.shell_nonconforming={along: 21, across: 4}"]


def compare(runner, scene):
    """{model: its figures}. A shell that does not come to rest is compared as it stands."""
    models = "ribbon,rod" if runner.quick else "ribbon,rod,shell-conforming,shell-nonconforming"
    out = runner.out / scene
    words = [word for setting in SHELLS for word in ("--set", setting)]
    result = subprocess.run([str(runner.program), "compare", scene, "--models", models, "--quiet", "--out", str(out), *words],
                            capture_output=True, text=True, check=False)
    if result.returncode not in (0, 3):
        raise RuntimeError(f"{scene}: exit code {result.returncode}: {result.stderr.strip()}")
    return {model["model"]: model for model in json.loads((out / "comparison.json").read_text())["models"]}


def measure(runner):
    rows, data = [], {}
    for scene, paper in PAPER.items():
        found = data[scene] = compare(runner, scene)
        area, rims = helicoid(TURN[scene])
        rod, ribbon = found["rod"], found["ribbon"]
        rows += [
            between(f"{scene}: rod's area too large, over a helicoid's", rod["area_error"] / area, 0.9, 1.25),
            between(f"{scene}: rod's rims too long, over a helicoid's", rod["rim_stretch"] / rims, 0.9, 1.1, f"{100 * paper:.2f} %"),
            at_most(f"{scene}: ribbon's area error", abs(ribbon["area_error"]), 1e-10),
            at_most(f"{scene}: ribbon's diagonal strain", abs(ribbon["diagonal_strain"]), 1e-8),
        ]
        if "shell-conforming" in found:
            off = {model: abs(found[f"shell-{model}"]["normalized"] / ribbon["normalized"] - 1) for model in ("conforming", "nonconforming")}
            rows.append(at_most(f"{scene}: conforming shell's energy off the ribbon's, over the nonconforming's", off["conforming"] / off["nonconforming"],
                                0.9, "the nonconforming deviates further"))
    return rows, data


def draw(data, drawing, path):
    figure, axes = drawing.panels(3, size=(4.6, 3.2))
    for ax, (key, title) in zip(axes, (("area_error", "Area"), ("diagonal_strain", "Material lines at 45°"), ("rim_stretch", "Rims"))):
        for k, (scene, found) in enumerate(data.items()):
            values = [max(abs(model[key]), 1e-16) for model in found.values()]
            ax.bar([i + 0.38 * k for i in range(len(found))], values, width=0.36, label=scene, color=drawing.rainbow(2)[k])
        ax.set(title=f"{title}, relative error", yscale="log", ylim=(1e-16, 1))
        ax.set_xticks([i + 0.19 for i in range(len(found))], [name.replace("shell-", "") for name in found])
    axes[0].legend()
    drawing.save(figure, path)
