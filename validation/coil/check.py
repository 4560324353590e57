"""The paper's Fig. 1b: a twisted strip coils when its load is decreased, and stays coiled when it is increased."""

from common import at_least, at_most, between, distance

FULL = 100.0  # of the load, times D/w
LEAST = 5 / 2.5 / 3.141592653589793  # 5 N over D/w
# Path parameter of the scene's keyframes, from the end of the approach on.
TWISTED, LOOSE, PULLED = 1.0, 2.0, 3.0


def load_at(t):
    """Load over D/w, as scenes/coil.yaml has it."""
    if t < LOOSE:
        return FULL + (LEAST - FULL) * max(0.0, t - TWISTED)
    return LEAST + (FULL - LEAST) * (t - LOOSE)


def measure(runner):
    run = runner.run("coil", "coil", ["output.frames=400"], formats="vtp")
    frames = run.frames()
    lead = frames[-1].time - PULLED - 0.05  # of the approach; settling adds 0.05
    curve = {"load": [], "distance": [], "slope": []}
    for frame in frames:
        t = frame.time - lead
        if t < TWISTED or t > PULLED:
            continue
        line = frame.centerline()
        curve["load"].append(load_at(t))
        curve["distance"].append(distance(line[0], line[-1]))
        curve["slope"].append(max(abs(eta) for eta in frame.on_centerline("eta")))
    # In the twisted strip rulings run almost along it; where it coils they stand up at once.
    down = curve["load"].index(min(curve["load"]))
    falls = [curve["slope"][i] - curve["slope"][i + 1] for i in range(down) if curve["load"][i] > 20]
    coiled = falls.index(max(falls)) + 1
    onset = curve["load"][coiled]
    back = next(i for i in range(down, len(curve["load"])) if curve["load"][i] >= curve["load"][coiled - 1])
    rows = [
        at_least("largest ruling slope just before the onset", curve["slope"][coiled - 1], 2.2),
        between("onset: load at which it coils, over D/w", onset, 30, 50),
        at_most("largest ruling slope at that load when it is pulled again, over the one before the onset",
                curve["slope"][back] / curve["slope"][coiled - 1], 0.8, "stays coiled"),
        at_most("distance of the ends in the loose coil, over the length", min(curve["distance"]), 0.75),
        at_least("the same when it is pulled again: the coil is drawn tight", curve["distance"][-1], 0.9),
        at_least("smallest distance of the coil's turns, over the length", run.summary["contact"]["minimum_distance"], 1e-9),
    ]
    chosen = [min(range(len(frames)), key=lambda i: abs(frames[i].time - lead - t)) for t in (1.55, 1.65, 2.0)]
    return rows, {"curve": curve, "coiled": coiled, "frames": [frames[i] for i in chosen]}


def draw(data, drawing, path):
    figure, axes = drawing.panels(2)
    curve, turn = data["curve"], data["curve"]["load"].index(min(data["curve"]["load"]))
    axes[0].plot(curve["load"][: turn + 1], curve["distance"][: turn + 1], color="#1f6f8b", label="load decreased")
    axes[0].plot(curve["load"][turn:], curve["distance"][turn:], color="#b5482e", linestyle="--", label="increased again")
    axes[0].axvline(curve["load"][data["coiled"]], color="#888888", linewidth=0.8)
    axes[0].set(title="It coils at once, and stays coiled", xlabel="load over D/w", ylabel="distance of the ends over l")
    axes[0].legend()
    drawing.ribbons(axes[1], data["frames"], drawing.rainbow(len(data["frames"])), (25, -62),
                    "Before and after the onset, and loose", apart=0.95)
    drawing.save(figure, path)
