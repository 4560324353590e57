"""The paper's Fig. 6 and the figure of §6.3: a soft strip hangs over a cylinder, a stiff one slides off it to the ground."""

from common import at_least, at_most

AXIS = (0.14, -0.06)  # x and z of the cylinders' middle [m]
FRAMES = 7


def spread(frames):
    """Seven frames from the first to the last."""
    return [frames[round(k * (len(frames) - 1) / (FRAMES - 1))] for k in range(FRAMES)]


def lowest(surface):
    return min(point[2] for point in surface.points)


def measure(runner):
    rows, data = [], {}
    for scene in ("drape-cylinder", "slide-cylinder"):
        run = runner.run(scene, scene, formats="vtp")
        contact = run.summary["contact"]
        allowed = 0 if run.summary["method"] == "implicit" else 0.01 * 0.03
        rows += [
            at_most(f"{scene}: penetration at any step [m]", contact["max_penetration"], allowed),
            at_most(f"{scene}: length error", max(run.history["max_length_error"]), 1e-7),
        ]
        data[scene] = (run, run.frames())
    soft, frames = data["drape-cylinder"]
    ends = [(frame.centerline()[0], frame.centerline()[-1]) for frame in frames]
    late = range(len(ends) // 2, len(ends))
    swing = [ends[i][0][0] for i in late]
    rows += [
        at_most("drape: both ends hang below the cylinder's middle, the higher one [m]", max(p[2] for p in ends[-1]), AXIS[1]),
        at_least("drape: an end swings, its way in the second half [m]", max(swing) - min(swing), 1e-3),
        at_most("drape: largest kinetic over largest change of gravity's energy", max(soft.history["kinetic"])
                / (max(soft.history["gravity"]) - min(soft.history["gravity"])), 1),
    ]
    stiff, frames = data["slide-cylinder"]
    rows.append(at_most("slide: the whole strip ends on the ground, its highest over its lowest point [m]",
                        max(p[2] for p in frames[-1].points) - lowest(frames[-1]), 0.02))
    return rows, {scene: spread(frames) for scene, (_, frames) in data.items()}


def draw(data, drawing, path):
    figure, axes = drawing.panels(2, size=(6.4, 3.6))
    for ax, (scene, frames) in zip(axes, data.items()):
        drawing.ribbons(ax, frames, drawing.rainbow(len(frames)), (12, -75), f"{scene}, {FRAMES} frames, red first")
    drawing.save(figure, path)
