"""Figures by matplotlib. Import it only where figures are wanted."""

from math import cos, radians, sin
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend has to be chosen first)
from matplotlib.collections import PolyCollection  # noqa: E402

plt.rcParams.update({
    "font.size": 9, "axes.grid": True, "grid.color": "#e6e6e6", "axes.spines.top": False, "axes.spines.right": False,
    "legend.frameon": False, "lines.linewidth": 1.4, "figure.constrained_layout.use": True,
})


def panels(count, size=(4.6, 3.4), **keys):
    """A figure of `count` plots side by side, and its axes as a list."""
    figure, axes = plt.subplots(1, count, figsize=(size[0] * count, size[1]), squeeze=False, **keys)
    return figure, list(axes[0])


def rainbow(count):
    """`count` colours from red to violet."""
    return [plt.cm.rainbow(1 - i / max(1, count - 1)) for i in range(count)]


def ribbons(axes, surfaces, colours, view, title="", apart=0.0):
    """Surfaces over each other, seen from `view` = (elevation, azimuth) in degrees, each `apart` [m] further right."""
    up, round_ = (radians(angle) for angle in view)
    right = (-sin(round_), cos(round_), 0.0)
    above = (-sin(up) * cos(round_), -sin(up) * sin(round_), cos(up))
    nearer = (cos(up) * cos(round_), cos(up) * sin(round_), sin(up))
    seen = []  # (nearness, polygon, colour)
    for place, (surface, colour) in enumerate(zip(surfaces, colours)):
        for quad in strips(surface):
            polygon = [(dot(point, right) + place * apart, dot(point, above)) for point in quad]
            seen.append((sum(dot(point, nearer) for point in quad), polygon, shaded(colour, quad)))
    seen.sort(key=lambda item: item[0])
    tones = [tone for _, _, tone in seen]
    axes.add_collection(PolyCollection([polygon for _, polygon, _ in seen], facecolors=tones, edgecolors=tones,
                                       linewidths=0.3))
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_title(title)


def same_scale(views):
    """Gives views of ribbons the limits that hold all of them."""
    for get, give in (("get_xlim", "set_xlim"), ("get_ylim", "set_ylim")):
        limits = [getattr(axes, get)() for axes in views]
        for axes in views:
            getattr(axes, give)(min(low for low, _ in limits), max(high for _, high in limits))


def shaded(colour, quad):
    """Brighter where the light falls square to the quad, the same from both sides."""
    (ax, ay, az), (bx, by, bz) = (subtract(quad[2], quad[0]), subtract(quad[3], quad[1]))
    normal = (ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)
    size = dot(normal, normal) ** 0.5 or 1.0
    light = abs(dot(normal, (0.36, -0.48, 0.8))) / size
    return [c * (0.45 + 0.55 * light) for c in matplotlib.colors.to_rgb(colour)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def subtract(a, b):
    return [x - y for x, y in zip(a, b)]


def strips(surface):
    """The quads between neighbouring rulings, from rim to rim."""
    left, right = surface.line(0), surface.line(-1)
    return [[left[i], right[i], right[i + 1], left[i + 1]] for i in range(len(left) - 1)]


def save(figure, path):
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=100, pil_kwargs={"optimize": True})
    plt.close(figure)
