"""Steps one by one, views that follow, and what is changed on the way."""

import threading
import unittest

import numpy as np
import wunderlich

IMPLICIT = {"solver": {"method": "implicit", "time_step": 0.005, "duration": 1}}


class Steps(unittest.TestCase):
    def test_steps_are_those_of_a_run(self):
        for overrides in [{}, IMPLICIT]:
            scene = wunderlich.load("swing", overrides | {"solver.duration": 0.05})
            result, motion = wunderlich.run(scene), wunderlich.Motion(scene)
            while motion.time < 0.05 - 1e-12:
                motion.step()
            self.assertAlmostEqual(motion.time, 0.05, delta=1e-12)
            np.testing.assert_allclose(motion.state.r, result.state().r, atol=1e-12)
            np.testing.assert_allclose(motion.strip().kappa[0], result.strip.kappa[-1], atol=1e-9)
            np.testing.assert_allclose(motion.surface().points, result.surface().points, atol=1e-12)
            self.assertAlmostEqual(motion.measure()["total"], result.summary["energy"]["total"], delta=1e-11)
            self.assertEqual(motion.measure().keys(), result.history.keys())

    def test_dt(self):
        motion = wunderlich.Motion("swing")
        motion.step(0.003)
        self.assertAlmostEqual(motion.time, 0.003, delta=1e-15)
        motion.step()
        self.assertAlmostEqual(motion.time, 0.004, delta=1e-15)
        for dt in [0, -1, 1e-20, float("nan"), float("inf")]:
            with self.assertRaises(ValueError):
                motion.step(dt)
            with self.assertRaises(ValueError):
                motion.move(0, (0, 0, 0), over=dt)
        for bad in [float("nan"), float("inf")]:
            with self.assertRaises(ValueError):
                motion.gravity = (0, 0, bad)
            with self.assertRaises(ValueError):
                motion.move(0, (0, bad, 0))
            with self.assertRaises(ValueError):
                motion.move(0, turn=bad)
        motion.step()
        self.assertAlmostEqual(motion.time, 0.006, delta=1e-15)

    def test_views_follow_and_outlive(self):
        motion = wunderlich.Motion("swing", {"ribbon.segments": 12})
        views = {name: getattr(motion.state, name) for name in ["r", "r_dot", "q", "eta"]}
        before = {name: view.copy() for name, view in views.items()}
        self.assertEqual([views[n].shape for n in views], [(13, 3), (13, 3), (12, 4), (13,)])
        for again in range(2):
            for _ in range(3):
                motion.step()
            for name, view in views.items():
                self.assertTrue(np.shares_memory(view, getattr(motion.state, name)), name)
                self.assertFalse(np.array_equal(view, before[name]), name)
                self.assertFalse(view.flags.writeable)
            motion.reset()  # and follow that as well
            for name, view in views.items():
                np.testing.assert_array_equal(view, before[name])
        motion.step()
        view, copy = views["r"], views["r"].copy()
        del motion, views  # the view keeps alive what it looks at
        np.testing.assert_array_equal(view, copy)

    def test_start(self):
        bent = wunderlich.equilibrium("swing")
        motion = wunderlich.Motion("swing", IMPLICIT, start=[bent.state()])
        self.assertEqual(motion.time, 0)
        np.testing.assert_allclose(motion.state.r, bent.state().r, atol=1e-14)
        for _ in range(5):
            motion.step()
        np.testing.assert_allclose(motion.state.r, bent.state().r, atol=5e-5)  # it was at rest
        with self.assertRaisesRegex(wunderlich.InputError, "segments"):
            wunderlich.Motion("swing", {"ribbon.segments": 7}, start=[bent.state()])

    def test_threads_each_with_a_motion(self):
        motions = [wunderlich.Motion("swing", IMPLICIT | {"gravity": [0, 0, -g]}) for g in (1, 2, 3)]

        def go(motion):
            for _ in range(20):
                motion.step()

        threads = [threading.Thread(target=go, args=[motion]) for motion in motions]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for motion in motions:
            alone = wunderlich.Motion(motion.scene)
            go(alone)
            np.testing.assert_array_equal(motion.state.r, alone.state.r)

    def test_two_threads_of_one_motion(self):
        motion = wunderlich.Motion("swing", IMPLICIT | {"ribbon.segments": 5000})
        thread = threading.Thread(target=motion.step, args=[0.01])
        thread.start()
        refused = 0
        while thread.is_alive():
            try:
                motion.measure()
            except RuntimeError as error:
                refused += "another thread" in str(error)
        thread.join()
        self.assertGreater(refused, 0)


