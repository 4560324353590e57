"""Scenes from names, files, texts and dicts; what is refused; docstrings."""

import copy
import inspect
import pickle
import tempfile
import unittest
from pathlib import Path

import numpy as np
import wunderlich

STRIP = {
    "ribbon": {"length": "2pi", "width": 0.1, "segments": 12},
    "clamps": [{"at": "start"}],
    "gravity": [0, 0, -1e-3],
    "solver": {"method": "equilibrium"},
}


class Scenes(unittest.TestCase):
    def test_shipped(self):
        shipped = Path(__file__).resolve().parents[2] / "scenes"
        self.assertEqual(wunderlich.scenes(), sorted(path.stem for path in shipped.glob("*.yaml")))
        scene = wunderlich.load("moebius", {"ribbon.segments": 20, "ribbon.aspect": "5pi/4"})
        self.assertEqual((scene.name, scene.method), ("moebius", "equilibrium"))
        ribbon = scene.ribbons[0]
        self.assertEqual((ribbon["segments"], ribbon["loop"], ribbon["half_twists"]), (20, True, 1))
        self.assertAlmostEqual(ribbon["width"], 1.6, delta=1e-12)

    def test_built(self):
        scene = wunderlich.Scene(STRIP, {"gravity": np.array([0, 0, -2.5]), "ribbon.segments": np.int64(8)})
        self.assertEqual(scene.ribbons[0]["segments"], 8)
        self.assertAlmostEqual(scene.ribbons[0]["length"], 6.283185307179586, delta=1e-15)
        self.assertIn("-2.5", scene.text)

    def test_set_and_copy(self):
        scene = wunderlich.load("moebius")
        finer = scene.copy({"ribbon.segments": 16})
        scene.set("ribbon.segments", 8)
        self.assertEqual((scene.ribbons[0]["segments"], finer.ribbons[0]["segments"]), (8, 16))
        with self.assertRaises(wunderlich.InputError):
            scene.set("ribbon.segments", 1)
        self.assertEqual(scene.ribbons[0]["segments"], 8)
        result = wunderlich.run(scene)
        scene.set("ribbon.segments", 9)
        self.assertEqual(result.scene.ribbons[0]["segments"], 8)  # what was run stays what was run

    def test_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "own.yaml"
            path.write_text(wunderlich.Scene(STRIP).text, encoding="utf-8")
            self.assertEqual(wunderlich.load(path).name, "own")

    def test_several(self):
        ribbons = wunderlich.load("paper-chain").ribbons
        self.assertGreater(len(ribbons), 1)
        self.assertEqual(len({ribbon["name"] for ribbon in ribbons}), len(ribbons))

    def test_pickled(self):
        for scene in [wunderlich.Scene(STRIP, name="one.2"), wunderlich.load("paper-chain")]:
            for other in [pickle.loads(pickle.dumps(scene)), copy.deepcopy(scene)]:
                self.assertEqual((other.text, other.name, other.ribbons), (scene.text, scene.name, scene.ribbons))


class Refused(unittest.TestCase):
    def refuse(self, *parts, call):
        with self.assertRaises(wunderlich.InputError) as caught:
            call()
        self.assertIsInstance(caught.exception, ValueError)
        for part in parts:
            self.assertIn(part, str(caught.exception))

    def test_input(self):
        self.refuse("--set ribbon.segments=-3", call=lambda: wunderlich.load("moebius", {"ribbon.segments": -3}))
        self.refuse("no-such-scene", call=lambda: wunderlich.load("no-such-scene"))
        self.refuse("mine:", "ribbon.widht", "width", call=lambda: wunderlich.Scene(
            STRIP | {"ribbon": {"length": 1, "widht": 0.1}}, name="mine"))
        self.refuse("mine:1:1: not valid YAML", call=lambda: wunderlich.Scene.from_text("ribbon: [", name="mine"))
        self.refuse("friction", call=lambda: wunderlich.equilibrium("drape-cylinder"))
        self.refuse("solver.method", call=lambda: wunderlich.Motion("moebius"))
        self.refuse("gravity", call=lambda: wunderlich.Scene(STRIP, {"gravity": [0, 0, float("nan")]}))

    def test_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "bad.yaml"
            path.write_text("ribbon:\n  length: 1\n  width: 0.1\n  segments: many\n", encoding="utf-8")
            self.refuse(f"{path}:4:13", "ribbon.segments", "many", call=lambda: wunderlich.run(path))

    def test_what_no_scene_holds(self):
        with self.assertRaisesRegex(TypeError, "has no place in a scene"):
            wunderlich.Scene({"ribbon": object()})


class Docstrings(unittest.TestCase):
    def test_everything_public_says_what_it_is(self):
        for name in wunderlich.__all__:
            thing = getattr(wunderlich, name)
            if isinstance(thing, str):
                continue
            self.assertTrue(thing.__doc__, name)
            members = vars(thing).items() if inspect.isclass(thing) or inspect.ismodule(thing) else []
            for member, value in members:
                if member.startswith("_") or not (callable(value) or isinstance(value, property)):
                    continue
                self.assertTrue(value.__doc__, f"{name}.{member}")


if __name__ == "__main__":
    unittest.main(verbosity=2)
