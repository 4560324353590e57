"""The JSON Schema of scenes: accepts what is shipped, refuses what the reader refuses; by the library of the distribution."""

import json

import jsonschema
import yaml

from program import SCENES, STRIP, ProgramTest, main

PAGE = SCENES.parent / "docs/scene.schema.json"

# Wrong scenes that a schema can tell, each refused by the program as well: a change to STRIP, and where it is wrong.
WRONG = [
    ("gravity: [0, 0, -1]", "gravity: [0, 0]", ["gravity"]),
    ("gravity: [0, 0, -1]", "gravity: [0, 0, down]", ["gravity", 2]),
    ("gravity: [0, 0, -1]", "gravity: [0, 0, -1.0e+7]", ["gravity", 2]),
    ("gravity:", "gravitation:", []),
    ("ribbon: {length: 1, width: 0.1, segments: 12}", "", []),
    ("length: 1,", "", ["ribbon"]),
    ("length: 1,", "length: -1.0,", ["ribbon", "length"]),
    ("length: 1,", "length: 2 3,", ["ribbon", "length"]),
    ("segments: 12", "segments: 12.5", ["ribbon", "segments"]),
    ("segments: 12", "segments: 1", ["ribbon", "segments"]),
    ("segments: 12", "segments: 12, closure: shut", ["ribbon", "closure"]),
    ("segments: 12", "segments: 12, free_rulings: 1", ["ribbon", "free_rulings"]),
    ("at: start", "at: middle", ["clamps", 0, "at"]),
    ("at: start", "at: {node: 0, u: 0}", ["clamps", 0, "at"]),
    ("at: start", "turn: 0", ["clamps", 0]),
    ("at: start", "at: start\n    free: [x, w]", ["clamps", 0, "free", 1]),
    ("solver: {method: equilibrium}", "solver: [equilibrium]", ["solver"]),
    ("solver: {method: equilibrium}", "ribbons: [{length: 1, width: 1}]", []),
    ("title: A strip for tests", "title: [A, strip]", ["title"]),
]

# And right ones.
RIGHT = [
    ("length: 1,", "length: 5*pi/4,"),
    ("length: 1,", "length: 2pi,"),
    ("length: 1,", "length: 5/2 pi,"),
    ("length: 1,", "length: 1e0,"),
    ("at: start", "at: {node: 0}"),
    ("at: start", "at: {u: 0}"),
    ("title: A strip for tests", "title: 5"),
]


class Schema(ProgramTest):
    def setUp(self):
        super().setUp()
        self.schema = json.loads(self.expect(0, "schema", "--json").stdout)
        self.validator = jsonschema.Draft7Validator(self.schema)

    def faults(self, text):
        return list(self.validator.iter_errors(yaml.safe_load(text)))

    def test_it_is_a_schema(self):
        jsonschema.Draft7Validator.check_schema(self.schema)

    def test_the_file_in_docs_is_up_to_date(self):
        self.assertEqual(PAGE.read_text(encoding="utf-8"), self.expect(0, "schema", "--json").stdout,
                         "write it anew with: build/release/wunderlich schema --json > docs/scene.schema.json")

    def test_every_shipped_scene_is_valid(self):
        scenes = sorted(SCENES.glob("*.yaml"))
        self.assertGreater(len(scenes), 20)
        for scene in scenes:
            with self.subTest(scene.name):
                self.assertEqual(self.faults(scene.read_text(encoding="utf-8")), [])

    def test_right_scenes_are_valid(self):
        for old, new in RIGHT:
            with self.subTest(new):
                text = STRIP.replace(old, new)
                self.assertNotEqual(text, STRIP)
                self.assertEqual(self.faults(text), [])
                self.write("right.yaml", text)
                self.expect(0, "check", "right.yaml")

    def test_wrong_scenes_are_not(self):
        for old, new, place in WRONG:
            with self.subTest(new or f"without {old}"):
                text = STRIP.replace(old, new)
                self.assertNotEqual(text, STRIP)
                self.assertIn(place, [list(fault.absolute_path) for fault in self.faults(text)])
                self.write("wrong.yaml", text)
                self.expect(2, "check", "wrong.yaml")


if __name__ == "__main__":
    main()
