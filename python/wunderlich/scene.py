"""Scenes: what is simulated."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any, Union

from . import _wunderlich

Overrides = Mapping[str, Any]


def _assignments(overrides: Overrides | None) -> list[str]:
    if overrides is not None and not isinstance(overrides, Mapping):
        raise TypeError(f"overrides: must be values by dotted key, as {{\"ribbon.segments\": 100}}, not a {type(overrides).__name__}")
    return [f"{key}={value if isinstance(value, str) else json.dumps(value, default=_plain)}"
            for key, value in (overrides or {}).items()]


def _plain(value: Any) -> Any:
    """NumPy's numbers and arrays, which json does not know."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{value!r} has no place in a scene")


class Scene:
    """A checked scene, in SI units.

    Build one from the keys of a scene file: `Scene({"ribbon": {"length": 1, "width": 0.1}, ...})`; NumPy's numbers and
    arrays may stand in it. `load` reads a file or a shipped scene. `overrides` are values by dotted key, as `--set` on
    the command line: `{"ribbon.segments": 100, "ribbon.aspect": "5pi/4"}`; None takes a key away.

    Raises InputError (a ValueError) with the key, its value and what would be right.
    """

    _native: _wunderlich.Scene

    def __init__(self, content: Mapping[str, Any], overrides: Overrides | None = None, *, name: str = "scene") -> None:
        text = json.dumps(content, indent=1, default=_plain)  # which is YAML
        self._native = _wunderlich.scene_of(text, name, _assignments(overrides))

    @classmethod
    def _of(cls, native: _wunderlich.Scene) -> Scene:
        scene = cls.__new__(cls)
        scene._native = native
        return scene

    @classmethod
    def from_text(cls, text: str, overrides: Overrides | None = None, *, name: str = "scene") -> Scene:
        """The scene of a scene file's text. `name` stands for the file in messages."""
        return cls._of(_wunderlich.scene_of(text, name, _assignments(overrides)))

    def set(self, key: str, value: Any) -> None:
        """Gives a key another value: `scene.set("ribbon.segments", 200)`. If that is refused the scene stays as it is."""
        self._native = self.copy({key: value})._native

    def copy(self, overrides: Overrides | None = None) -> Scene:
        """The same scene, with other values where `overrides` says so."""
        return Scene.from_text(self.text, overrides, name=self.name)

    @property
    def name(self) -> str:
        """The file's name without its ending."""
        return self._native.name

    @property
    def title(self) -> str:
        """One line about the scene."""
        return self._native.title

    @property
    def text(self) -> str:
        """The scene as YAML, after all overrides: what a scene file would hold."""
        return self._native.text

    @property
    def method(self) -> str:
        """"implicit", "two-stage" or "equilibrium"."""
        return self._native.method

    @property
    def duration(self) -> float:
        """Time at the end [s]; of an equilibrium path the load parameter there."""
        return self._native.duration

    @property
    def time_step(self) -> float:
        """Of a motion [s]."""
        return self._native.time_step

    @property
    def ribbons(self) -> list[dict[str, Any]]:
        """One dict a strip: name, length [m], width [m], segments, bending_stiffness [N m], area_density [kg/m^2],
        loop, half_twists."""
        return self._native.ribbons

    def __repr__(self) -> str:
        return f"<Scene {self.name}: {self.method}, {', '.join(str(r['segments']) for r in self.ribbons)} segments>"


SceneLike = Union[Scene, Mapping[str, Any], str, "os.PathLike[str]"]


def load(name_or_path: str | os.PathLike[str], overrides: Overrides | None = None) -> Scene:
    """Reads a scene file, or a shipped scene by its name (`scenes` lists them). `overrides` as for `Scene`.

    Raises InputError (a ValueError) with file, line, key and what would be right.
    """
    return Scene._of(_wunderlich.read_scene(os.fspath(name_or_path), _assignments(overrides)))


def scenes() -> list[str]:
    """Names of the shipped scenes, in alphabetic order."""
    return sorted(_wunderlich.shipped_names())


def _scene_of(scene: SceneLike, overrides: Overrides | None) -> Scene:
    """A scene of its own from whatever says which one."""
    if isinstance(scene, Scene):
        return scene.copy(overrides) if overrides else Scene._of(scene._native)
    if isinstance(scene, Mapping):
        return Scene(scene, overrides)
    if not isinstance(scene, (str, os.PathLike)):
        raise TypeError(f"a Scene, its content as a dict, a file or a shipped scene's name is wanted, not a {type(scene).__name__}")
    return load(scene, overrides)
