"""The paper's Figs. 1d, 4 right and 5: the closed loop with two half twists rests on itself in the shape of a zero."""

import json
import math

from common import REFERENCE, at_least, at_most, between, equal, slope

LENGTH = 2 * math.pi
BOUNDS = {50: 1e-2, 100: 3e-3, 200: 8e-4}  # relative


def measure(runner):
    reference = json.loads((REFERENCE / "loop2pi.json").read_text())["edge_contact_delta_w_5pi"]
    energy = reference["V_over_Dw_L2pi"] * LENGTH
    rows, runs, errors = [], {}, []
    for segments in [50, 100] if runner.quick else [50, 100, 200]:
        run = runner.run(f"loop-{segments}", "loop-2pi", [f"ribbon.segments={segments}", "output.frames=2"], formats="vtp")
        measured = run.summary["energy"]["normalized"]
        errors.append(abs(measured / energy - 1))
        rows.append(at_most(f"{segments} segments: V l/(D w) against {energy:.3f}", errors[-1], BOUNDS[segments]))
        twist = run.summary["topology"]["twist"] / reference["twist_Tw"] - 1
        rows.append(at_most(f"{segments} segments: twist against {reference['twist_Tw']:.4f}", abs(twist), BOUNDS[segments]))
        runs[segments] = run
    last = runs[max(runs)]
    zeros = last.summary["kappa_zeros"]
    torsion = max(last.centerline["tau"])
    rows += [
        at_least("order of that error in the segment length", slope([1 / n for n in runs], errors), 1.6),
        equal("zeros of the curvature", len(zeros), 2),
        at_most("their distance less half the length, over the length", abs(abs(zeros[-1] - zeros[0]) - 0.5), 1e-2),
        between("largest torsion", torsion, 0.35, 0.385, f"{reference['max_tau']:.4f}"),
        at_least("smallest gap of the strip to itself [m]", last.summary["contact"]["minimum_distance"], 1e-9),
    ]
    return rows, {"run": last, "surface": last.frames()[-1]}


def draw(data, drawing, path):
    figure, axes = drawing.panels(4)
    line = data["run"].centerline
    share = [u / LENGTH for u in line["u"]]
    axes[0].plot(share, line["kappa"], color="#1f6f8b", label="κ")
    axes[0].plot(share, line["tau"], color="#b5482e", label="τ")
    axes[0].set(title="Curvature and torsion", xlabel="u over l", ylabel="1/m, l = 2π m")
    axes[0].legend()
    for ax, view in zip(axes[1:], ((80, -60), (15, -60), (15, 30))):
        drawing.ribbons(ax, [data["surface"]], ["#c65a34"], view)
    drawing.save(figure, path)
