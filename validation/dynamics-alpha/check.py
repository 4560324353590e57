"""The paper's Fig. 2: how the weight scale alpha of the soft coupling sets the accuracy of a motion.

The shipped scene swing: a strip let go from straight, which leaves its plane. All runs have one time step, below the
stability bound of the largest alpha, so that nothing but alpha differs; the reference is the limit of infinite alpha, by
extrapolation in 1/alpha from the two largest. What the time step does is measured beside it.
"""

from common import at_least, at_most, between, distance, root_mean_square, slope

EXTRAPOLATED = (300, 1000)


def motion(runner, alpha, step, duration, segments):
    """(times, tip positions, kinetic energies)"""
    settings = (f"ribbon.segments={segments}", f"solver.duration={duration}", f"solver.time_step={step}",
                f"solver.weight_scale={alpha}", "output.frames=101", "output.subdivision=1", "output.across=2")
    run = runner.run(f"alpha-{alpha}-step-{step.replace('/', '-')}", "swing", settings, "vtp")
    return run.history["time"], [frame.centerline()[-1] for frame in run.frames()], run.history["kinetic"]


def limit(coarse, fine):
    """What first order in 1/alpha makes of two motions."""
    ratio = EXTRAPOLATED[1] / EXTRAPOLATED[0]
    towards = lambda a, b: b + (b - a) / (ratio - 1)
    tips = [tuple(map(towards, a, b)) for a, b in zip(coarse[1], fine[1])]
    return fine[0], tips, list(map(towards, coarse[2], fine[2]))


def tip_errors(motion, reference):
    if max(abs(a - b) for a, b in zip(motion[0], reference[0])) > 1e-9:
        raise RuntimeError("two motions were not recorded at the same times")
    return [distance(a, b) for a, b in zip(motion[1], reference[1])]


def errors(motion, reference):
    """Root mean square over time of the tip's distance, over the length (1 m); of the kinetic energy, over its largest."""
    kinetic = root_mean_square(a - b for a, b in zip(motion[2], reference[2])) / max(reference[2])
    return root_mean_square(tip_errors(motion, reference)), kinetic


def measure(runner):
    segments, duration, step, half = (12, 0.5, "1/25600", "1/51200") if runner.quick else (20, 1, "1/76800", "1/153600")
    scales = (3, 10, 30, 100, *EXTRAPOLATED) if runner.quick else (1, 3, 10, 30, 100, *EXTRAPOLATED)
    runs = {scale: motion(runner, scale, step, duration, segments) for scale in scales}
    reference = limit(*(runs[scale] for scale in EXTRAPOLATED))
    found = {scale: errors(run, reference) for scale, run in runs.items()}
    of_step = errors(motion(runner, 100, half, duration, segments), runs[100])
    # The limit as the largest alpha but one would have given it: what is left to doubt in the reference.
    doubt = max(abs(found[EXTRAPOLATED[1]][k] * EXTRAPOLATED[1] / (found[100][k] * 100) - 1) for k in (0, 1))
    rows = [at_least("sideways way of the tip: the strip leaves its plane [l]",
                     max(abs(tip[1]) for tip in reference[1]), 1e-3)]
    tried = [scale for scale in scales if scale <= 100]
    for k, name in enumerate(("tip path", "kinetic energy")):
        values = [found[scale][k] for scale in tried]
        falls = max(b / a for a, b in zip(values, values[1:]))
        rows += [
            at_most(f"{name}: largest ratio of the errors of one alpha and the next smaller one", falls, 0.6),
            between(f"{name}: order in 1/alpha, {tried[0]} to 100", -slope(tried, values), 0.8, 1.2),
            at_most(f"{name}: relative error at alpha = 10", found[10][k], (5e-4, 1e-3)[k], "alpha 10 to 100"),
            at_most(f"{name}: relative error at alpha = 100", found[100][k], (5e-5, 1e-4)[k], "is advised (Fig. 2)"),
            at_most(f"{name}: change by half the time step, over the error at alpha = 10", of_step[k] / found[10][k], 0.5),
        ]
    rows.append(at_most("reference: error at 1000 times 1000 against error at 100 times 100, less 1", doubt, 0.2))
    return rows, {"runs": runs, "reference": reference, "found": found, "step": of_step}


def draw(data, drawing, path):
    figure, (height, apart, order) = drawing.panels(3, size=(3.8, 3.2))
    colours = dict(zip(data["runs"], drawing.rainbow(len(data["runs"]))))
    for scale, run in data["runs"].items():
        height.plot(run[0], [tip[2] for tip in run[1]], color=colours[scale], label=f"α = {scale}")
        apart.semilogy(run[0][1:], tip_errors(run, data["reference"])[1:], color=colours[scale])
    height.plot(data["reference"][0], [tip[2] for tip in data["reference"][1]], "k:", label="limit")
    height.legend(fontsize=7)
    height.set(title="height of the tip [l]", xlabel="time [s]")
    apart.set(title="distance of the tip from the limit [l]", xlabel="time [s]")
    scales = list(data["found"])
    for k, (name, colour) in enumerate((("tip path", "#1f6f8b"), ("kinetic energy", "#b5482e"))):
        order.loglog(scales, [data["found"][scale][k] for scale in scales], "o-", color=colour, label=name, markersize=4)
        order.axhline(data["step"][k], color=colour, linestyle=":", linewidth=1)
    first = data["found"][scales[0]][0]
    order.loglog(scales, [first * scales[0] / scale for scale in scales], "k--", linewidth=0.8, label="order 1")
    order.axvspan(10, 100, color="#f0ead8", zorder=0)
    order.legend(fontsize=7)
    order.set(title="relative error (dots: of the time step)", xlabel="α (shaded: advised by the paper)")
    drawing.save(figure, path)
