"""The paper's section 6.4: how much of the elastic energy its Taylor series in the width leaves out, by order.

Three residuals: of the integral over the width at one place, in closed form; of the energy of a given state, the exact
minimum, summed again from the run folder; and of the minimum itself, when the program minimises the truncated energy.
"""

from math import atanh

from common import REFERENCE, at_least, at_most, between, read_csv

LIMIT = 1e-4  # the paper's 0.01 %
ORDER = 5  # the paper's choice
ORDERS = range(11)
STATES = {"Möbius 10π": ("moebius", "10pi"), "Möbius 5π": ("moebius", "5pi"), "Möbius 5π/2": ("moebius", "5/2pi"),
          "Möbius 5π/4": ("moebius", "5pi/4"), "twist-pi": ("twist-pi", None)}
# At order 5, low and high: what the exact state loses, and how far the minimum lies below the exact one. For the bands of
# 5 pi and 5 pi/4 a separate study has 8e-4 and 5.5e-3 for the latter; the others are this program's own, within 15 %.
EXPECTED = {"Möbius 10π": ((2.3e-4, 3.1e-4), (4.5e-4, 6.1e-4)), "Möbius 5π": ((3.9e-4, 5.3e-4), (7e-4, 9e-4)),
            "Möbius 5π/2": ((7.4e-4, 1e-3), (1.4e-3, 1.9e-3)), "Möbius 5π/4": ((2.8e-3, 3.8e-3), (5e-3, 6e-3)),
            "twist-pi": ((5.4e-2, 7.3e-2), (3.2e-2, 4.3e-2))}


def width_factor(x):
    """atanh(x)/x, the integral over the width at x = w eta'/2."""
    return atanh(x) / x if x > 1e-4 else 1 + x * x / 3


def series(x, order):
    return sum(x ** (2 * a) / (2 * a + 1) for a in range(order + 1))


def local_residual(x, order):
    return 1 - series(x, order) / width_factor(x)


def where_residual_is(bound, order):
    """The |x| up to which the residual is within the bound."""
    low, high = 0.0, 1 - 1e-12
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if local_residual(middle, order) <= bound else (low, middle)
    return low


def links(run, width):
    """(length, kappa and eta at either end, |x|) of each link of centerline.csv; a loop's last row is its first node
    again, seen from this side of the seam."""
    u, kappa, eta = (run.centerline[name] for name in ("u", "kappa", "eta"))
    h = (u[-1] - u[0]) / (len(u) - 1)
    return [(h, kappa[i:i + 2], eta[i:i + 2], abs(width * (eta[i + 1] - eta[i]) / (2 * h))) for i in range(len(u) - 1)]


def summed_energy(chain, width, loop, factor):
    """Elastic energy for D = 1 N m: the program's sum over links (docs/decisions/0014), `factor` in place of atanh(x)/x."""
    total = 0.0
    for i, (h, kappa, eta, x) in enumerate(chain):
        ends = sum((k * (1 + e * e)) ** 2 for k, e in zip(kappa, eta)) / 2
        if loop or 0 < i < len(chain) - 1:
            middle, slant = sum(kappa) / 2, sum(eta) / 2
            ends = 0.9 * ends + 0.1 * (middle * (1 + slant * slant)) ** 2 - 0.27 * (middle * (eta[1] - eta[0])) ** 2
        total += 0.5 * width * h * factor(x) * ends
    return total


def look_at(run, loop, reach):
    """Of a state: its summed energy against the program's, the residuals by order, and the share of its length where the
    residual of order 5 is above the paper's."""
    energy = run.summary["energy"]
    width = energy["elastic"] * run.centerline["u"][-1] / energy["normalized"]  # normalized = V l/(D w), D = 1 N m
    chain = links(run, width)
    whole = summed_energy(chain, width, loop, width_factor)
    parts = [1 - summed_energy(chain, width, loop, lambda x, a=order: series(x, a)) / whole for order in ORDERS]
    return whole / energy["elastic"] - 1, parts, sum(x > reach for _, _, _, x in chain) / len(chain)


def independent():
    """By order, what the series leaves out of the independent solution at 5 pi, by the trapezoid rule on its rows."""
    table = read_csv(REFERENCE / "moebius_5pi.csv")
    dense = [(k * (1 + e * e)) ** 2 for k, e in zip(table["kappa"], table["eta"])]
    ratio = [min(abs(x), 1 - 1e-15) for x in table["x=w*eta_prime/2"]]

    def total(factor):
        values = [d * factor(x) if d else 0.0 for d, x in zip(dense, ratio)]
        u = table["u"]
        return sum((a + b) / 2 * (v - t) for t, v, a, b in zip(u, u[1:], values, values[1:]))

    whole = total(width_factor)
    return [1 - total(lambda x, a=order: series(x, a)) / whole for order in ORDERS]


