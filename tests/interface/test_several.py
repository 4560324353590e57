"""Several ribbons in one scene: what a run writes of them, that it goes on after an interruption, and bad input."""

import csv
import json
import re
import signal
import subprocess
import time

from program import PROGRAM, ProgramTest, main

CHAIN = ["paper-chain", "--set", "solver.duration=0.12"]

CROSSED = """\
ribbons:
  - {length: 1, width: 0.1}
  - {length: 1, width: 0.1, initial: {position: [0.5, -0.5, -0.005], tangent: [0, 1, 0.01], normal: [0, -0.01, 1]}}
contact: {self: true}
"""


class Several(ProgramTest):
    def test_a_run_writes_all_of_them(self):
        self.expect(0, "run", *CHAIN, "--set", "solver.duration=0.02", "--formats", "vtp,glb,obj,svg,html", "--out", "run")
        with open(self.folder / "run/centerline.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["ribbon"] for row in rows], [str(i) for i in range(3) for _ in range(41)])
        frame = next((self.folder / "run/frames").iterdir()).read_bytes()
        self.assertIn(b'Name="ribbon"', frame)
        self.assertEqual({path.name for path in (self.folder / "run").glob("*.svg")},
                         {"pattern.svg", "pattern-2.svg", "pattern-3.svg"})
        self.assertIn("second", (self.folder / "run/report.html").read_text(encoding="utf-8"))
        summary = json.loads((self.folder / "run/summary.json").read_text())
        self.assertLessEqual(summary["constraints"]["max_length_error"], 1e-12)
        self.assertLessEqual(summary["area_error"], 1e-10)
        self.assertGreater(summary["contact"]["minimum_distance"], 0)

    def test_a_run_goes_on_as_if_it_had_not_been_interrupted(self):
        seconds = 0.5
        for _ in range(6):
            process = subprocess.Popen([PROGRAM, "run", *CHAIN, "--formats", "none", "--out", "run"], cwd=self.folder,
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            time.sleep(seconds)
            process.send_signal(signal.SIGINT)
            _, message = process.communicate(timeout=120)
            if process.returncode == 130:
                break
            self.assertIn(process.returncode, (0, -signal.SIGINT), message)
            seconds *= 0.4 if process.returncode == 0 else 2
        else:
            self.fail("the run could not be interrupted in the middle")
        self.expect(0, "run", "paper-chain", "--out", "run", "--formats", "none", "--resume")
        self.expect(0, "run", *CHAIN, "--formats", "none", "--out", "whole")
        self.assertEqual(*[(self.folder / run / "centerline.csv").read_bytes() for run in ("run", "whole")])
        self.assertEqual(*[re.sub(r",[^,\n]*$", "", (self.folder / run / "history.csv").read_text(), flags=re.M)
                           for run in ("run", "whole")])

    def test_strips_that_start_across_each_other_are_refused(self):
        self.write("crossed.yaml", CROSSED)
        self.expect_refused("check", "crossed.yaml", says=["crossed.yaml:4:", "contact", "one another"])
        self.expect(0, "check", "crossed.yaml", "--set", "ribbons.1.initial.position=[0.5, -0.5, 0.1]")
        self.expect(0, "check", "crossed.yaml", "--set", "contact.self=false", "--set", "obstacles=[{shape: plane, position: [0, 0, -9]}]")

    def test_check_names_each(self):
        said = self.expect(0, "check", "paper-chain").stdout
        for name in ("held", "second", "third"):
            self.assertIn(f"`{name}`", said)


if __name__ == "__main__":
    main()
