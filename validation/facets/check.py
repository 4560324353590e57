"""The paper's Figs. 1a and 8: a strip twisted under tension folds into nearly flat triangles."""

from common import at_least, at_most, equal


def sign_changes(values):
    """Indices after which the sign is another; places within rounding of zero have the sign before them."""
    signs = []
    for value in values:
        signs.append((1 if value > 0 else -1) if abs(value) > 1e-6 else (signs[-1] if signs else 0))
    return [i for i in range(len(signs) - 1) if signs[i] * signs[i + 1] < 0]


def measure(runner):
    rows, runs = [], {}
    for scene, turn, least in (("twist-pi", "π", 2), ("twist-2pi", "2π", 4)):
        run = runner.run(scene, scene, ["output.frames=2"], formats="vtp")
        kappa, eta, u = (run.centerline[name] for name in ("kappa", "eta", "u"))
        width = 1 / 7.853981633974483
        ratios = [0.5 * width * (b - a) / (v - s) for a, b, s, v in zip(eta, eta[1:], u, u[1:])]
        changes = sign_changes(kappa)
        # Rulings that fan about a point of an edge: the sign of the ratio says which edge.
        fans = [max(ratios[max(0, i - 1):i + 2], key=abs) for i in changes]
        rows += [
            at_least(f"{turn}: facets, stretches between sign changes of the curvature", len(changes) + 1, least + 1),
            at_least(f"{turn}: rulings nearly meet on an edge, largest |w η'/2|", max(map(abs, ratios)), 0.9),
            at_most(f"{turn}: smallest curvature over its largest", min(map(abs, kappa[2:-2])) / max(map(abs, kappa)), 0.1),
            equal(f"{turn}: both edges have such points", sorted({x > 0 for x in fans}), [False, True]),
        ]
        runs[f"turned by {turn}"] = (u, kappa, ratios, run.frames()[-1])
    return rows, runs


def draw(data, drawing, path):
    figure, axes = drawing.panels(3)
    for ax, (name, (u, kappa, ratios, _)) in zip(axes, data.items()):
        ax.plot(u, kappa, color="#1f6f8b", label="κ l")
        ax.set(title=name, xlabel="u over l", ylabel="κ l")
        other = ax.twinx()
        other.plot([0.5 * (a + b) for a, b in zip(u, u[1:])], ratios, color="#b5482e", linewidth=0.9)
        other.set(ylim=(-1.05, 1.05), ylabel="w η'/2")
        other.yaxis.label.set_color("#b5482e")
        other.grid(False)
    drawing.ribbons(axes[2], [run[3] for run in data.values()], drawing.rainbow(2), (30, -50), "π and 2π", apart=1.0)
    drawing.save(figure, path)
