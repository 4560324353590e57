"""The paper's Fig. 3: the relative error of the surface's area while a strip is twisted and a Moebius band settles."""

from pathlib import Path

from common import at_least, at_most

HERE = Path(__file__).resolve().parent

# The band, on top of the shipped scene: just closed, then pulled at two opposite places, then left to settle.
PULL = ("{at: {u: %s}, keyframes: "
        "[{time: 0, force: [0, 0, 0]}, {time: 0.5, force: [%d, %d, %d]}, {time: 1, force: [0, 0, 0]}]}")
BAND = ("ribbon.aspect=5pi/4", "initial.shape=closed", "output.frames=400",
        "solver={method: two-stage, duration: 4, time_step: 0.01, damping: {normal: 2, tangent: 2}}",
        f"forces=[{PULL % ('pi/2', 9, 9, 9)}, {PULL % ('3pi/2', -9, -9, -9)}]")


def measure(runner):
    strip = runner.run("strip", HERE / "strip.yaml")
    band = runner.run("band", "moebius", BAND)
    rows, runs = [], {"open strip, l/w = 10, end turned by π": strip, "Möbius band, l/w = 5π/4": band}
    for name, run in runs.items():
        errors = run.history["area_error"]
        rows.append(at_most(f"{name}: largest relative area error", max(errors), 3e-4, "< 1e-2 (Fig. 3)"))
        # A run that does not move would have no error at all.
        elastic = run.history["elastic"]
        rows.append(at_least(f"{name}: largest over smallest elastic energy", max(elastic) / min(elastic), 1.02))
    return rows, {name: run.history for name, run in runs.items()}


def draw(data, drawing, path):
    figure, axes = drawing.panels(2)
    for ax, (name, history) in zip(axes, data.items()):
        ax.semilogy(history["time"][1:], history["area_error"][1:], color="#1f6f8b")
        ax.axhline(1e-2, color="#b5482e", linestyle="--")
        ax.text(history["time"][-1], 1.15e-2, "the paper's 1 %", ha="right", color="#b5482e")
        ax.set(title=name, xlabel="time [s]", ylabel="relative area error", ylim=(1e-8, 5e-2))
    drawing.save(figure, path)