class Changes(unittest.TestCase):
    def test_release_by_the_scene(self):
        motion = wunderlich.Motion("swing", IMPLICIT | {"clamps.0.release": 0.012})
        for _ in range(5):
            motion.step()
        self.assertAlmostEqual(motion.time, 0.025, delta=1e-12)
        self.assertGreater(np.linalg.norm(motion.state.r_dot[0]), 1e-3)  # it falls

    def test_release_and_gravity(self):
        motion = wunderlich.Motion("swing", IMPLICIT)
        motion.release(0)
        motion.gravity = np.array([0, 0, 3.0])
        self.assertEqual((motion.gravity, motion.supports()[0]["holds"]), ((0, 0, 3), False))
        for _ in range(20):
            motion.step()
        # Nothing bends a strip in free fall, and all of it has fallen g t^2 / 2.
        np.testing.assert_allclose(motion.state.r[:, 2], 0.5 * 3 * 0.1**2, atol=1e-6)
        np.testing.assert_allclose(motion.state.r_dot, np.tile([0, 0, 0.3], (51, 1)), atol=1e-6)
        motion.reset()
        self.assertTrue(motion.supports()[0]["holds"])
        self.assertEqual(motion.gravity, (0, 1.4776, -4.7767))

    def test_move(self):
        motion = wunderlich.Motion("swing", IMPLICIT)
        motion.move(0, (0.1, 0, 0), rotation=(0, 0, np.pi / 2), over=0.1)
        for _ in range(20):
            motion.step()
        clamp, = motion.supports()
        np.testing.assert_allclose(clamp["position"], (0.1, 0, 0), atol=1e-14)
        np.testing.assert_allclose(clamp["tangent"], (0, 1, 0), atol=1e-14)
        np.testing.assert_allclose(motion.state.r[0], (0.1, 0, 0), atol=1e-12)
        motion.move(0, turn=5 * np.pi, over=0.5)
        for _ in range(100):
            motion.step()
        clamp, = motion.supports()
        np.testing.assert_allclose(clamp["normal"], (0, 0, -1), atol=1e-12)  # two turns and a half
        with self.assertRaises(IndexError):
            motion.move(1, (0, 0, 0))
        with self.assertRaises(ValueError):
            motion.move(0, (0, 0, 0), over=0)
        with self.assertRaisesRegex(ValueError, "position: must be three numbers"):
            motion.move(0, (0, 0))
        with self.assertRaisesRegex(ValueError, "gravity: must be three numbers"):
            motion.gravity = "down"

    def test_hold_and_release(self):
        motion = wunderlich.Motion("swing", IMPLICIT)
        for _ in range(20):
            motion.step()
        tip = motion.state.r[-1].copy()
        pin = motion.hold(50)
        self.assertEqual([s["kind"] for s in motion.supports()], ["clamp", "pin"])
        motion.move(pin, tip + [-0.1, 0, 0.1], over=0.05)
        for _ in range(20):
            motion.step()
        np.testing.assert_allclose(motion.state.r[-1], tip + [-0.1, 0, 0.1], atol=1e-6)
        motion.release(pin)
        for _ in range(10):
            motion.step()
        with self.assertRaisesRegex(ValueError, "has let go"):
            motion.move(pin, tip)
        with self.assertRaisesRegex(TypeError, "integer"):
            motion.hold("a")
        self.assertGreater(np.linalg.norm(motion.state.r[-1] - tip - [-0.1, 0, 0.1]), 1e-3)
        self.assertLess(motion.measure()["max_length_error"], 1e-12)
        with self.assertRaises(IndexError):
            motion.hold(51)

    def test_not_converged(self):
        motion = wunderlich.Motion("swing", IMPLICIT)
        motion.step()
        pin = motion.hold(50)
        motion.move(pin, (5, 0, 0))  # further than the strip is long
        with self.assertRaisesRegex(wunderlich.NotConverged, "swing: step of") as caught:
            motion.step()
        self.assertIsNone(caught.exception.result)
        self.assertLess(motion.measure()["max_length_error"], 1e-12)  # the last good state
        motion.release(pin)
        motion.step()

    def test_several_strips(self):
        motion = wunderlich.Motion("paper-chain")
        motion.gravity = (0, 0, 0)
        motion.step()
        self.assertGreater(len(motion.states), 1)
        self.assertGreater(len(motion.supports()), 0)
        self.assertEqual(motion.supports(1), [])
        self.assertEqual(motion.strip(1).r.shape[0], 1)
        with self.assertRaises(IndexError):
            motion.supports(len(motion.states))


if __name__ == "__main__":
    unittest.main(verbosity=2)
