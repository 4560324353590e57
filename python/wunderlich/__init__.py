"""Thin inextensible ribbons: how paper strips, film and metal bands bend, twist and move.

    >>> import wunderlich
    >>> result = wunderlich.run("moebius", {"ribbon.segments": 100})
    >>> result.summary["energy"]["normalized"], result.strip.kappa.shape

All quantities are in SI units. Arrays are float64; a strip of n segments has n + 1 nodes.
"""

from . import plot
from ._wunderlich import InputError, State, __version__
from .motion import Motion
from .result import Interrupted, NotConverged, Result, Strip, Surface, equilibrium, run
from .scene import Scene, load, scenes

__all__ = [
    "InputError", "Interrupted", "Motion", "NotConverged", "Result", "Scene", "State", "Strip", "Surface",
    "__version__", "equilibrium", "load", "plot", "run", "scenes",
]
