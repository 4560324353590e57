"""Interruption and going on: the resumed run ends as the uninterrupted one, bit for bit."""

import json
import re
import signal
import subprocess
import time

from program import PROGRAM, ProgramTest, main

# Long enough to be caught in the middle, on any machine.
LONG = ["moebius", "--set", "ribbon.segments=3000", "--formats", "none", "--out", "run"]


class Resume(ProgramTest):
    def interrupted_run(self, how, seconds=0.4):
        """Starts the long run and stops it; the run must have been interrupted before it was done."""
        for _ in range(6):
            process = subprocess.Popen([PROGRAM, "run", *LONG], cwd=self.folder, stdout=subprocess.PIPE,
                                       stderr=subprocess.PIPE, text=True)
            time.sleep(seconds)
            process.send_signal(how)
            _, message = process.communicate(timeout=120)
            if process.returncode == 130:
                return message
            self.assertIn(process.returncode, (0, -how), message)
            seconds *= 0.4 if process.returncode == 0 else 2
        self.fail("the run could not be interrupted in the middle")

    def test_interrupting_leaves_a_run_folder_and_says_how_to_go_on(self):
        for how in (signal.SIGINT, signal.SIGTERM):
            message = self.interrupted_run(how)
            self.assertIn("--resume", message)
            summary = json.loads((self.folder / "run/summary.json").read_text())
            self.assertIs(summary["converged"], False)
            self.assertEqual({path.name for path in self.folder.iterdir()}, {"run", "strip.yaml"})

    def test_resumed_run_ends_bit_for_bit_as_an_uninterrupted_one(self):
        self.interrupted_run(signal.SIGINT)
        self.expect(0, "run", "moebius", "--out", "run", "--formats", "none", "--resume")
        self.expect(0, "run", *LONG[:-1], "whole")
        self.assertEqual((self.folder / "run/centerline.csv").read_bytes(), (self.folder / "whole/centerline.csv").read_bytes())
        # Times of the clock differ; everything else in the history must not.
        tables = [re.sub(r",[^,\n]*$", "", (self.folder / run / "history.csv").read_text(), flags=re.M) for run in ("run", "whole")]
        self.assertEqual(*tables)

    def test_resuming_needs_the_same_scene(self):
        self.interrupted_run(signal.SIGINT)
        self.expect_refused("run", "moebius", "--out", "run", "--resume", "--set", "ribbon.segments=40", says="ribbon.segments=40")
        self.expect_refused("run", "ring", "--out", "run", "--resume", says=["moebius", "ring"])

    def test_resuming_an_edited_scene_is_refused(self):
        self.expect(0, "run", "strip.yaml", "--out", "run", "--formats", "none")
        scene = self.folder / "strip.yaml"
        scene.write_text(scene.read_text().replace("segments: 12", "segments: 13"))
        self.expect_refused("run", "strip.yaml", "--out", "run", "--resume", says=["strip.yaml", "changed"])

    def test_resuming_a_finished_run_changes_nothing(self):
        self.expect(0, "run", "strip.yaml", "--out", "run", "--formats", "none")
        before = self.tree()
        self.assertIn("nothing to resume", self.expect(0, "run", "strip.yaml", "--out", "run", "--resume").stderr)
        self.assertEqual(self.tree(), before)
        for formats in ("nonsense", ""):
            self.expect_refused("run", "strip.yaml", "--out", "run", "--resume", "--formats", formats, says="vtp")

    def test_resuming_without_a_run(self):
        self.expect_refused("run", "strip.yaml", "--resume", says="out/strip")
        (self.folder / "mine").mkdir()
        self.expect_refused("run", "strip.yaml", "--out", "mine", "--resume", says="mine")


if __name__ == "__main__":
    main()
