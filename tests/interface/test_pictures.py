"""Stills and films: decoded by programs that are not ours (VTK, ffprobe, ffmpeg)."""

import csv
import json
import os
import subprocess

from program import PROGRAM, ProgramTest, main
from vtkmodules.vtkIOImage import vtkPNGReader

SMALL = ("--size", "320x200")


def pixels(path):
    """Rows from the top, of (red, green, blue)."""
    reader = vtkPNGReader()
    reader.SetFileName(str(path))
    reader.Update()
    image = reader.GetOutput()
    width, height, _ = image.GetDimensions()
    values = image.GetPointData().GetScalars()
    assert values.GetNumberOfComponents() == 3
    data = bytes(memoryview(values))
    rows = [data[3 * width * y:3 * width * (y + 1)] for y in reversed(range(height))]
    return [list(zip(row[0::3], row[1::3], row[2::3])) for row in rows]


def share(picture, holds):
    """Of the pixels of which something holds."""
    return sum(holds(*pixel) for row in picture for pixel in row) / (len(picture) * len(picture[0]))


def paint(r, g, b):
    return r - b > 60


class Drawn(ProgramTest):
    def finished(self, *arguments):
        self.expect(0, "run", *arguments, "--out", "run", "--formats", "none", "--quiet")

    def still(self, *arguments):
        self.expect(0, "export", "run", "--to", "png", "--out", "still.png", *SMALL, *arguments)
        return pixels(self.folder / "still.png")


class Stills(Drawn):
    def test_a_run_leaves_a_picture(self):
        self.expect(0, "run", "strip.yaml", "--out", "run", "--quiet")
        picture = pixels(self.folder / "run/picture.png")
        self.assertEqual((len(picture[0]), len(picture)), (1200, 750))
        self.assertGreater(share(picture, paint), 0.01, "no strip is to be seen")
        self.assertEqual(picture[0][0], picture[0][-1], "the background is one colour")

    def test_a_flat_strip_is_as_long_as_it_is_wide(self):
        # From above, at one distance from the eye: 0.82 of the picture's width, and a tenth of that high.
        self.finished("strip.yaml", "--set", "gravity=[0, 0, 0]")
        for zoom, wide, high in ((1, 0.82, 0.082), (2, 1, 0.164)):
            picture = self.still("--view", "0,90", "--zoom", zoom)
            xs, ys = zip(*((x, y) for y, row in enumerate(picture) for x, pixel in enumerate(row) if paint(*pixel)))
            self.assertAlmostEqual(max(xs) - min(xs) + 1, wide * 320, delta=2)
            self.assertAlmostEqual(max(ys) - min(ys) + 1, high * 320, delta=2)

    def test_colours_follow_the_curvature(self):
        for gravity, sign in (("[0, 0, -1]", -1), ("[0, 0, 1]", 1)):
            self.finished("strip.yaml", "--set", f"gravity={gravity}")
            picture = self.still("--colour", "kappa")
            blue, red = share(picture, lambda r, g, b: b - r > 60), share(picture, lambda r, g, b: r - b > 60)
            self.assertGreater(sign * (red - blue), 0.005)
            self.assertEqual(min(red, blue), 0)

    def test_obstacles_are_drawn(self):
        short = ("drape-cylinder", "--set", "solver.duration=0.02", "--set", "output.frames=2")
        self.finished(*short)
        body = share(self.still(), lambda r, g, b: 80 < r < 200 and -4 < b - r < 30 and b > r)
        self.assertGreater(body, 0.05)

    def test_any_frame_can_be_drawn(self):
        self.finished("swing", "--set", "output.frames=5", "--set", "solver.duration=0.4")
        frames = len((self.folder / "run/history.csv").read_text().splitlines()) - 1
        first, last = self.still("--frame", "0", "--view", "30,20"), self.still("--view", "30,20")
        self.assertNotEqual(first, last)
        self.assertEqual(self.still("--frame", frames - 1, "--view", "30,20"), last)

    def test_refuses_what_cannot_be_drawn(self):
        self.finished("strip.yaml")
        (self.folder / "empty").mkdir()
        for says, *arguments in (
            ("unknown format 'gif'", "run", "--to", "gif"),
            ("nowhere: is not a run folder", "nowhere", "--to", "png"),
            ("empty: is not a run folder", "empty", "--to", "png"),
            ("strip.yaml: is not a run folder", "strip.yaml", "--to", "png"),
            ("from 16 to 8192", "run", "--to", "png", "--size", "0x0"),
            ("from 16 to 8192", "run", "--to", "png", "--size", "100000x100000"),
            ("must be WIDTHxHEIGHT", "run", "--to", "png", "--size", "big"),
            ("must be AZIMUTH,ELEVATION", "run", "--to", "png", "--view", "up"),
            ("--zoom: 0.5 is not allowed; must be from 1 to 100", "run", "--to", "png", "--zoom", "0.5"),
            ("--zoom: is for png and mp4, not for glb", "run", "--to", "glb", "--zoom", "2"),
            ("plain, kappa, tau, eta, energy", "run", "--to", "png", "--colour", "pink"),
            ("the run has the frames 0 to", "run", "--to", "png", "--frame", "1000"),
            ("the run has the frames 0 to", "run", "--to", "png", "--frame=-1"),
            ("--fps: is for mp4, not for png", "run", "--to", "png", "--fps", "25"),
            ("--frame: is for png, not for mp4", "run", "--to", "mp4", "--frame", "1"),
            ("--size: is for png and mp4, not for glb", "run", "--to", "glb", "--size", "320x200"),
            ("--fps: 0 is not allowed", "run", "--to", "mp4", "--fps", "0"),
            ("--fps: nan is not allowed", "run", "--to", "mp4", "--fps", "nan"),
            ("sides of a film must be even", "run", "--to", "mp4", "--size", "321x200"),
            ("nowhere/else/x.png", "run", "--to", "png", "--out", "strip.yaml/nowhere/else/x.png"),
        ):
            self.expect_refused("export", *arguments, says=says)

    def test_refuses_folders_of_other_commands(self):
        self.expect(0, "compare", "strip.yaml", "--models", "ribbon", "--out", "compared", "--quiet")
        self.expect_refused("export", "compared", "--to", "png", says="is not a run folder")


