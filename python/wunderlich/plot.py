"""Pictures by matplotlib, which is needed only when one of these is called.

Each draws into the axes that it is given, or into new ones, and returns them; `film` makes an animation.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .result import Result, Strip, Surface

_LIGHT = np.array([0.3, -0.5, 0.81])


def _axes(axes: Any, **keywords: Any) -> Any:
    if axes is not None:
        return axes
    import matplotlib.pyplot as plt

    return plt.figure().add_subplot(**keywords)


def _shaded(corners: NDArray[np.float64], colors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Colors (m, 4) of triangles (m, 3, 3), darker where they turn away from the light; both sides are lit."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.maximum(np.linalg.norm(normals, axis=1), 1e-300)
    shaded = colors.copy()
    shaded[:, :3] *= (0.45 + 0.55 * np.abs(normals @ _LIGHT) / lengths)[:, None]
    return shaded


def _place(axes: Any, points: NDArray[np.float64]) -> None:
    """Limits around the points, true to scale."""
    low, high = points.min(axis=0), points.max(axis=0)
    extent = np.maximum(high - low, 0.05 * (high - low).max())
    middle = (low + high) / 2
    for name, m, e in zip("xyz", middle, extent):
        axes.set(**{f"{name}lim": (m - e / 2, m + e / 2), f"{name}label": f"{name} [m]"})
        axes.locator_params(axis=name, nbins=4)
    axes.set_box_aspect(extent)


def _expect(value: Any, kind: type, what: str) -> None:
    if not isinstance(value, kind):
        raise TypeError(f"{what} is wanted, not a {type(value).__name__}")


def _values(surface: Surface, color_by: str) -> NDArray[np.float64]:
    if color_by not in surface.fields:
        raise ValueError(f"color_by: the surface has no {color_by!r}; it has {', '.join(surface.fields)}")
    return surface.fields[color_by]


def _draw(surface: Surface, axes: Any, color_by: str | None, cmap: str, limits: tuple[float, float] | None) -> Any:
    """Draws the triangles; what turns values into colors, if they say something."""
    from matplotlib import cm, colors
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    corners = surface.points[surface.triangles]
    scale = None
    faces = np.tile(colors.to_rgba("tan"), (len(corners), 1))
    if color_by is not None:
        values = _values(surface, color_by)[surface.triangles].mean(axis=1)
        scale = cm.ScalarMappable(colors.Normalize(*(limits or (values.min(), values.max()))), cmap)
        faces = scale.to_rgba(values)
    faces = _shaded(corners, faces)
    axes.add_collection3d(Poly3DCollection(corners, facecolors=faces, edgecolors=faces, linewidths=0.3))
    return scale


def surface(surface: Surface, *, axes: Any = None, color_by: str | None = None, cmap: str = "viridis") -> Any:
    """A ribbon in 3D, true to scale. `color_by` is the name of a field of the surface."""
    _expect(surface, Surface, "a Surface, as result.surface()")
    axes = _axes(axes, projection="3d")
    scale = _draw(surface, axes, color_by, cmap, None)
    if scale is not None:
        unit = surface.units[str(color_by)]
        axes.figure.colorbar(scale, ax=axes, label=f"{color_by} [{unit}]" if unit else color_by, shrink=0.7, pad=0.12)
    _place(axes, surface.points)
    return axes


def profile(strip: Strip, frame: int = -1, *, axes: Any = None) -> Any:
    """Curvature, torsion [1/m] and slope of the rulings along a strip."""
    _expect(strip, Strip, "a Strip, as result.strip")
    axes = _axes(axes)
    for values, label in [(strip.kappa, "κ [1/m]"), (strip.tau, "τ [1/m]"), (strip.eta, "η")]:
        axes.plot(strip.u, values[frame], label=label)
    axes.set_xlabel("u [m]")
    axes.legend()
    return axes


def energies(history: Mapping[str, NDArray[Any]], *, axes: Any = None) -> Any:
    """Elastic, kinetic, gravity's and total energy [J] over time [s], of `Result.history`."""
    _expect(history, Mapping, "a history, as result.history")
    axes = _axes(axes)
    for name in ["elastic", "kinetic", "gravity", "total"]:
        axes.plot(history["time"], history[name], label=name)
    axes.set(xlabel="time [s]", ylabel="energy [J]")
    axes.legend()
    return axes


def film(result: Result, *, axes: Any = None, color_by: str | None = None, cmap: str = "viridis",
         interval: float = 40) -> Any:
    """All frames one after the other, `interval` [ms] each, in one view: a `matplotlib.animation.FuncAnimation`.

    `film(result).save("film.gif")` writes it, `.to_jshtml()` shows it in a notebook. Keep what it returns.
    """
    from matplotlib.animation import FuncAnimation

    axes = _axes(axes, projection="3d")
    surfaces = [result.surface(i) for i in range(len(result))]
    limits = None
    if color_by is not None:
        fields = [_values(one, color_by) for one in surfaces]
        limits = (min(f.min() for f in fields), max(f.max() for f in fields))
    _place(axes, np.concatenate([one.points for one in surfaces]))

    def draw(frame: int) -> None:
        for drawn in list(axes.collections):
            drawn.remove()
        _draw(surfaces[frame], axes, color_by, cmap, limits)

    return FuncAnimation(axes.figure, draw, frames=len(surfaces), interval=interval)
