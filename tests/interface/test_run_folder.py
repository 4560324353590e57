"""The run folder: complete, replaced whole, never mixed with what is not ours."""

import csv
import json

from program import ProgramTest, main

ALWAYS = {"summary.json", "centerline.csv", "history.csv", "checkpoint"}


class RunFolder(ProgramTest):
    def test_default_place_and_formats(self):
        result = self.expect(0, "run", "strip.yaml")
        self.assertIn("out/strip", result.stdout)
        names = {path.name for path in (self.folder / "out/strip").iterdir()}
        self.assertEqual(names, ALWAYS | {"ribbon.pvd", "frames", "ribbon.glb", "pattern.svg", "report.html",
                                         "picture.png"})
        self.assertEqual({path.name for path in (self.folder / "out").iterdir()}, {"strip"}, "left-overs beside the run")

    def test_formats_of_the_command_line_and_of_the_scene(self):
        self.expect(0, "run", "strip.yaml", "--out", "none", "--formats", "none")
        self.assertEqual({path.name for path in (self.folder / "none").iterdir()}, ALWAYS)
        self.expect(0, "run", "strip.yaml", "--out", "scene", "--set", "output.formats=[obj]")
        self.assertEqual({path.name for path in (self.folder / "scene").iterdir()}, ALWAYS | {"ribbon.obj"})

    def test_tables_and_summary(self):
        self.expect(0, "run", "strip.yaml", "--out", "run", "--formats", "none")
        summary = json.loads((self.folder / "run/summary.json").read_text())
        self.assertEqual(summary["scene"], "strip")
        self.assertIs(summary["converged"], True)
        self.assertEqual(summary["segments"], 12)
        with open(self.folder / "run/centerline.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 13)
        self.assertLess(float(rows[-1]["z"]), -0.01, "the strip does not hang")

    def test_a_run_folder_is_replaced_whole(self):
        self.expect(0, "run", "strip.yaml", "--out", "run", "--formats", "obj,svg")
        self.expect(0, "run", "strip.yaml", "--out", "run", "--formats", "none", "--set", "ribbon.segments=6")
        self.assertEqual({path.name for path in (self.folder / "run").iterdir()}, ALWAYS)
        self.assertEqual(json.loads((self.folder / "run/summary.json").read_text())["segments"], 6)
        self.assertEqual({path.name for path in self.folder.iterdir()}, {"run", "strip.yaml"})

    def test_any_other_folder_is_refused(self):
        (self.folder / "mine").mkdir()
        (self.folder / "mine/thesis.tex").write_text("years of work")
        self.expect_refused("run", "strip.yaml", "--out", "mine", says="mine")
        self.expect_refused("run", "strip.yaml", "--out", ".", says=".")

    def test_an_empty_folder_is_taken(self):
        (self.folder / "empty").mkdir()
        self.expect(0, "run", "strip.yaml", "--out", "empty", "--formats", "none")
        self.assertEqual({path.name for path in (self.folder / "empty").iterdir()}, ALWAYS)

    def test_not_converging_is_said_and_the_last_state_written(self):
        result = self.call("run", "moebius", "--out", "run", "--formats", "none", "--set", "solver.max_iterations=2")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("did not converge", result.stderr)
        self.assertIs(json.loads((self.folder / "run/summary.json").read_text())["converged"], False)
        self.assertTrue((self.folder / "run/centerline.csv").exists())


if __name__ == "__main__":
    main()
