"""Bad input: exit code 2, a message with file:line:column, key, value and what is allowed; nothing written."""

import os
import stat
import unittest

from program import STRIP, ProgramTest, main


class BadInput(ProgramTest):
    def refused(self, text, *says):
        self.write("bad.yaml", text)
        for command in ("check", "run"):
            self.expect_refused(command, "bad.yaml", says=["bad.yaml:", *says])

    def test_unknown_key(self):
        self.refused(STRIP.replace("gravity", "gravty"), "bad.yaml:5:1: gravty: unknown key", "did you mean `gravity`?")

    def test_wrong_type(self):
        self.refused(STRIP.replace("segments: 12", "segments: many"), "bad.yaml:2:43: ribbon.segments: `many`",
                     "a whole number from 2 to 1000000")

    def test_negative_width(self):
        self.refused(STRIP.replace("0.1", "-0.1"), "bad.yaml:2:28: ribbon.width: `-0.1`", "from 1e-06 to 1e+09 m")

    def test_zero_segments(self):
        self.refused(STRIP.replace("12", "0"), "ribbon.segments: `0`", "from 2")

    def test_not_finite_and_too_large(self):
        for number in (".nan", "nan", ".inf", "1e308", "-1e308", "1e999"):
            self.refused(STRIP.replace("length: 1", f"length: {number}"), f"bad.yaml:2:18: ribbon.length: `{number}`")
            self.refused(STRIP.replace("-1]", f"{number}]"), f"gravity.2: `{number}`")

    def test_contradictory_clamps(self):
        self.refused(STRIP.replace("  - at: start\n", "  - at: start\n  - at: start\n"), "bad.yaml:5:5: clamps.1: contradicts clamps.0")

    def test_clamps_beyond_the_length(self):
        self.refused(STRIP.replace("  - at: start\n", "  - at: start\n  - at: end\n    position: [1.5, 0, 0]\n"),
                     "bad.yaml:5:5: clamps.1: is 1.5 m away", "1 m long")

    def test_files_that_cannot_be_read(self):
        self.expect_refused("check", "missing.yaml", says="missing.yaml")
        self.expect_refused("run", ".", says="is a folder")
        os.mkfifo(self.folder / "pipe.yaml")
        before = sorted(os.listdir(self.folder))
        self.assertIn("not a regular file", self.expect(2, "check", "pipe.yaml").stderr)
        self.assertEqual(sorted(os.listdir(self.folder)), before)
        os.remove(self.folder / "pipe.yaml")
        self.expect_refused("run", "/dev/zero", says="not a regular file")
        self.refused(b"\xff\xfer\x00i\x00", "bad.yaml:1:1: byte 0xff")
        self.refused("", "this is empty")
        self.refused("[" * 100000, "bad.yaml:1:1")
        self.refused("a: &a [1]\nb: *a\n", "anchors")

    @unittest.skipIf(os.geteuid() == 0, "root reads everything")
    def test_file_without_permission(self):
        self.write("secret.yaml", STRIP).chmod(0)
        self.assertIn("cannot be read", self.expect(2, "check", "secret.yaml").stderr)

    def test_huge_file(self):
        self.write("huge.yaml", STRIP + "#" * (5 << 20))
        self.expect_refused("run", "huge.yaml", says="larger than 4 MiB")

    def test_huge_counts(self):
        self.refused(STRIP.replace("12", "1000000000"), "ribbon.segments")
        self.refused(STRIP.replace("12", "1000000"), "output.frames")

    def test_near_miss_of_a_shipped_scene(self):
        self.expect_refused("run", "mobius", says="did you mean `moebius`?")

    def test_overrides(self):
        self.expect_refused("run", "strip.yaml", "--set", "ribbon.width=-1", says="--set ribbon.width=-1: ribbon.width: `-1`")
        self.expect_refused("run", "strip.yaml", "--set", "ribbon.width", says="must be key=value")
        self.expect_refused("run", "strip.yaml", "--set", "clamps.7.at=end", says="clamps.7.at")

    def test_formats(self):
        self.expect_refused("frobnicate", says="'frobnicate'")
        self.expect_refused("run", "strip.yaml", "--out", "", says="must not be empty")
        self.expect_refused("run", "strip.yaml", "--formats", "vtp,glp", says=["glp", "glb"])

    def test_obstacles_where_they_cannot_be(self):
        solid = STRIP[: STRIP.index("solver:")] + "solver: {method: %s}\nobstacles: [{shape: sphere, radius: 0.1%s}]\n"
        self.refused(solid % ("equilibrium", ", friction: 0.2"), "obstacles.0", "use `implicit`")
        for method in ("implicit", "two-stage", "equilibrium"):
            self.refused(solid % (method, ""), "obstacles.0: the strip starts", "inside")

    def test_one_ribbon_and_several(self):
        self.refused(STRIP + "ribbons: []\n", "bad.yaml:2:", "ribbon: contradicts `ribbons`")

    def test_output_folder_that_cannot_be_written(self):
        self.write("file", "something")
        self.expect_refused("run", "strip.yaml", "--out", "file", says="file")
        self.expect_refused("run", "strip.yaml", "--out", "file/below", says="file")
        self.expect_refused("run", "strip.yaml", "--out", "/proc/nowhere", says="/proc")

    @unittest.skipIf(os.geteuid() == 0, "root writes everywhere")
    def test_output_folder_without_permission(self):
        (self.folder / "closed").mkdir()
        (self.folder / "closed").chmod(stat.S_IRUSR | stat.S_IXUSR)
        self.expect_refused("run", "strip.yaml", "--out", "closed/run", says="closed")


if __name__ == "__main__":
    main()
