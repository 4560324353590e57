"""Exports read by programs that are not ours: Khronos' glTF validator, VTK, and a reader of PC2 after its published layout."""

import csv
import json
import os
import struct
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from program import ProgramTest, main
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

HERE = Path(__file__).resolve().parent
MODULES = os.environ.get("WUNDERLICH_NODE_MODULES", "node_modules")

SHORT = ["--set", "output.frames=5", "--set", "solver.duration=0.05"]
KINDS = {  # a scene of each kind, how it is asked for, and how many strips it has
    "one-sided-loop": (["moebius", "--set", "output.frames=5"], 1),
    "loop": (["ring"], 1),
    "several-strips": (["paper-chain", *SHORT], 3),
    "obstacles": (["drape-cylinder", *SHORT], 1),
    "moving-obstacles": (["belt", *SHORT], 1),
    "motion": (["swing", *SHORT], 1),
}


def table(path):
    with open(path, newline="", encoding="utf-8") as file:
        return [{key: float(value) for key, value in row.items() if value} for row in csv.DictReader(file)]


class Gltf(ProgramTest):
    def validated(self, *files):
        text = subprocess.run(["node", HERE / "gltf/validate.cjs", MODULES, *files], capture_output=True, text=True,
                              timeout=60, check=True).stdout
        return json.loads(text)

    def test_the_validator_has_nothing_to_say(self):
        for kind, (arguments, _) in KINDS.items():
            self.expect(0, "run", *arguments, "--quiet", "--formats", "glb", "--out", kind)
        self.single_frame()
        kinds = [*KINDS, "single"]
        for kind, found in zip(kinds, self.validated(*(self.folder / kind / "ribbon.glb" for kind in kinds))):
            with self.subTest(kind):
                self.assertEqual(found["counts"], [0, 0, 0, 0], found["messages"])
                self.assertGreater(found["info"]["totalTriangleCount"], 0)
                self.assertEqual(found["info"]["animationCount"], 0 if kind == "single" else 1)
                self.assertEqual(found["info"]["materialCount"], 2 if kind in ("obstacles", "moving-obstacles") else 1)

    def single_frame(self):
        self.expect(3, "run", "strip.yaml", "--quiet", "--formats", "glb", "--out", "single", "--set", "solver.max_iterations=1")

    def test_the_validator_would_have_seen_a_fault(self):
        self.expect(0, "run", "strip.yaml", "--quiet", "--formats", "glb", "--out", "run")
        whole = (self.folder / "run/ribbon.glb").read_bytes()
        length = struct.unpack("<I", whole[12:16])[0]
        first_normal = json.loads(whole[20:20 + length])["bufferViews"][1]["byteOffset"]
        start = 20 + length + 8 + first_normal
        bad = self.write("bad.glb", whole[:start] + struct.pack("<3f", 2, 0, 0) + whole[start + 12:])
        self.assertGreater(self.validated(bad)[0]["counts"][0], 0)


def vertices(path):
    """Of an OBJ file."""
    lines = path.read_text(encoding="utf-8").splitlines()
    return [tuple(map(float, line.split()[1:])) for line in lines if line.startswith("v ")]


