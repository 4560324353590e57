"""The flat pattern: true to scale, read by an XML parser that is not ours and measured against centerline.csv."""

import csv
import math
import xml.etree.ElementTree as ElementTree

from program import STRIP, ProgramTest, main

SVG = "{http://www.w3.org/2000/svg}"


def corners(group):
    return [tuple(map(float, corner.split(","))) for corner in group.find(f"{SVG}polygon").get("points").split()]


def ends(line):
    return [tuple(float(line.get(k + n)) for k in "xy") for n in "12"]


class Pattern(ProgramTest):
    def pattern(self, scene, *settings):
        self.expect(0, "run", scene, "--out", "run", "--formats", "none", "--quiet", *settings)
        self.expect(0, "export", "run", "--to", "svg-pattern", "--out", "pattern.svg")
        root = ElementTree.parse(self.folder / "pattern.svg").getroot()
        return root, {group.get("id"): group for group in root.iter(f"{SVG}g")}

    def test_a_unit_of_the_drawing_is_a_millimetre(self):
        root, _ = self.pattern("strip.yaml")
        _, _, width, height = (float(number) for number in root.get("viewBox").split())
        self.assertEqual(root.get("width"), f"{width:.4f}mm")
        self.assertEqual(root.get("height"), f"{height:.4f}mm")
        self.assertEqual(root.find(f"{SVG}title").text, "strip")

    def test_the_cut_is_the_strip(self):
        self.write("wide.yaml", STRIP.replace("length: 1, width: 0.1", "length: 0.297, width: 0.021"))
        for scene, length, width in (("strip.yaml", 1000, 100), ("wide.yaml", 297, 21)):
            _, groups = self.pattern(scene)
            xs, ys = zip(*corners(groups["cut"]))
            self.assertEqual(len(xs), 4)
            self.assertAlmostEqual(max(xs) - min(xs), length, places=3)
            self.assertAlmostEqual(max(ys) - min(ys), width, places=3)
            self.assertNotIn("joint", groups)

    def test_folds_are_the_rulings(self):
        # Across the middle at the node's arc length, slanted by eta; seen from the front, d2 points down the page.
        _, groups = self.pattern("helix", "--set", "ribbon.segments=20")
        with open(self.folder / "run/centerline.csv", newline="", encoding="utf-8") as file:
            nodes = [{k: float(v) for k, v in row.items() if v} for row in csv.DictReader(file)]
        width = max(y for _, y in corners(groups["cut"])) * 2
        lines = {int(line.find(f"{SVG}title").text.split()[1].rstrip(":")): ends(line)
                 for kind in ("valley", "mountain") for line in groups[kind].findall(f"{SVG}line")}
        self.assertEqual(sorted(lines), list(range(1, 20)))
        self.assertGreater(max(abs(node["eta"]) for node in nodes), 0.1, "no ruling is slanted")
        for i, ((x1, y1), (x2, y2)) in lines.items():
            self.assertAlmostEqual(0.5 * (x1 + x2), 1000 * nodes[i]["u"], places=3)
            self.assertAlmostEqual(abs(y2 - y1), width, places=3)
            self.assertAlmostEqual((x2 - x1) / (y2 - y1), nodes[i]["eta"], places=4)

    def test_folds_follow_the_sign_of_the_curvature(self):
        # Seen from above, its front, a strip that hangs folds away; one that rises folds towards us.
        for gravity, expected in (("[0, 0, -1]", [0, 11]), ("[0, 0, 1]", [11, 0])):
            _, groups = self.pattern("strip.yaml", "--set", f"gravity={gravity}")
            found = [groups[kind].findall(f"{SVG}line") for kind in ("valley", "mountain")]
            self.assertEqual([len(lines) for lines in found], expected)
            weights = [float(line.get("opacity")) for line in found[0] + found[1]]
            self.assertEqual(weights, sorted(weights, reverse=True), "folds grow weaker from the clamp to the free end")

    def test_the_scale_bar_is_as_long_as_it_says(self):
        for size in ("length: 1, width: 0.1", "length: 0.05, width: 0.005", "length: 7, width: 0.3"):
            self.write("sized.yaml", STRIP.replace("length: 1, width: 0.1", size))
            _, groups = self.pattern("sized.yaml", "--set", "gravity=[0, 0, -1e-4]")
            path = groups["scale"].find(f"{SVG}path").get("d").replace("M", "").split("V")
            start, end = float(path[0].split()[0]), float(path[1].split("H")[1])
            self.assertEqual(groups["scale"].find(f"{SVG}text").text, f"{end - start:g} mm")

    def test_a_loop_says_how_its_ends_meet(self):
        for scene, says, letters in (("moebius", "after 1 half turn, ", "ABBA"), ("ring", "without a turn", "ABAB")):
            _, groups = self.pattern(scene)
            self.assertIn(f"join the ends {says}", groups["legend"].findall(f"{SVG}text")[-1].text)
            self.assertEqual("".join(text.text for text in groups["joint"].findall(f"{SVG}text")), letters)

    def test_the_ends_of_a_loop_fit_and_the_tab_lies_under_the_strip(self):
        for scene, length, turned in (("moebius", 2000 * math.pi, True), ("ring", 1000, False)):
            _, groups = self.pattern(scene)
            a, end_a, tab_a, tab_b, end_b, b = corners(groups["cut"])
            self.assertEqual(ends(groups["joint"].find(f"{SVG}line")), [end_a, end_b])
            for (x, y), (u, v) in zip((end_a, end_b), (b, a) if turned else (a, b)):
                self.assertAlmostEqual(x, u + length, places=3)  # the end meets the start, mirrored after half a turn
                self.assertAlmostEqual(y, -v if turned else v, places=3)
            self.assertGreater(min(tab_a[0] - end_a[0], tab_b[0] - end_b[0]), 0.4 * (b[1] - a[1]))
            self.assertTrue(a[1] < tab_a[1] < tab_b[1] < b[1])


if __name__ == "__main__":
    main()
