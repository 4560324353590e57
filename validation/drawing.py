"""Figures by matplotlib. Import it only where figures are wanted."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend has to be chosen first)
from mpl_toolkits.mplot3d.art3d import Poly3DCollection  # noqa: E402

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


def ribbons_3d(figure, place, surfaces, colours, view, title="", zoom=1.0):
    """Surfaces over each other in one 3D view; `view` is (elevation, azimuth) in degrees. Axes have one scale."""
    axes = figure.add_subplot(place, projection="3d")
    for surface, colour in zip(surfaces, colours):
        quads = strips(surface)
        axes.add_collection3d(Poly3DCollection(quads, facecolors=[shaded(colour, quad) for quad in quads], linewidths=0))
    points = [point for surface in surfaces for point in surface.points]
    low = [min(p[k] for p in points) for k in range(3)]
    high = [max(p[k] for p in points) for k in range(3)]
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect([max(1e-3, h - l) for l, h in zip(low, high)], zoom=zoom)
    axes.view_init(*view)
    axes.set_axis_off()
    axes.set_title(title, fontsize=9)
    return axes


def shaded(colour, quad):
    """Brighter where the light falls square to the quad, the same from both sides."""
    (ax, ay, az), (bx, by, bz) = (subtract(quad[2], quad[0]), subtract(quad[3], quad[1]))
    normal = (ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)
    size = sum(x * x for x in normal) ** 0.5 or 1.0
    light = abs(sum(n * d for n, d in zip(normal, (0.36, -0.48, 0.8)))) / size
    return [c * (0.45 + 0.55 * light) for c in matplotlib.colors.to_rgb(colour)]


def subtract(a, b):
    return [x - y for x, y in zip(a, b)]


def strips(surface):
    """The quads between neighbouring rulings, from rim to rim."""
    left, right = surface.line(0), surface.line(-1)
    return [[left[i], right[i], right[i + 1], left[i + 1]] for i in range(len(left) - 1)]


def save(figure, path):
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=100)
    plt.close(figure)