class Vtk(ProgramTest):
    def frames(self, folder, collection="ribbon.pvd"):
        """Time and surface of each frame that the collection names."""
        for entry in ElementTree.parse(folder / collection).getroot().iter("DataSet"):
            reader = vtkXMLPolyDataReader()
            reader.SetFileName(str(folder / entry.get("file")))
            reader.Update()
            self.assertEqual(reader.GetErrorCode(), 0)
            yield float(entry.get("timestep")), reader.GetOutput()

    def test_frames_points_fields_and_times(self):
        for kind, (arguments, strips) in KINDS.items():
            with self.subTest(kind):
                self.expect(0, "run", *arguments, "--quiet", "--formats", "vtp,obj", "--out", kind, "--set",
                            "output.subdivision=2", "--set", "output.across=3")
                history, nodes = table(self.folder / kind / "history.csv"), table(self.folder / kind / "centerline.csv")
                frames = list(self.frames(self.folder / kind))
                self.assertEqual([time for time, _ in frames], [row["time"] for row in history])
                segments = len(nodes) - strips
                for time, surface in frames:
                    self.assertEqual(surface.GetNumberOfPoints(), 4 * (2 * segments + strips))
                    self.assertEqual(surface.GetNumberOfPolys(), 2 * 3 * 2 * segments)
                    self.assertEqual(surface.GetFieldData().GetArray("TimeValue").GetValue(0), time)
                self.fields_are_those_of_the_nodes(frames[-1][1], nodes)
                final = vertices(self.folder / kind / "ribbon.obj")
                surface = frames[-1][1]
                for k, point in enumerate(final):
                    for a, b in zip(point, surface.GetPoint(k)):
                        self.assertAlmostEqual(a, b, delta=1e-6 * max(1, abs(a)))

    def test_solids_stand_where_the_scene_has_them(self):
        self.expect(0, "run", *KINDS["obstacles"][0], "--quiet", "--formats", "vtp", "--out", "still",
                    "--set", "obstacles=[{shape: sphere, radius: 0.02, position: [0.1, 0.2, -0.3]}]")
        (still,) = self.frames(self.folder / "still", "solids.pvd")
        for bound, expected in zip(still[1].GetBounds(), (0.08, 0.12, 0.18, 0.22, -0.32, -0.28)):
            self.assertAlmostEqual(bound, expected, delta=5e-4)
        self.expect(0, "run", *KINDS["moving-obstacles"][0], "--quiet", "--formats", "vtp", "--out", "moving")
        moving = list(self.frames(self.folder / "moving", "solids.pvd"))
        self.assertEqual([time for time, _ in moving], [time for time, _ in self.frames(self.folder / "moving")])
        self.assertNotEqual(moving[0][1].GetPoint(0), moving[-1][1].GetPoint(0))
        self.expect(0, "run", "strip.yaml", "--quiet", "--formats", "vtp", "--out", "alone")
        self.assertFalse((self.folder / "alone/solids.pvd").exists())

    def fields_are_those_of_the_nodes(self, surface, nodes):
        """Where a row of mesh points is a node's, it holds the node's values."""
        data = surface.GetPointData()
        fields = {name: data.GetArray(name) for name in ("u", "v", "kappa", "tau", "eta")}
        for array in fields.values():
            self.assertEqual(array.GetNumberOfTuples(), surface.GetNumberOfPoints())
        self.assertEqual(data.GetArray("normals").GetNumberOfComponents(), 3)
        rows, row = [], 0
        for before, node in zip([None, *nodes], nodes):
            starts = before is None or node.get("ribbon", 0) != before.get("ribbon", 0)
            row += 0 if before is None else 1 if starts else 2
            rows.append(row)
        for row, node in zip(rows, nodes):
            for name in ("u", "kappa", "tau", "eta"):
                for k in range(4 * row, 4 * row + 4):
                    self.assertAlmostEqual(fields[name].GetValue(k), node[name], delta=1e-6 * max(1, abs(node[name])))


class PointCache(ProgramTest):
    def test_frames_are_those_of_vtk_and_the_mesh_is_the_first(self):
        # POINTCACHE2: version 1, points, first frame, frames a sample, samples; then x, y, z in single precision.
        for kind, (arguments, _) in KINDS.items():
            with self.subTest(kind):
                self.expect(0, "run", *arguments, "--quiet", "--formats", "pc2,vtp", "--out", kind)
                data = (self.folder / kind / "ribbon.pc2").read_bytes()
                mark, version, points, start, rate, samples = struct.unpack("<12siiffi", data[:32])
                self.assertEqual((mark, version, start, rate), (b"POINTCACHE2\0", 1, 0, 1))
                self.assertEqual(len(data), 32 + 12 * points * samples)
                frames = list(Vtk.frames(self, self.folder / kind))
                self.assertEqual(len(frames), samples)
                rest = vertices(self.folder / kind / "ribbon_rest.obj")
                self.assertEqual(len(rest), points)
                for f, (_, surface) in enumerate(frames):
                    cache = list(struct.iter_unpack("<3f", data[32 + 12 * points * f:32 + 12 * points * (f + 1)]))
                    self.assertEqual(cache, [surface.GetPoint(k) for k in range(points)])
                    if f == 0:
                        for a, b in zip(cache, rest):
                            for x, y in zip(a, b):
                                self.assertAlmostEqual(x, y, delta=1e-6 * max(1, abs(x)))


if __name__ == "__main__":
    main()
