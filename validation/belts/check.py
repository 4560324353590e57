"""The paper's Fig. 7: a coiled and a twisted belt, each stiff and soft (a tenth of the stiffness), are released.

The shipped scenes belt-release-* and twist-release-*, as they are; a frame is a step of 20 ms, the first at time 0.
"""

from math import atanh

from common import at_least, at_most

FRAMES = {"belt": (1, 13, 25, 37, 49, 61, 73), "twist": (1, 8, 16, 75, 125, 200, 250)}  # Fig. 7
EVERY_FRAME = ("output.frames=1000", "output.subdivision=1", "output.across=2")
LATE = (0.6, 1.44)  # from the end of the fall to the figure's last frame [s]


def width_factor(x):
    """atanh(x)/x, the integral over the width."""
    return 1 + x * x / 3 if x < 1e-3 else atanh(min(x, 1 - 1e-7)) / x


def energy_parts(surface, length, width, stiffness):
    """Elastic energy of the nodes' strains: the part of curvature alone, and that of twist, 2 tau^2 + tau^2 eta^2."""
    kappa, tau, eta = (surface.on_centerline(name) for name in ("kappa", "tau", "eta"))
    count = len(eta) - 1
    h = length / count
    factor = [width_factor(abs(width * (b - a) / (2 * h))) for a, b in zip(eta, eta[1:])]
    bending = twist = 0.0
    for i in range(count + 1):
        weight = 0.5 * stiffness * width * (h if 0 < i < count else h / 2)
        weight *= (factor[max(0, i - 1)] + factor[min(count - 1, i)]) / 2
        bending += weight * kappa[i] ** 2
        twist += weight * (2 * tau[i] ** 2 + tau[i] ** 2 * eta[i] ** 2)
    return bending, twist


def last_above(times, values, bound):
    return max(time for time, value in zip(times, values) if value > bound)


def swing(run, frames):
    """After the fall: mean kinetic energy over its largest ever, and how far the mean height rises and falls."""
    times, kinetic = run.history["time"], run.history["kinetic"]
    late = [i for i, time in enumerate(times) if LATE[0] <= time <= LATE[1]]
    heights = [sum(p[2] for p in frames[i].centerline()) / len(frames[i].centerline()) for i in late]
    return sum(kinetic[i] for i in late) / len(late) / max(kinetic), max(heights) - min(heights)


def spread(surface):
    """Largest horizontal distance between two points of the belt."""
    line = surface.centerline()
    return max(((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2) ** 0.5 for a in line for b in line)


def measure(runner):
    runs, frames = {}, {}
    for kind in FRAMES:
        for stiffness in ("stiff", "soft"):
            name = f"{kind}-release-{stiffness}"
            runs[name] = runner.run(name, name, EVERY_FRAME, "vtp")
            frames[name] = runs[name].frames()
    stiff, soft = (swing(runs[f"belt-release-{kind}"], frames[f"belt-release-{kind}"]) for kind in ("stiff", "soft"))
    end = {kind: frames[f"belt-release-{kind}"][FRAMES["belt"][-1] - 1] for kind in ("stiff", "soft")}
    lowest = {kind: min(p[2] for p in surface.centerline()) for kind, surface in end.items()}
    rows = [
        at_least("coiled, stiff over soft: share of kinetic energy left after the fall", stiff[0] / soft[0], 2,
                 "stiff swings vigorously"),
        at_least("coiled, stiff: rise and fall of the mean height after the fall [l]", stiff[1], 0.08, "stiff swings"),
        at_most("coiled, soft: the same [l]", soft[1], 0.04, "soft collapses"),
        at_most("coiled, soft, 1.44 s: lowest point over where it would hang straight [l]", lowest["soft"], 0.05,
                "soft collapses"),
        at_least("coiled, stiff, 1.44 s: the same [l]", lowest["stiff"], 0.15),
        at_most("coiled, soft over stiff, 1.44 s: horizontal spread", spread(end["soft"]) / spread(end["stiff"]), 0.7),
    ]
    twist_parts = {}
    for kind, bending_stiffness in (("stiff", 0.03), ("soft", 0.003)):
        name = f"twist-release-{kind}"
        parts = [energy_parts(surface, 1, 0.1, bending_stiffness) for surface in frames[name]]
        off = max(abs(sum(p) / v - 1) for p, v in zip(parts, runs[name].history["elastic"]))
        rows.append(at_most(f"twisted, {kind}: sum of the parts against the program's elastic energy", off, 0.05))
        twist_parts[kind] = [p[1] / parts[0][1] for p in parts]
    times = runs["twist-release-stiff"].history["time"]
    for share in (0.1, 0.05, 0.02):
        ends = {kind: last_above(times, values, share) - 0.1 for kind, values in twist_parts.items()}
        name = (f"twisted: time until its twist energy stays below {share:.0%}, "
                f"stiff {ends['stiff']:.2f} s over soft {ends['soft']:.2f} s")
        rows.append(at_most(name, ends["stiff"] / ends["soft"], 0.9, "stiff dissipates quicker"))
    means = {kind: sum(v for t, v in zip(times, values) if t >= 2) / sum(t >= 2 for t in times)
             for kind, values in twist_parts.items()}
    rows.append(at_most("twisted: mean twist energy after 2 s over that at the start, stiff over soft",
                        means["stiff"] / means["soft"], 0.5, "stiff dissipates quicker"))
    return rows, {"runs": runs, "frames": frames, "times": times, "twist": twist_parts}


def draw(data, drawing, path):
    figure = drawing.plt.figure(figsize=(10, 5.5))
    grid = figure.add_gridspec(2, 4, width_ratios=(1.35, 1.35, 1, 1))
    views = []
    for column, name in enumerate(data["frames"]):
        views.append(figure.add_subplot(grid[0, column]))
        wanted = [data["frames"][name][i - 1] for i in FRAMES[name.split("-")[0]]]
        view, apart = ((5, -75), 0.2) if column < 2 else ((8, -85), 0.0)
        drawing.ribbons(views[-1], wanted, drawing.rainbow(len(wanted)), view, name, apart)
    drawing.same_scale(views[:2])
    drawing.same_scale(views[2:])
    kinetic, twist = figure.add_subplot(grid[1, :2]), figure.add_subplot(grid[1, 2:])
    for kind, colour in (("stiff", "#1f6f8b"), ("soft", "#b5482e")):
        history = data["runs"][f"belt-release-{kind}"].history
        kinetic.plot(history["time"], [k / max(history["kinetic"]) for k in history["kinetic"]], color=colour, label=kind)
        twist.semilogy(data["times"], data["twist"][kind], color=colour, label=kind)
    kinetic.axvspan(*LATE, color="#f0ead8", zorder=0)
    kinetic.set(title="coiled belt: kinetic energy over its largest", xlabel="time [s]")
    twist.set(title="twisted belt: twist energy over its start", xlabel="time [s]", ylim=(1e-4, 2))
    kinetic.legend()
    drawing.save(figure, path)
