"""Runs and what comes of them."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from . import _wunderlich
from .scene import Overrides, Scene, SceneLike, _scene_of

Array = NDArray[np.float64]
Observer = Callable[[str, float, int], Optional[bool]]


@dataclass(frozen=True)
class Strip:
    """One strip in f frames, at n + 1 nodes of n segments. The arrays are copies.

    `Result.state` and `Motion.state` give views of single states without a copy.
    """

    u: Array  #: (n + 1) arc length of the nodes [m]
    time: Array  #: (f) time [s]; of an equilibrium path the load parameter
    r: Array  #: (f, n + 1, 3) positions [m]
    r_dot: Array  #: (f, n + 1, 3) velocities [m/s]
    q: Array  #: (f, n, 4) unit quaternions x, y, z, w of the segments' frames
    eta: Array  #: (f, n + 1) slope of the rulings, ruling = d2 + eta d3
    d1: Array  #: (f, n + 1, 3) normals of the surface on the centerline
    d2: Array  #: (f, n + 1, 3) binormals, across the strip
    d3: Array  #: (f, n + 1, 3) tangents
    kappa: Array  #: (f, n + 1) curvature [1/m]
    tau: Array  #: (f, n + 1) torsion [1/m]
    eta_prime: Array  #: (f, n + 1) d eta / du [1/m]


@dataclass(frozen=True)
class Surface:
    """A triangle mesh of the ribbon's surface, of p points and m triangles."""

    points: Array  #: (p, 3) [m]
    triangles: NDArray[np.int32]  #: (m, 3) indices of points
    fields: dict[str, Array]  #: (p) by name, such as "kappa"
    units: dict[str, str]  #: of the fields


class Result:
    """What a run leaves: frames, of which the last is the final state. It can be pickled, and saved as a run folder."""

    def __init__(self, native: _wunderlich.Run) -> None:
        self._native = native

    @cached_property
    def scene(self) -> Scene:
        """What was run."""
        return Scene._of(self._native.scene)

    @property
    def outcome(self) -> str:
        """"converged", "interrupted", or "not_converged": the last frame is then the last good state."""
        return self._native.outcome

    @cached_property
    def summary(self) -> dict[str, Any]:
        """The content of `summary.json`: energies [J], constraint errors, stability, topology, reactions, timing."""
        summary: dict[str, Any] = json.loads(self._native.summary_json())
        return summary

    @cached_property
    def history(self) -> dict[str, NDArray[Any]]:
        """(f) a column, made for `pandas.DataFrame(result.history)`.

        time [s], energies elastic, kinetic, gravity, total [J] and normalized (V l / (D w)); the largest violation of
        each constraint; area_error; iterations; step_us, the time the step took [us].
        """
        return self._native.history()

    @cached_property
    def strips(self) -> list[Strip]:
        """The frames, one item a strip."""
        return [Strip(**self._native.arrays(i)) for i in range(self._native.strips)]

    @property
    def strip(self) -> Strip:
        """The frames of the strip, the first if there are several."""
        return self.strips[0]

    def state(self, frame: int = -1, strip: int = 0) -> _wunderlich.State:
        """One recorded state, without a copy. Its arrays are read-only and live as long as anything refers to them."""
        return self._native.state(frame, strip)

    def surface(self, frame: int = -1) -> Surface:
        """The surface of all strips in one frame, as fine as the scene's `output` says."""
        return Surface(**self._native.surface(frame))

    def resume(self, *, observer: Observer | None = None) -> Result:
        """Goes on with an interrupted run; the end is bit for bit that of one run. Otherwise as `run`."""
        if self.outcome != "interrupted":
            raise ValueError(f"there is nothing to resume: the run of {self.scene.name} is {self.outcome}")
        return _run(self.scene, observer, self._native)

    def save(self, folder: str | os.PathLike[str], formats: str | Iterable[str] = ()) -> None:
        """Writes a run folder, whole or not at all; one that is there is replaced.

        Beside the tables, the summary and the checkpoint the format or formats asked for, of "vtp", "glb", "pc2", "obj", "svg" and
        those that `wunderlich export` knows; it makes further ones of the folder later. Raises InputError if the folder
        holds something else or cannot be written.
        """
        self._native.save(Path(folder), [formats] if isinstance(formats, str) else list(formats))

    @classmethod
    def load(cls, folder: str | os.PathLike[str]) -> Result:
        """Reads a run folder that `save` or the program has written. Raises InputError if it is none."""
        return cls(_wunderlich.load_run(Path(folder)))

    def __len__(self) -> int:
        """The number of frames."""
        return self._native.frames

    def __getstate__(self) -> dict[str, Any]:
        return {"_native": self._native}

    def __repr__(self) -> str:
        return f"<Result {self.scene.name}: {self.outcome}, {len(self)} frames>"


class NotConverged(RuntimeError):
    """A run or a step has not converged. The message says why."""

    def __init__(self, why: str, result: Result | None = None) -> None:
        super().__init__(why)
        self.result = result  #: of a run, up to the last good state; None where a `Motion` has it


class Interrupted(KeyboardInterrupt):
    """Ctrl-C has stopped a run after the step under way."""

    def __init__(self, why: str = "", result: Result | None = None) -> None:
        super().__init__(why)
        self.result = result  #: as far as it went; `result.resume()` goes on


def run(scene: SceneLike, overrides: Overrides | None = None, *, observer: Observer | None = None) -> Result:
    """Runs a scene, as `wunderlich run` does, and writes no files.

    scene: a Scene or the content of one, a file, or the name of a shipped scene; `overrides` as for `Scene`.
    observer: called after each step as observer(phase, fraction, iterations), the fraction of the path in [0, 1] and
        Newton's iterations so far. If it returns False the run stops and its result, `interrupted`, is returned; an
        exception ends it and is passed on.

    Raises InputError (a ValueError) on bad input; NotConverged and, on Ctrl-C, Interrupted (a KeyboardInterrupt), both
    with the result so far as `result`. Other Python threads go on meanwhile.
    """
    return _run(_scene_of(scene, overrides), observer, None)


def equilibrium(scene: SceneLike, overrides: Overrides | None = None, *, observer: Observer | None = None) -> Result:
    """Runs a scene to its equilibrium, quasi-statically. Arguments and exceptions are those of `run`.

    A scene of a motion is taken with its strips, supports and loads, at rest at the end of its duration; its section
    `solver` is replaced (the exact energy, default tolerances). Raises InputError where it has what an equilibrium
    knows nothing of: friction, releases, an initial state; None takes such a key away:
    `equilibrium("twist-release-soft", {"initial": None, "clamps.1.release": None})`.
    """
    checked = _scene_of(scene, overrides)
    if checked.method != "equilibrium":
        checked.set("solver", {"method": "equilibrium", "duration": checked.duration})
    return _run(checked, observer, None)


def _run(scene: Scene, observer: Observer | None, resume: _wunderlich.Run | None) -> Result:
    native, stopped = _wunderlich.run(scene._native, observer, resume)
    result = Result(native)
    if result.outcome == "not_converged":
        raise NotConverged(f"{scene.name}: did not converge: {result.summary['failure']}", result)
    if stopped:
        raise Interrupted(f"{scene.name}: interrupted", result)
    return result
