"""The commands, their output and their exit codes."""

import json
import re
import struct

from program import SCENES, ProgramTest, main


class Commands(ProgramTest):
    def test_version(self):
        self.assertRegex(self.expect(0, "--version").stdout, r"^wunderlich \d+\.\d+\.\d+\n$")

    def test_help_names_the_commands(self):
        text = self.expect(0, "--help").stdout
        for command in ("run", "check", "scenes", "export"):
            self.assertIn(command, text)
        self.assertIn("--resume", self.expect(0, "run", "--help").stdout)

    def test_wrong_usage_is_bad_input(self):
        self.expect(2)
        self.expect(2, "walk")
        self.expect(2, "run")
        self.expect(2, "run", "moebius", "--speed", "3")
        self.expect(2, "export", "somewhere")

    def test_scenes_lists_every_file_with_its_title(self):
        lines = self.expect(0, "scenes").stdout.splitlines()
        listed = {line.split()[0]: line for line in lines}
        self.assertEqual(set(listed), {path.stem for path in SCENES.glob("*.yaml")})
        for name, line in listed.items():
            title = re.search(r"^title: (.*)$", (SCENES / f"{name}.yaml").read_text(), re.M).group(1)
            self.assertIn(title.strip('"'), line)

    def test_check_reads_files_and_shipped_scenes_and_writes_nothing(self):
        before = self.tree()
        self.assertIn("ok", self.expect(0, "check", "moebius").stdout)
        self.assertIn("13 segments", self.expect(0, "check", "strip.yaml", "--set", "ribbon.segments=13").stdout)
        self.assertEqual(self.tree(), before)

    def test_set_takes_one_value_each(self):
        text = self.expect(0, "check", "--set", "ribbon.segments=20", "--set", "gravity=[0,0,-2]", "strip.yaml").stdout
        self.assertIn("20 segments", text)

    def test_a_shipped_scene_goes_before_a_file_of_its_name(self):
        self.write("ring", "no scene")
        self.expect(0, "check", "ring")
        self.expect_refused("check", "./ring", says="./ring:1:1")


class Export(ProgramTest):
    def setUp(self):
        super().setUp()
        self.expect(0, "run", "strip.yaml", "--out", "run", "--formats", "none", "--quiet")

    def test_writes_beside_the_run_by_default(self):
        for name, files in {"obj": ["ribbon.obj"], "glb": ["ribbon.glb"], "vtp": ["ribbon.pvd"], "pc2": ["ribbon.pc2"],
                            "svg": ["pattern.svg"], "svg-pattern": ["pattern.svg"], "html": ["report.html"],
                            "stl": ["ribbon.stl"], "3mf": ["ribbon.3mf"],
                            "png": ["picture.png"], "mp4": ["film.mp4"]}.items():
            result = self.expect(0, "export", "run", "--to", name)
            for file in files:
                self.assertIn(file, result.stdout)
                self.assertGreater((self.folder / "run" / file).stat().st_size, 100)
        glb = (self.folder / "run/ribbon.glb").read_bytes()
        self.assertEqual(struct.unpack("<4sII", glb[:12]), (b"glTF", 2, len(glb)))

    def test_writes_to_a_named_file(self):
        self.expect(0, "export", "run", "--to", "obj", "--out", "there.obj")
        self.assertIn("\nf ", (self.folder / "there.obj").read_text())

    def test_gives_what_the_run_would_have_written(self):
        self.expect(0, "run", "strip.yaml", "--out", "whole", "--formats", "glb,vtp,svg,png", "--quiet")
        for name in ("glb", "vtp", "svg", "png"):
            self.expect(0, "export", "run", "--to", name)
        whole, exported = self.tree("whole"), self.tree("run")
        compared = [path for path in whole if path.endswith((".glb", ".vtp", ".pvd", ".svg", ".png"))]
        self.assertGreater(len(compared), 3)
        for path in compared:
            self.assertEqual(whole[path], exported.get(path), path)

    def test_refuses_what_is_no_run_or_no_format(self):
        self.expect_refused("export", "nowhere", "--to", "obj", says="nowhere")
        self.expect_refused("export", "strip.yaml", "--to", "obj", says="strip.yaml")
        self.expect_refused("export", "run", "--to", "obi", says=["obi", "obj"])
        self.expect_refused("export", "run", "--to", "obj", "--out", "strip.yaml/x.obj", says="strip.yaml")

    def test_refuses_a_damaged_checkpoint(self):
        path = self.folder / "run/checkpoint"
        content = bytearray(path.read_bytes())
        content[len(content) // 2] ^= 1
        path.write_bytes(content)
        self.expect_refused("export", "run", "--to", "obj", says="checkpoint")

    def test_quiet_run_said_nothing(self):
        result = self.expect(0, "run", "strip.yaml", "--out", "run", "--formats", "none", "--quiet")
        self.assertEqual(result.stdout + result.stderr, "")
        self.assertEqual(json.loads((self.folder / "run/summary.json").read_text())["program"], "wunderlich")


if __name__ == "__main__":
    main()
