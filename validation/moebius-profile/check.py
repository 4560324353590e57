"""The paper's Figs. 1c and 4, left: curvature and torsion along the Moebius band of aspect 5 pi, and its one inflection.

The reference (validation/reference/moebius_5pi.csv) is an independent solution of the continuous problem, error <= 1e-7.
The band is computed twice: as an equilibrium, and by the two-stage method as a motion, in which it is pulled about for two
seconds and then left to come to rest.
"""

from math import pi

from common import REFERENCE, at_least, at_most, equal, interpolate, read_csv, root_mean_square

NEAR = 0.03  # of the length; closer to the inflection no difference is taken
ENERGY = 59.677204766524085  # V l / (D w), reference/moebius_5pi.json
PULL = "{at: {u: %s}, keyframes: [{time: 0, force: [0, 0, 0]}, {time: 1, force: [%d, %d, %d]}, {time: 2, force: [0, 0, 0]}]}"
MOTION = ("initial.shape=closed", "output.frames=400",
          "solver={method: two-stage, duration: 10, time_step: 0.02, damping: {normal: 2, tangent: 2}}",
          f"forces=[{PULL % ('pi/2', 1, 1, 1)}, {PULL % ('3pi/2', -1, -1, -1)}]")


def profile(run):
    """[(u from the inflection, kappa, tau)] once around; kappa changes its sign at the seam, tau does not."""
    zero = run.summary["kappa_zeros"][0] * 2 * pi
    table = run.centerline
    points = []
    for u, kappa, tau in zip(table["u"][:-1], table["kappa"], table["tau"]):
        past_seam = u < zero
        points.append(((u - zero) % (2 * pi), -kappa if past_seam else kappa, tau))
    points.sort()
    sign = 1 if points[len(points) // 2][1] > 0 else -1
    return [(u, sign * kappa, tau) for u, kappa, tau in points]


def sign_changes(points):
    """Of kappa from node to node, once around and across the inflection itself; the program's own count is not asked."""
    inside = sum(a[1] * b[1] <= 0 for a, b in zip(points, points[1:]))
    return inside + (points[-1][1] * -points[0][1] <= 0)


def errors(points, reference):
    """Largest and rms differences of kappa and of tau, over their largest values; the mirror image is allowed."""
    far = [p for p in points if NEAR * 2 * pi < p[0] < (1 - NEAR) * 2 * pi]
    table_u = reference["u"]
    result = []
    for k, name in ((1, "kappa"), (2, "tau")):
        table = reference[name]
        exact = [interpolate(p[0], table_u, table) for p in far]
        mirrored = -1 if sum(p[k] * e for p, e in zip(far, exact)) < 0 else 1
        apart = [abs(mirrored * p[k] - e) / max(map(abs, table)) for p, e in zip(far, exact)]
        result += [max(apart), root_mean_square(apart)]
    return result


def runs(runner):
    yield "equilibrium", 50, runner.run("equilibrium-50", "moebius", (), "vtp")
    yield "equilibrium", 200, runner.run("equilibrium-200", "moebius", ("ribbon.segments=200",))
    yield "two-stage", 50, runner.run("two-stage-50", "moebius", MOTION)
    if not runner.quick:
        yield "two-stage", 200, runner.run("two-stage-200", "moebius", (*MOTION, "ribbon.segments=200"))


# By segments: bounds of the differences of kappa or tau (largest, root mean square) and of the energy.
BOUNDS = {50: (4e-2, 1e-2, 1e-3), 200: (3e-3, 6e-4, 1e-4)}


def measure(runner):
    reference = read_csv(REFERENCE / "moebius_5pi.csv")
    rows, profiles, picture = [], {}, None
    for method, segments, run in runs(runner):
        picture = picture or run.frames()[-1]
        name, bound = f"{method}, n = {segments}", BOUNDS[segments]
        points = profiles[name] = profile(run)
        found = errors(points, reference)
        energy = abs(run.summary["energy"]["normalized"] / ENERGY - 1)
        rows += [
            *(at_most(f"{name}: {what} beyond 0.03 l of the inflection", value, bound[k % 2], "moebius_5pi.csv")
              for k, (what, value) in enumerate(zip(("kappa, largest", "kappa, rms", "tau, largest", "tau, rms"), found))),
            at_most(f"{name}: difference of the energy", energy, bound[2], f"{ENERGY:.6g}"),
            equal(f"{name}: zeros of kappa, from node to node", sign_changes(points), 1, "one (Fig. 4)"),
        ]
        if method == "two-stage":
            elastic = run.history["elastic"]
            rows += [at_most(f"{name}: kinetic energy at the end, over the largest",
                             run.history["kinetic"][-1] / max(run.history["kinetic"]), 1e-5),
                     at_least(f"{name}: largest elastic energy on the way, over that at rest",
                              max(elastic) / elastic[-1], 1.02)]
    return rows, {"profiles": profiles, "reference": reference, "picture": picture}


def draw(data, drawing, path):
    figure, (kappa, tau, place) = drawing.panels(3, size=(3.7, 3.2))
    marks = {"equilibrium, n = 50": ("o", "#b5482e"), "equilibrium, n = 200": (".", "#1f6f8b"),
             "two-stage, n = 50": ("x", "#3d7a3d"), "two-stage, n = 200": ("+", "#7d4fa0")}
    table = data["reference"]
    for axes, name, k in ((kappa, "kappa", 1), (tau, "tau", 2)):
        axes.plot([u / (2 * pi) for u in table["u"]], table[name], "k-", linewidth=0.9, label="reference")
        for label, points in data["profiles"].items():
            mark, colour = marks[label]
            wanted = points if "50" in label else points[::3]
            mirrored = -1 if k == 2 and points[len(points) // 2][2] > 0 else 1
            axes.plot([p[0] / (2 * pi) for p in wanted], [mirrored * p[k] for p in wanted], mark, color=colour, markersize=4,
                      markerfacecolor="none", label=label)
        axes.set(title=f"{name} [2π/l]", xlabel="u/l from the inflection")
    tau.legend(fontsize=7, loc="upper center")
    drawing.ribbons(place, [data["picture"]], ["#d9a441"], (50, -70), "at rest, n = 50")
    drawing.save(figure, path)
