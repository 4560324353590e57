"""Bodies to print: read by programs that are not ours (admesh, Python's zip and XML readers)."""

import re
import struct
import subprocess
import xml.etree.ElementTree as ElementTree
import zipfile
from collections import Counter

from program import ProgramTest, main

SCENES = {"cantilever": 1, "ring": 1, "moebius": 1, "paper-chain": 3}  # and how many strips they have
FAULTS = ("Facets with 1 disconnected edge", "Facets with 2 disconnected edges", "Facets with 3 disconnected edges",
          "Degenerate facets", "Edges fixed", "Facets reversed", "Backwards edges", "Normals fixed")
CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"


def admesh(path):
    """What admesh finds: edges must match bit for bit, directions and normals are checked and nothing is repaired."""
    text = subprocess.run(["admesh", "--exact", "--normal-directions", "--normal-values", path], capture_output=True,
                          text=True, check=True).stdout
    found = {name: int(re.search(rf"^{name}\s*:\s*(-?\d+)", text, re.M).group(1)) for name in FAULTS}
    parts = int(re.search(r"Number of parts\s*:\s*(\d+)", text).group(1))
    volume = float(re.search(r"Volume\s*:\s*(\S+)", text).group(1))
    return {name: count for name, count in found.items() if count}, parts, volume


def area_of_pattern(folder):
    """Length times width of every strip [mm^2], from the legends of the patterns."""
    sizes = [re.search(r"([\d.]+) × ([\d.]+) mm", path.read_text()).groups() for path in folder.glob("pattern*.svg")]
    return sum(float(length) * float(width) for length, width in sizes)


class Solids(ProgramTest):
    def run_scene(self, scene):
        short = ["--set", "solver.duration=0.02"] if scene == "paper-chain" else []
        self.expect(0, "run", scene, "--out", scene, "--formats", "svg", "--quiet", "--set", "output.frames=2", *short)
        return self.folder / scene

    def test_stl_is_watertight(self):
        for scene, strips in SCENES.items():
            with self.subTest(scene):
                folder = self.run_scene(scene)
                self.expect(0, "export", scene, "--to", "stl", "--thickness", "0.002")
                faults, parts, volume = admesh(folder / "ribbon.stl")
                self.assertEqual(faults, {})
                self.assertEqual(parts, strips)
                self.assertAlmostEqual(volume / (2 * area_of_pattern(folder)), 1, delta=0.01)

    def test_admesh_would_have_seen_a_hole(self):
        folder = self.run_scene("ring")
        self.expect(0, "export", "ring", "--to", "stl")
        whole = (folder / "ribbon.stl").read_bytes()
        count = struct.unpack("<I", whole[80:84])[0]
        holed = self.write("holed.stl", whole[:80] + struct.pack("<I", count - 1) + whole[84:-50])
        self.assertIn("Facets with 1 disconnected edge", admesh(holed)[0])

    def test_3mf_holds_closed_meshes_in_millimetres(self):
        for scene, strips in SCENES.items():
            with self.subTest(scene):
                folder = self.run_scene(scene)
                self.expect(0, "export", scene, "--to", "3mf", "--thickness", "0.002")
                with zipfile.ZipFile(folder / "ribbon.3mf") as archive:
                    self.assertIsNone(archive.testzip())
                    self.assertEqual(archive.namelist(), ["[Content_Types].xml", "_rels/.rels", "3D/3dmodel.model"])
                    for name in archive.namelist():
                        root = ElementTree.fromstring(archive.read(name))
                self.assertEqual(root.get("unit"), "millimeter")
                objects = {item.get("id"): item for item in root.iter(f"{CORE}object")}
                self.assertEqual([item.get("objectid") for item in root.iter(f"{CORE}item")], list(objects))
                self.assertEqual(len(objects), strips)
                volume = 0
                for body in objects.values():
                    points = [[float(v.get(k)) for k in "xyz"] for v in body.iter(f"{CORE}vertex")]
                    triangles = [[int(t.get(k)) for k in ("v1", "v2", "v3")] for t in body.iter(f"{CORE}triangle")]
                    edges = Counter((t[k], t[(k + 1) % 3]) for t in triangles for k in range(3))
                    self.assertEqual(set(edges.values()), {1})
                    self.assertEqual({(b, a) for a, b in edges}, set(edges))
                    for a, b, c in ([points[i] for i in t] for t in triangles):
                        volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                                   + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
                self.assertAlmostEqual(volume / (2 * area_of_pattern(folder)), 1, delta=0.01)

    def test_thickness_comes_from_the_material_else_from_the_width(self):
        for name, material, expected in (("plain", [], 0.1 / 50),
                                         ("film", ["--set", "ribbon.young_modulus=1e6", "--set", "ribbon.thickness=0.004"],
                                          0.004)):
            self.expect(0, "run", "strip.yaml", "--out", name, "--formats", "stl", "--quiet", *material)
            self.assertAlmostEqual(admesh(self.folder / name / "ribbon.stl")[2], 1e9 * 1 * 0.1 * expected,
                                   delta=1e7 * 0.1 * expected)
        self.expect(0, "run", "strip.yaml", "--out", "block", "--formats", "stl", "--quiet", "--set", "ribbon.young_modulus=1",
                    "--set", "ribbon.thickness=0.5")
        self.assertAlmostEqual(admesh(self.folder / "block" / "ribbon.stl")[2], 1e9 * 1 * 0.1 * 0.1 / 50, delta=2e4)

    def test_refuses_a_thickness_that_makes_no_body(self):
        self.expect(0, "run", "strip.yaml", "--out", "run", "--formats", "none", "--quiet")
        for thickness in ("0", "-1", "nan", "inf", "0.11", "1e-7", "1e-300"):
            self.expect_refused("export", "run", "--to", "stl", f"--thickness={thickness}", says=["--thickness", "0.1 m"])
        self.expect_refused("export", "run", "--to", "glb", "--thickness", "0.001", says="stl, 3mf and obj")
        self.expect_refused("export", "run", "--to", "stl", "--thickness", "thin", says="--thickness")


if __name__ == "__main__":
    main()
