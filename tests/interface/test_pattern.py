"""The flat pattern: true to scale, read by an XML parser that is not ours."""

import xml.etree.ElementTree as ElementTree

from program import STRIP, ProgramTest, main

SVG = "{http://www.w3.org/2000/svg}"


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
            corners = groups["cut"].find(f"{SVG}polygon").get("points").split()
            xs, ys = zip(*(map(float, corner.split(",")) for corner in corners))
            self.assertEqual(len(corners), 4)
            self.assertAlmostEqual(max(xs) - min(xs), length, places=3)
            self.assertAlmostEqual(max(ys) - min(ys), width, places=3)

    def test_folds_follow_the_sign_of_the_curvature(self):
        # Hung from its start, the strip bends to one side alone; turned over, to the other.
        counts = []
        for gravity in ("[0, 0, -1]", "[0, 0, 1]"):
            _, groups = self.pattern("strip.yaml", "--set", f"gravity={gravity}")
            counts.append([len(groups[kind].findall(f"{SVG}line")) for kind in ("valley", "mountain")])
        self.assertEqual(sorted(counts[0]), [0, 11])
        self.assertEqual(counts[0], counts[1][::-1])

    def test_the_scale_bar_is_as_long_as_it_says(self):
        for size in ("length: 1, width: 0.1", "length: 0.05, width: 0.005", "length: 7, width: 0.3"):
            self.write("sized.yaml", STRIP.replace("length: 1, width: 0.1", size))
            _, groups = self.pattern("sized.yaml", "--set", "gravity=[0, 0, -1e-4]")
            path = groups["scale"].find(f"{SVG}path").get("d").replace("M", "").split("V")
            start, end = float(path[0].split()[0]), float(path[1].split("H")[1])
            self.assertEqual(groups["scale"].find(f"{SVG}text").text, f"{end - start:g} mm")

    def test_a_loop_says_how_its_ends_meet(self):
        for scene, says in (("moebius", "after 1 half turn, "), ("ring", "without a turn")):
            _, groups = self.pattern(scene)
            self.assertIn(f"join the ends {says}", groups["legend"].find(f"{SVG}text").text)


if __name__ == "__main__":
    main()
