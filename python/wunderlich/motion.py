"""A motion taken step by step."""

from __future__ import annotations

from collections.abc import Sequence
from operator import index
from typing import Any

from . import _wunderlich
from .result import NotConverged, Strip, Surface
from .scene import Overrides, Scene, SceneLike, _scene_of

Vector = Sequence[float]


def _vector(name: str, value: Vector) -> list[float]:
    try:
        x, y, z = (float(component) for component in value)
    except (TypeError, ValueError):
        raise ValueError(f"{name}: must be three numbers, not {value!r}") from None
    return [x, y, z]


class Motion:
    """A motion at some time; `step` takes it further, and the arrays of `state` follow without a copy.

        motion = Motion("swing")
        r = motion.state.r                    # a view: it shows each new state
        motion.move(0, (0, 0.1, 0), over=0.5)  # the clamp goes there meanwhile
        while motion.time < 1:
            motion.step()

    scene, overrides: as for `run`. start: states to start from instead of the scene's own start, one a strip, of as many
    segments; their time is taken as 0: `Motion("swing", start=[result.state()])`.

    One thread steps at a time; others may read the views, which change only after the step. Raises InputError (a
    ValueError) on bad input and for scenes of `method: equilibrium`, NotConverged if the start is not reached.
    """

    def __init__(self, scene: SceneLike, overrides: Overrides | None = None, *,
                 start: Sequence[_wunderlich.State] = ()) -> None:
        self.scene: Scene = _scene_of(scene, overrides)
        self._native = _wunderlich.Motion(self.scene._native, list(start))
        self._check()

    def _check(self) -> None:
        if self._native.failure:
            raise NotConverged(f"{self.scene.name}: {self._native.failure}")

    def _later(self, name: str, duration: float) -> float:
        """The time in `duration` [s]; one too short to be told from now is refused."""
        if not self.time < self.time + duration < float("inf"):
            raise ValueError(f"{name}: {duration} s is no time to go on by")
        return self.time + duration

    def step(self, dt: float | None = None) -> None:
        """One step: to the next multiple of the scene's time step, or, with `dt` [s], by so much at once.

        A step that fails is halved, up to eight times. Raises NotConverged if that did not help; the state is then the
        last good one, and what is imposed can be changed. Other Python threads go on meanwhile.
        """
        until = 0.0 if dt is None else self._later("dt", dt)
        if not self._native.step(until):
            self._check()

    def reset(self) -> None:
        """Back to the start, with gravity and supports as the scene has them."""
        self._native.reset()

    @property
    def time(self) -> float:
        """The time reached [s]."""
        return self._native.time

    @property
    def state(self) -> _wunderlich.State:
        """The state of the strip, the first if there are several; its arrays are views that follow each step."""
        return self._native.state(0)

    @property
    def states(self) -> list[_wunderlich.State]:
        """The states of all strips."""
        return [self._native.state(i) for i in range(self._native.strips)]

    def strip(self, strip: int = 0) -> Strip:
        """Curvature, frames and the rest of a strip now: copies, as one frame."""
        return Strip(**self._native.arrays(strip))

    def surface(self) -> Surface:
        """The surface of all strips now, as fine as the scene's `output` says."""
        return Surface(**self._native.surface())

    def measure(self) -> dict[str, Any]:
        """Energies [J] and errors now, under the names of `Result.history`: a row of such a table."""
        return self._native.history()

    @property
    def gravity(self) -> tuple[float, float, float]:
        """Acceleration of free fall [m/s^2]; may be set between steps."""
        return self._native.gravity

    @gravity.setter
    def gravity(self, value: Vector) -> None:
        x, y, z = _vector("gravity", value)
        self._native.gravity = (x, y, z)

    def supports(self, strip: int = 0) -> list[dict[str, Any]]:
        """What holds a strip, in the order that `move` and `release` count: the scene's clamps, its pins, then those of
        `hold`. kind ("clamp", "pin", "about-tangent"), node, holds (still), position [m]; of clamps tangent and normal."""
        return self._native.supports(strip)

    def move(self, support: int, position: Vector | None = None, *, rotation: Vector = (0, 0, 0), turn: float = 0,
             over: float | None = None, strip: int = 0) -> None:
        """Sends a support from where it is to another place, evenly, instead of what the scene had planned for it.

        position: (3) where to [m]; it stays in place without. rotation: (3) rotation vector about the world's axes [rad],
        by less than half a turn. turn: then about its own tangent [rad], by as many turns as you like. over: the time it
        takes [s]; one time step of the scene without.
        """
        until = self._later("over", self.scene.time_step if over is None else over)
        place = None if position is None else _vector("position", position)
        self._native.move(index(strip), index(support), place, _vector("rotation", rotation), float(turn), until)

    def hold(self, node: int, *, strip: int = 0) -> int:
        """Pins a node where it is; the number of the new support, for `move` and `release`."""
        return self._native.hold(index(strip), index(node))

    def release(self, support: int, *, strip: int = 0) -> None:
        """A support lets go."""
        self._native.release(index(strip), index(support))

    def __repr__(self) -> str:
        return f"<Motion {self.scene.name} at {self.time:g} s>"