def minima(runner, label, scene, settings, exact):
    """By order: how far the minimum of the truncated energy lies below the exact one."""
    found = {}
    for order in (ORDER,) if runner.quick else ORDERS:
        truncated = runner.run(f"{label}-{order}", scene,
                               [*settings, "solver.energy=truncated", f"solver.taylor_order={order}"])
        found[order] = 1 - truncated.summary["energy"]["elastic"] / exact.summary["energy"]["elastic"]
    return found


def measure(runner):
    reach = where_residual_is(LIMIT, ORDER)
    rows = [between("width integral: |x| up to which order 5 leaves out less than 1e-4", reach, 0.56, 0.57),
            at_least("width integral: left out at |x| = 0.99", local_residual(0.99, ORDER), 0.3, "< 1e-4")]
    reference = independent()
    rows.append(between("Möbius 5π, independent solution: left out at order 5", reference[ORDER], 3.9e-4, 4.1e-4,
                        "< 1e-4"))
    states, lower = {}, {}
    swing = runner.run("swing", "swing", ("ribbon.segments=25", "solver.duration=0.72"))
    states["swing, 0.72 s"] = off, of_state, _ = look_at(swing, False, reach)
    rows += [at_most("swing, 0.72 s: energy summed from centerline.csv against the program's", abs(off), 1e-9),
             at_most("swing, 0.72 s: left out of the state at order 5", of_state[ORDER], LIMIT, "< 1e-4")]
    for name, (scene, aspect) in STATES.items():
        settings = ["ribbon.segments=200", f"ribbon.aspect={aspect}"] if aspect else []  # else the scene as it is
        label = f"{scene}-{aspect or ''}".replace("/", "-")
        exact = runner.run(f"{label}-exact", scene, settings)
        states[name] = off, of_state, share = look_at(exact, scene == "moebius", reach)
        lower[name] = minima(runner, label, scene, settings, exact)
        falls = max(b / a for a, b in zip(of_state, of_state[1:]))
        rows += [
            at_most(f"{name}: energy summed from centerline.csv against the program's", abs(off), 1e-6),
            at_most(f"{name}: residual of the state, largest ratio of one order and the one before", falls, 0.95),
            between(f"{name}: left out of the state at order 5 ({share:.0%} of the length beyond reach)", of_state[ORDER],
                    *EXPECTED[name][0], "< 1e-4"),
            between(f"{name}: minimum at order 5 below the exact one", lower[name][ORDER], *EXPECTED[name][1], "< 1e-4"),
        ]
    return rows, {"states": states, "lower": lower, "reach": reach, "reference": reference}


def draw(data, drawing, path):
    figure, (local, state, minimum) = drawing.panels(3, size=(3.8, 3.3))
    xs = [i / 400 for i in range(20, 400)] + [0.9985, 0.9995]
    for order, colour in zip(ORDERS, drawing.rainbow(len(ORDERS))):
        local.semilogy(xs, [max(local_residual(x, order), 1e-16) for x in xs], color=colour,
                       linewidth=2.2 if order == ORDER else 1, label=f"order {order}" if order in (0, ORDER, 10) else None)
    local.axvline(data["reach"], color="k", linestyle=":", linewidth=1)
    local.set(title="width integral, by |x| = |wη′/2|", xlabel="|x|", ylabel="share left out", ylim=(1e-7, 1),
              xlim=(0, 1))
    names = list(data["states"])
    colours = dict(zip(names, drawing.rainbow(len(names))))
    for name, (_, of_state, _) in data["states"].items():
        state.semilogy(ORDERS, of_state, "o-", markersize=3, color=colours[name], label=name)
    state.semilogy(ORDERS, data["reference"], "k:", linewidth=1, label="5π, independent")
    for name, found in data["lower"].items():
        minimum.semilogy(list(found), list(found.values()), "o-", markersize=3, color=colours[name])
    state.set(title="energy of the exact state", xlabel="order", ylim=(1e-7, 1))
    minimum.set(title="energy of the minimum", xlabel="order", ylim=(1e-7, 1))
    for axes in (local, state, minimum):
        axes.axhline(LIMIT, color="k", linestyle="--", linewidth=0.9)
    for axes in (state, minimum):
        axes.set(xlim=(-0.5, 10.5), xticks=range(0, 11, 2))
    minimum.text(10.4, LIMIT / 1.3, "the paper's 0.01 %", ha="right", va="top")
    local.legend(fontsize=7)
    minimum.legend(*state.get_legend_handles_labels(), fontsize=7, loc="lower left")
    drawing.save(figure, path)
