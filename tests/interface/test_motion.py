"""Motions: constraints at every recorded step, energy, repetition, interruption, and keys that make no sense."""

import csv
import re
import signal
import subprocess
import time

from program import PROGRAM, SCENES, ProgramTest, main

# A light strip let go from straight; a second of it is done in a second or two.
SWING = ["swing", "--set", "ribbon.segments=16", "--set", "solver.duration=0.5", "--formats", "none"]


class Motion(ProgramTest):
    def history(self, run="run"):
        with open(self.folder / run / "history.csv", encoding="utf-8") as file:
            return [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]

    def without_clock(self, run):
        return re.sub(r",[^,\n]*$", "", (self.folder / run / "history.csv").read_text(), flags=re.M)

    def test_shipped_motions_keep_their_constraints_at_every_step(self):
        for scene in sorted(SCENES.glob("*.yaml")):
            if "method: two-stage" not in scene.read_text():
                continue
            with self.subTest(scene=scene.stem):
                self.expect(0, "run", scene.stem, "--out", "run", "--formats", "none", "--set", "solver.duration=0.3")
                for row in self.history():
                    self.assertLessEqual(row["max_length_error"], 1e-9)
                    self.assertLessEqual(row["max_torsion_mismatch"], 1e-6)
                    self.assertLess(row["max_ruling_ratio"], 1)
                    self.assertLess(row["area_error"], 1e-2)

    def test_undamped_motion_keeps_its_energy(self):
        self.expect(0, "run", *SWING, "--out", "run")
        rows = self.history()
        most = max(row["kinetic"] for row in rows)
        self.assertGreater(most, 0.01)
        self.assertLess(max(abs(row["total"] - rows[0]["total"]) for row in rows), 2e-2 * most)

    def test_the_same_run_again_is_the_same_bit_for_bit(self):
        for run in ("one", "two"):
            self.expect(0, "run", *SWING, "--out", run)
        self.assertEqual(self.without_clock("one"), self.without_clock("two"))
        self.assertEqual((self.folder / "one/centerline.csv").read_bytes(), (self.folder / "two/centerline.csv").read_bytes())

    def test_interrupted_motion_goes_on_bit_for_bit(self):
        arguments = [*SWING, "--set", "ribbon.segments=40"]
        for seconds in (0.6, 0.3, 0.15, 1.5):
            process = subprocess.Popen([PROGRAM, "run", *arguments, "--out", "run"], cwd=self.folder,
                                       stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            time.sleep(seconds)
            process.send_signal(signal.SIGINT)
            _, message = process.communicate(timeout=120)
            if process.returncode == 130:
                break
        self.assertEqual(process.returncode, 130, message)
        self.expect(0, "run", "swing", "--out", "run", "--formats", "none", "--resume")
        self.expect(0, "run", *arguments, "--out", "whole")
        self.assertEqual((self.folder / "run/centerline.csv").read_bytes(), (self.folder / "whole/centerline.csv").read_bytes())
        self.assertEqual(self.without_clock("run"), self.without_clock("whole"))

    def test_a_step_beyond_the_stability_bound_is_said(self):
        beyond = ("solver.substeps=false", "solver.time_step=5e-4", "solver.duration=0.01")  # the bound is 4.1e-4
        settings = [word for setting in beyond for word in ("--set", setting)]
        message = self.expect(0, "run", *SWING, *settings, "--out", "run").stderr
        self.assertIn("stability bound", message)

    def test_a_released_clamp_is_held_to_the_last(self):
        arguments = ["twist-release-stiff", "--formats", "none", "--set", "clamps.1.release=0.05"]
        self.expect(0, "run", *arguments, "--set", "solver.duration=0.05", "--out", "run")
        self.expect(0, "run", *arguments, "--set", "solver.duration=0.15", "--out", "longer")
        self.assertEqual(self.history()[-1]["time"], 0.05)
        self.assertGreater(self.history("longer")[-1]["kinetic"], 10 * self.history()[-1]["kinetic"])

    def test_a_loop_of_lost_turns_is_no_start(self):
        result = self.expect(3, "run", "moebius", "--formats", "none", "--out", "run", "--set", "ribbon.half_twists=3",
                             "--set", "solver={method: two-stage, duration: 0.01}")
        self.assertIn("linking number", result.stderr)

    def test_keys_of_the_other_method_are_refused(self):
        for setting in ("solver.time_step=0.01", "initial.shape=coil", "solver.damping={normal: 1}"):
            self.expect_refused("check", "strip.yaml", "--set", setting, says="equilibrium")
        self.expect_refused("check", "swing", "--set", "solver.tolerance=1e-8", says=["two-stage", "tolerance"])
        self.expect_refused("check", "strip.yaml", "--set", "clamps.0.release=1", says="release")
        self.expect_refused("check", "swing", "--set", "initial.shape=coil", says="radius")
        self.expect_refused("check", "swing", "--set", "initial={shape: straight, radius: 1}", says="coil")
        self.expect_refused("check", "swing", "--set", "initial={shape: coil, radius: 1, slope: 2}", says="meet")
        self.expect_refused("check", "swing", "--set", "solver={method: two-stage, form: printed, minimiser: newton}", says="lbfgs")
        self.expect_refused("check", "swing", "--set", "solver.damping={normal: 1, factor_normal: 0.9}", says="damping")


if __name__ == "__main__":
    main()