class Films(Drawn):
    def film(self, *arguments):
        self.expect(0, "export", "run", "--to", "mp4", "--out", "film.mp4", *SMALL, *arguments)
        text = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_streams", "-of", "json",
                               self.folder / "film.mp4"], capture_output=True, text=True, check=True).stdout
        (stream,) = json.loads(text)["streams"]
        return stream

    def test_every_frame_is_in_the_film(self):
        self.finished("swing", "--set", "output.frames=5", "--set", "solver.duration=0.4")
        with open(self.folder / "run/history.csv", newline="", encoding="utf-8") as file:
            frames = len(list(csv.DictReader(file)))
        stream = self.film("--fps", "10")
        self.assertEqual(int(stream["nb_read_frames"]), frames)
        self.assertAlmostEqual(float(stream["duration"]), frames / 10, places=3)
        self.assertEqual([stream[key] for key in ("codec_name", "pix_fmt", "width", "height", "color_space")],
                         ["h264", "yuv420p", 320, 200, "bt709"])

    def test_a_film_of_one_frame_is_the_still(self):
        self.expect(3, "run", "strip.yaml", "--quiet", "--formats", "none", "--out", "run", "--set", "solver.max_iterations=1")
        self.film()
        subprocess.run(["ffmpeg", "-v", "error", "-nostdin", "-i", "film.mp4", "-sws_flags",
                        "accurate_rnd+full_chroma_int", "-frames:v", "1", "frame.png"],
                       cwd=self.folder, check=True)
        still, frame = self.still(), pixels(self.folder / "frame.png")
        difference = sum(abs(a - b) for p, q in zip(still, frame) for x, y in zip(p, q) for a, b in zip(x, y))
        self.assertLess(difference / (3 * 320 * 200), 1.5, "levels of 255, on average")

    def refused_film(self, path, says):
        """With another PATH: exit code 2, and nothing of a film is left."""
        environment = dict(os.environ, PATH=str(path), TMPDIR=str(self.folder))
        for arguments in (["export", "run", "--to", "mp4"],
                          ["run", "strip.yaml", "--out", "other", "--formats", "mp4", "--quiet"]):
            result = subprocess.run([PROGRAM, *arguments], cwd=self.folder, env=environment, capture_output=True, text=True,
                                    timeout=60, check=False)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(says, result.stderr)
        self.assertFalse([path for path in self.tree() if "film" in str(path) or str(path).endswith(".mp4")])

    def test_without_ffmpeg_it_says_so(self):
        self.finished("strip.yaml")
        (self.folder / "bin").mkdir()
        before = self.tree()
        self.refused_film(self.folder / "bin", "apt-get install ffmpeg")
        self.assertEqual(self.tree(), before)

    def test_what_ffmpeg_says_is_passed_on(self):
        self.finished("strip.yaml")
        (self.folder / "bin").mkdir()
        self.write("bin/ffmpeg", "#!/bin/sh\necho 'Unknown encoder libx264' >&2\nexit 1\n").chmod(0o755)
        self.refused_film(self.folder / "bin", "ffmpeg failed: Unknown encoder libx264")
        self.assertTrue((self.folder / "other/summary.json").exists(), "the run itself is kept")


if __name__ == "__main__":
    main()
