"""Every shipped equilibrium is one, and the figures it is shipped for hold."""

import json
import unittest

from program import SCENES, ProgramTest


class ShippedScenes(ProgramTest):
    def summary(self, scene, *settings):
        """Runs a scene and returns its summary.json."""
        words = [word for setting in settings for word in ("--set", setting)]
        result = self.call("run", scene, "--quiet", "--formats", "none", "--out", "run", *words)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads((self.folder / "run" / "summary.json").read_text())

    def energy(self, scene, *settings):
        return self.summary(scene, *settings)["energy"]["normalized"]

    def test_all_converge_to_stable_isometric_states(self):
        scenes = sorted(path for path in SCENES.glob("*.yaml") if "method: equilibrium" in path.read_text())
        self.assertGreaterEqual(len(scenes), 8)
        for scene in scenes:
            with self.subTest(scene=scene.stem):
                result = self.summary(scene.stem)
                self.assertTrue(result["converged"])
                self.assertTrue(result["stability"]["stable"])
                for name in ("max_length_error", "max_parallel_error", "max_binormal", "max_torsion_mismatch"):
                    self.assertLessEqual(result["constraints"][name], 1e-9, name)
                self.assertLess(result["constraints"]["max_ruling_ratio"], 1)
                self.assertLessEqual(result["area_error"], 1e-10)

    def test_figure_eight(self):
        exact = 56.2198048706607  # validation/reference/loop2pi.json
        errors = [abs(self.energy("figure-eight", f"ribbon.segments={n}") / exact - 1) for n in (50, 100, 200)]
        for error, bound in zip(errors, (4e-3, 1e-3, 2.5e-4)):
            self.assertLessEqual(error, bound)
        for coarse, fine in zip(errors, errors[1:]):
            self.assertGreaterEqual(coarse / fine, 2**1.8)

    def test_helix(self):
        exact = 19.53125  # validation/reference/analytic.json, kappa l = 4, tau l = 3
        errors = [abs(self.energy("helix", f"ribbon.segments={n}") / exact - 1) for n in (25, 50, 100)]
        for coarse, fine in zip(errors, errors[1:]):
            self.assertGreaterEqual(coarse / fine, 2**1.8)

    def test_moebius_at_every_aspect(self):
        # The energy grows with the width; 59.677205 at 5 pi is the reference, the others bracket it.
        aspects = ("10pi", "7pi", "5pi", "4pi", "3pi", "5/2pi", "2pi", "3/2pi", "5/4pi")
        energies = [self.energy("moebius", f"ribbon.aspect={aspect}", "ribbon.segments=100") for aspect in aspects]
        self.assertEqual(energies, sorted(energies))
        self.assertAlmostEqual(energies[2] / 59.677204766524085, 1, delta=1e-3)

    def test_a_strip_twists_under_any_pull(self):
        # Strong reactions beside small residuals: the merit function must still let Newton's steps pass.
        pull = "[{{at: end, keyframes: [{{time: 0, force: [1, 0, 0]}}, {{time: 1, force: [{}, 0, 0]}}]}}]"
        for segments in (35, 50, 70):
            for force in (300, 400, 600, "250*pi"):
                with self.subTest(segments=segments, force=force):
                    self.summary("twist-2pi", f"ribbon.segments={segments}", "forces=" + pull.format(force))

    def test_a_full_turn_under_tension_stays_in_the_strip(self):
        for segments in (35, 70, 100):
            self.assertAlmostEqual(self.summary("twist-2pi", f"ribbon.segments={segments}")["topology"]["link"], 1, delta=0.02)

    def test_a_loosened_strip_coils_and_stays_coiled(self):
        # At the smallest load, at time 2, it leaves a saddle, and which of two shapes it comes to is a matter of rounding.
        twisted, loose, pulled = (self.summary("coil", f"solver.duration={t}") for t in (1, 1.98, 3))
        self.assertAlmostEqual(twisted["topology"]["link"], 1, delta=0.02)
        self.assertGreater(twisted["topology"]["twist"], 0.9)
        self.assertLess(loose["topology"]["twist"], 0.5)
        for coiled in (loose, pulled):  # the turn cannot leave a strip that feels itself: its twist has become writhe
            self.assertAlmostEqual(coiled["topology"]["link"], 1, delta=0.1)
            self.assertGreater(coiled["contact"]["minimum_distance"], 0)
        self.assertLess(loose["energy"]["elastic"], 0.3 * twisted["energy"]["elastic"])

    def test_an_upright_strip_past_its_critical_height_is_no_stable_flat_state(self):
        # A heavy column buckles at rho g l^3 / D = 7.837 (Greenhill 1881).
        standing = ("clamps.0.tangent=[0,0,1]", "clamps.0.normal=[1,0,0]")
        below = self.summary("cantilever", *standing, "gravity=[0,0,-7.5]")
        self.assertLess(below["energy"]["elastic"], 1e-12)
        above = self.summary("cantilever", *standing, "gravity=[0,0,-9]")
        self.assertGreater(above["energy"]["elastic"], 1e-3)


if __name__ == "__main__":
    unittest.main()
