"""Runs: the program's numbers, shapes, ends before the end, what is kept."""

import concurrent.futures
import json
import multiprocessing
import os
import pickle
import signal
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path

import numpy as np
import wunderlich

PROGRAM = os.environ["WUNDERLICH_PROGRAM"]


def by_program(*arguments):
    """summary.json and centerline.csv of a run of the program."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        subprocess.run([PROGRAM, "run", *arguments, "--quiet", "--formats", "svg", "--out", out], check=True)
        return json.loads((out / "summary.json").read_text()), np.genfromtxt(out / "centerline.csv", delimiter=",", names=True)


class Runs(unittest.TestCase):
    def test_same_bits_as_the_program(self):
        for scene, overrides in [("moebius", {"ribbon.segments": 30}), ("swing", {"solver.duration": 0.1})]:
            summary, line = by_program(scene, *[f"--set={key}={value}" for key, value in overrides.items()])
            result = wunderlich.run(scene, overrides)
            self.assertEqual(result.outcome, "converged")
            strip = result.strip
            for key in ["energy", "constraints", "topology", "steps", "area_error", "kappa_zeros"]:
                self.assertEqual(result.summary[key], summary[key], key)
            for name, values in [("kappa", strip.kappa), ("tau", strip.tau), ("eta", strip.eta), ("u", strip.u[None])]:
                np.testing.assert_array_equal(values[-1], line[name])
            np.testing.assert_array_equal(strip.r[-1], np.stack([line["x"], line["y"], line["z"]], axis=1))

    def test_shapes(self):
        result = wunderlich.run("swing", {"solver.duration": 0.02, "ribbon.segments": 20})
        frames, n = len(result), 20
        strip = result.strip
        shapes = {"u": (n + 1,), "time": (frames,), "q": (frames, n, 4)}
        shapes |= dict.fromkeys(["r", "r_dot", "d1", "d2", "d3"], (frames, n + 1, 3))
        shapes |= dict.fromkeys(["eta", "kappa", "tau", "eta_prime"], (frames, n + 1))
        for name, values in vars(strip).items():
            self.assertEqual((values.shape, values.dtype), (shapes[name], np.float64), name)
        np.testing.assert_allclose(np.linalg.norm(strip.q, axis=-1), 1, atol=1e-12)
        np.testing.assert_allclose(np.cross(strip.d1, strip.d2), strip.d3, atol=1e-12)
        np.testing.assert_array_equal(strip.time, result.history["time"])
        self.assertGreater(frames, 5)
        self.assertTrue((np.diff(strip.time) > 0).all())

    def test_history_is_a_table(self):
        history = wunderlich.run("cantilever").history
        self.assertEqual({values.ndim for values in history.values()}, {1})
        self.assertEqual(len({len(values) for values in history.values()}), 1)
        np.testing.assert_array_equal(history["elastic"] + history["kinetic"] + history["gravity"], history["total"])
        self.assertEqual(history["iterations"].dtype.kind, "i")

    def test_state_is_a_view(self):
        result = wunderlich.run("cantilever", {"ribbon.segments": 10})
        state = result.state()
        for name in ["r", "r_dot", "q", "eta"]:
            array = getattr(state, name)
            self.assertTrue(np.shares_memory(array, getattr(result.state(), name)), name)
            self.assertFalse(array.flags.writeable or array.flags.owndata, name)
        view = state.r
        expected = result.strip.r[-1].copy()
        del result, state  # the view keeps alive what it looks at
        np.testing.assert_array_equal(view, expected)

    def test_surface(self):
        result = wunderlich.run("cantilever")
        surface = result.surface()
        a, b, c = (surface.points[surface.triangles[:, i]] for i in range(3))
        area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
        self.assertAlmostEqual(area, 0.1, delta=1e-4)
        self.assertEqual(surface.fields["kappa"].shape, surface.points.shape[:1])
        self.assertEqual((surface.fields.keys(), surface.units["kappa"]), (surface.units.keys(), "1/m"))

    def test_several_strips(self):
        result = wunderlich.run("paper-chain", {"solver.duration": 0.01})
        self.assertEqual(len(result.strips), len(result.scene.ribbons))
        self.assertFalse(np.array_equal(result.strips[0].r, result.strips[1].r))

    def test_equilibrium_of_a_motion(self):
        swing = wunderlich.equilibrium("swing")
        self.assertEqual((swing.outcome, swing.summary["method"]), ("converged", "equilibrium"))
        self.assertTrue(swing.summary["stability"]["stable"])

    def test_what_an_equilibrium_knows_nothing_of_is_taken_away(self):
        with self.assertRaisesRegex(wunderlich.InputError, "initial"):
            wunderlich.equilibrium("belt-release-soft")
        self.assertEqual(wunderlich.equilibrium("belt-release-soft", {"initial": None}).outcome, "converged")
        with self.assertRaisesRegex(wunderlich.InputError, "is not in the scene"):
            wunderlich.equilibrium("swing", {"initial": None})

    def test_what_is_no_scene(self):
        with self.assertRaisesRegex(TypeError, "not a NoneType"):
            wunderlich.run(None)
        with self.assertRaisesRegex(TypeError, "overrides.*not a list"):
            wunderlich.run("swing", ["ribbon.segments=10"])
        with self.assertRaisesRegex(IndexError, "strip out of range"):
            wunderlich.run("swing", {"solver.duration": 0.01}).state(0, 1)

    def test_of_a_dict(self):
        content = {"ribbon": {"length": 1, "width": 0.1}, "clamps": [{"at": "start"}], "gravity": [0, 0, -5],
                   "solver": {"method": "equilibrium"}}
        tip = wunderlich.run(content).strip.r[-1, -1]
        np.testing.assert_array_equal(tip, wunderlich.run("cantilever").strip.r[-1, -1])

    def test_not_converged(self):
        with self.assertRaisesRegex(wunderlich.NotConverged, "moebius: did not converge: .*max_iterations") as caught:
            wunderlich.run("moebius", {"solver.max_iterations": 1})
        result = caught.exception.result
        self.assertEqual(result.outcome, "not_converged")
        self.assertLess(result.history["max_length_error"][-1], 1e-12)  # the last good state
        again = pickle.loads(pickle.dumps(caught.exception))
        self.assertEqual((str(again), again.result.outcome), (str(caught.exception), "not_converged"))
        with self.assertRaisesRegex(ValueError, "nothing to resume"):
            result.resume()


class Stopped(unittest.TestCase):
    def test_by_the_observer_and_resumed(self):
        seen = []

        def observer(phase, fraction, iterations):
            seen.append((phase, fraction, iterations))
            return len(seen) < 7

        whole = wunderlich.run("swing", {"solver.duration": 0.05})
        part = wunderlich.run(whole.scene, observer=observer)
        self.assertEqual((part.outcome, part.summary["steps"], len(seen)), ("interrupted", 7, 7))
        rest = pickle.loads(pickle.dumps(part)).resume()
        self.assertEqual(rest.summary["energy"], whole.summary["energy"])
        np.testing.assert_array_equal(rest.strip.r[-1], whole.strip.r[-1])

    def test_error_of_the_observer(self):
        with self.assertRaises(ZeroDivisionError):
            wunderlich.run("swing", observer=lambda *_: 1 / 0)

    def test_interrupt(self):
        timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt) as caught:
            wunderlich.run("swing", {"solver.duration": 1000})
        timer.join()
        result = caught.exception.result
        self.assertEqual(result.outcome, "interrupted")
        self.assertGreater(result.summary["steps"], 0)
        self.assertLess(result.history["max_length_error"][-1], 1e-8)

    def test_other_threads_go_on(self):
        ticks, done = [], threading.Event()

        def tick():
            while not done.is_set():
                ticks.append(time.perf_counter())
                time.sleep(0.001)

        scene = wunderlich.load("moebius", {"ribbon.segments": 4000})
        thread = threading.Thread(target=tick)
        thread.start()
        before = time.perf_counter()
        wunderlich.run(scene)
        after = time.perf_counter()
        done.set()
        thread.join()
        during = sum(before < at < after for at in ticks)
        self.assertGreater(during, 2, f"in {after - before} s")


def tip(gravity):
    return wunderlich.run("cantilever", {"gravity": [0, 0, -gravity]})


class Kept(unittest.TestCase):
    def same(self, a, b):
        self.assertEqual((a.summary, a.outcome, a.scene.text, a.scene.name), (b.summary, b.outcome, b.scene.text, b.scene.name))
        for one, other in zip(a.strips, b.strips, strict=True):
            for name, values in vars(one).items():
                np.testing.assert_array_equal(values, getattr(other, name))
        for name, values in a.history.items():
            np.testing.assert_array_equal(values, b.history[name])

    def test_pickled_by_other_processes(self):
        method = multiprocessing.get_context("spawn")
        with concurrent.futures.ProcessPoolExecutor(2, mp_context=method) as pool:
            results = list(pool.map(tip, [1, 2]))
        for gravity, result in zip([1, 2], results):
            np.testing.assert_array_equal(result.strip.r, tip(gravity).strip.r)

    def test_pickled(self):
        for scene, overrides in [("cantilever", {}), ("paper-chain", {"solver.duration": 0.01})]:
            result = wunderlich.run(scene, overrides)
            self.same(pickle.loads(pickle.dumps(result)), result)

    def test_saved(self):
        result = wunderlich.run("swing", {"solver.duration": 0.01})
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "out"
            result.save(out, ["vtp", "glb", "png"])
            self.assertTrue({"summary.json", "history.csv", "ribbon.glb", "ribbon.pvd", "picture.png"} <= {path.name for path in out.iterdir()})
            self.same(wunderlich.Result.load(out), result)
            subprocess.run([PROGRAM, "export", out, "--to", "html"], check=True, capture_output=True)
            self.assertTrue((out / "report.html").exists())
            with self.assertRaisesRegex(wunderlich.InputError, "unknown format"):
                result.save(out, ["bmp"])
            with self.assertRaisesRegex(wunderlich.InputError, "wunderlich export"):
                result.save(out, ["html"])
            with self.assertRaises(wunderlich.InputError):
                wunderlich.Result.load(folder)


if __name__ == "__main__":
    unittest.main(verbosity=2)
