"""wunderlich compare: models side by side on one scene."""

import csv
import json

from program import STRIP, ProgramTest, main

SMALL = ["--set", "compare.length_tolerance=1e-3",  # at 1 % a shell goes on jerking
         "--set", "compare.shell_conforming={along: 10, across: 3}",
         "--set", "compare.shell_nonconforming={along: 10, across: 3}"]
MODELS = ["ribbon", "rod", "shell-conforming", "shell-nonconforming"]


class Compare(ProgramTest):
    def table(self, folder):
        with open(self.folder / folder / "comparison.csv", encoding="utf-8") as file:
            return {row["model"]: row for row in csv.DictReader(file)}

    def test_all_models_bend_a_heavy_strip_alike(self):
        # Bending without twist: the models are of one mind but for their resolution.
        self.expect(0, "compare", "strip.yaml", *SMALL, "--out", "there")
        rows = self.table("there")
        self.assertEqual(list(rows), MODELS)
        ribbon = float(rows["ribbon"]["normalized"])
        self.assertGreater(ribbon, 0)
        for model, tolerance in (("rod", 0.15), ("shell-conforming", 0.25)):  # the other shell is softer: docs/baselines.md
            self.assertAlmostEqual(float(rows[model]["normalized"]) / ribbon, 1, delta=tolerance, msg=model)
        # The weight of 0.1 N hangs below the clamp by q l^4/(8 D) = 1/8 m at the end, 1/20 m in the mean, were it a beam.
        for model in MODELS[:3]:
            self.assertAlmostEqual(float(rows[model]["gravity"]) / -0.005, 1, delta=0.25, msg=model)
        self.assertLess(abs(float(rows["ribbon"]["area_error"])), 1e-10)
        self.assertLess(abs(float(rows["ribbon"]["diagonal_strain"])), 1e-10)
        for model in MODELS:  # a small net force, but some
            self.assertGreater(float(rows[model]["imbalance"]), 0, msg=model)
            self.assertLess(float(rows[model]["imbalance"]), 1e-4, msg=model)
        data = json.loads((self.folder / "there/comparison.json").read_text())
        self.assertEqual([model["model"] for model in data["models"]], MODELS)
        page = (self.folder / "there/report.html").read_text()
        self.assertIn("shell-nonconforming", page)
        for model in MODELS:
            self.assertIn("\nf ", (self.folder / f"there/{model}.obj").read_text())

    def test_some_models_in_the_order_asked_for(self):
        self.expect(0, "compare", "strip.yaml", "--models", "rod,ribbon", "--out", "there", "--quiet")
        self.assertEqual(list(self.table("there")), ["rod", "ribbon"])

    def test_a_motion_is_compared_in_time(self):
        self.write("fall.yaml", STRIP.replace("{method: equilibrium}",
                                              "{method: implicit, time_step: 2e-3, duration: 0.02}"))
        self.expect(0, "compare", "fall.yaml", *SMALL, "--out", "there")
        for model, row in self.table("there").items():
            self.assertAlmostEqual(float(row["moved_seconds"]), 0.02, msg=model)
            self.assertEqual(int(row["steps"]), 10, model)
            self.assertGreater(float(row["kinetic"]), 0, model)
            self.assertEqual(row["imbalance"], "", model)  # it does not say that it is at rest

    def test_models_hang_straight_and_rest(self):
        # Flat, with no elastic energy but for rounding; the weight of 0.1 N is half a metre below the clamp in the mean.
        self.write("hanging.yaml", STRIP.replace("at: start", "at: start\n    tangent: [0, 0, -1]\n    normal: [1, 0, 0]"))
        self.expect(0, "compare", "hanging.yaml", *SMALL, "--out", "there")
        for model, row in self.table("there").items():
            self.assertAlmostEqual(float(row["gravity"]), -0.05, delta=1e-6, msg=model)
            self.assertAlmostEqual(float(row["normalized"]), 0, delta=1e-6, msg=model)  # the rod stretches
            self.assertLess(float(row["imbalance"]), 1e-4, model)

    def test_a_model_that_cannot_do_the_scene_says_so(self):
        result = self.expect(3, "compare", "ring", "--models", "ribbon,shell-conforming", "--out", "there")
        self.assertIn("shell-conforming: did not converge", result.stderr)
        self.assertIn("open strips", result.stderr)
        row = self.table("there")["shell-conforming"]
        self.assertEqual((row["converged"], row["unknowns"], row["steps"]), ("0", str(3 * 36 * 12), ""))
        self.assertGreater(int(row["constraints"]), 0)

    def rows(self, text, *settings, models="ribbon,rod"):
        """The table of a scene, and what the program said of it."""
        self.write("scene.yaml", text)
        result = self.expect(0, "compare", "scene.yaml", "--models", models, *settings, "--out", "there", "--quiet")
        return self.table("there"), result.stderr

    def ends(self, model):
        """Middles of the first and the last column of points of the surface that was written."""
        text = (self.folder / f"there/{model}.obj").read_text()
        points = [tuple(map(float, line.split()[1:4])) for line in text.splitlines() if line.startswith("v ")]
        across = 9  # points
        return [[sum(point[c] for point in column) / across for c in range(3)]
                for column in (points[:across], points[-across:])]

    def test_the_rod_goes_where_clamps_are(self):
        moved = STRIP.replace("- at: start", "- {at: start, position: [1, 1, 1], tangent: [0, 1, 0]}")
        here, _ = self.rows(STRIP, models="rod")
        there, _ = self.rows(moved, models="rod")
        self.assertAlmostEqual(float(there["rod"]["normalized"]) / float(here["rod"]["normalized"]), 1, delta=1e-6)
        for got, want in zip(self.ends("rod")[0], (1, 1, 1)):
            self.assertAlmostEqual(got, want, delta=1e-6)

    def test_the_rod_is_brought_to_clamps_nearer_than_its_length(self):
        rows, _ = self.rows("ribbon: {length: 1, width: 0.1, segments: 20}\n"
                            "clamps: [{at: start}, {at: end, position: [0.6, 0, 0]}]\n"
                            "solver: {method: equilibrium}\n")
        ratio = float(rows["rod"]["normalized"]) / float(rows["ribbon"]["normalized"])
        self.assertAlmostEqual(ratio, 1, delta=0.08)  # its free length is shorter by an edge in twenty
        first, last = self.ends("rod")
        self.assertAlmostEqual(last[0] - first[0], 0.6, delta=1e-6)

    def test_the_rod_bends_under_a_wrench_that_turns_with_its_end(self):
        # The ribbon's energy in closed form, kappa^2 (1 + eta^2)^2/2 with kappa = 4, eta = 3/4; the rod's by Kirchhoff's equations (test_baseline).
        self.expect(0, "compare", "helix", "--models", "ribbon,rod", "--out", "there", "--quiet")
        rows = self.table("there")
        self.assertAlmostEqual(float(rows["ribbon"]["normalized"]), 0.5 * 16 * (1 + 9 / 16) ** 2, delta=0.01)
        self.assertAlmostEqual(float(rows["rod"]["normalized"]), 53.6, delta=0.6)
        self.assertLess(float(rows["rod"]["iterations_mean"]), 15)
        for row in rows.values():
            self.assertLess(float(row["imbalance"]), 1e-6)

    def test_the_rod_on_pins_and_with_edges_of_its_own(self):
        pinned = ("ribbon: {length: 1, width: 0.1, segments: 12}\n"
                  "clamps: [{at: start}]\npins: [{at: end, free: [x]}]\n"
                  "gravity: [0, 0, -1]\nsolver: {method: equilibrium}\n")
        energies = []
        for edges in (12, 36):
            rows, _ = self.rows(pinned, "--set", f"compare.rod.segments={edges}")
            self.assertEqual(rows["rod"]["unknowns"], str(4 * edges + 3))
            self.assertAlmostEqual(self.ends("rod")[1][2], 0, delta=1e-6)
            energies.append(float(rows["rod"]["normalized"]) / float(rows["ribbon"]["normalized"]))
        self.assertAlmostEqual(energies[1], 1, delta=0.15)
        self.assertLess(abs(energies[1] - 1), abs(energies[0] - 1))

    def test_the_rod_says_where_supports_are_on_edges_of_its_own(self):
        inside = ("ribbon: {length: 1, width: 0.1, segments: 12}\n"
                  "clamps: [{at: start}]\npins: [{at: {node: 3}}]\nsolver: {method: equilibrium}\n")
        _, said = self.rows(inside, "--set", "compare.rod.segments=24", models="rod")
        self.assertNotIn("note:", said)
        _, said = self.rows(inside.replace("{node: 3}", "{node: 3}, position: [0.2, 0, 0]"),
                            "--set", "compare.rod.segments=10", models="rod")
        self.assertIn("up to 0.05 m from their places", said)
        result = self.call("compare", "scene.yaml", "--models", "rod", "--set", "compare.rod.segments=2", "--out", "few")
        self.assertEqual(result.returncode, 3)
        self.assertIn("fall on one of its own", result.stderr)

    def test_a_shell_says_where_supports_are_on_points_of_its_own(self):
        pins = ("ribbon: {length: 1, width: 0.1, segments: 12}\n"
                "clamps: [{at: start}]\npins: [{at: {node: 6}}, {at: {node: 7}}]\n"
                "solver: {method: implicit, duration: 0.01}\n")
        self.write("pins.yaml", pins)
        coarse = ["--models", "shell-conforming", "--set", "compare.shell_conforming={along: 5, across: 3}"]
        result = self.expect(3, "compare", "pins.yaml", *coarse, "--out", "few")
        self.assertIn("two supports hold one point of the mesh: choose compare.shell_conforming.along", result.stderr)
        self.write("pins.yaml", pins.replace("{node: 6}", "{node: 3}"))
        result = self.call("compare", "pins.yaml", *coarse, "--out", "few")
        self.assertIn(f"up to {1 / 12:.2g} m from their places", result.stderr)

    def test_the_rod_says_what_it_leaves_out(self):
        lying = ("ribbon: {length: 0.3, width: 0.03, segments: 10, bending_stiffness: 3e-3, area_density: 0.1}\n"
                 "gravity: [0, 0, -9.81]\n"
                 "obstacles: [{shape: plane, position: [0, 0, -0.01]}]\n"
                 "contact: {friction: FRICTION, self: SELF}\n"
                 "solver: {method: implicit, duration: 0.1, time_step: 2e-3, damping: {normal: 20, tangent: 20}}\n")
        _, said = self.rows(lying.replace("FRICTION", "0").replace("SELF", "false"), models="rod")
        self.assertNotIn("note: rod", said)
        for z in [end[2] for end in self.ends("rod")]:  # it fell, and the plane holds it
            self.assertGreater(z, -0.01)
            self.assertLess(z, -0.008)
        _, said = self.rows(lying.replace("FRICTION", "0.5").replace("SELF", "true"), models="rod")
        self.assertIn("note: rod: friction is not modelled", said)
        self.assertIn("note: rod: the rod does not feel itself", said)

    def test_only_what_a_comparison_wrote_is_replaced(self):
        again = ("compare", "strip.yaml", "--models", "rod", "--out", "there", "--quiet")
        self.expect(0, *again)
        self.expect(0, *again)
        for name in ("mine.obj", "ribbon.obj"):  # the second: a name of a model that was not there
            mine = self.write(f"there/{name}", "v 0 0 0\n")
            self.expect_refused(*again, says="not written by wunderlich")
            mine.unlink()

    def test_bad_input(self):
        self.expect_refused("compare", "strip.yaml", "--models", "rood", says=["rood", "rod"])
        self.expect_refused("compare", "strip.yaml", "--models", "rod,rod", says="twice")
        self.expect_refused("compare", "strip.yaml", "--models", "", says="--models")
        self.expect_refused("compare", "paper-chain", says="several")
        self.expect_refused("compare", "strip.yaml", "--set", "compare.rod.stiffness=real", says=["real", "physical"])
        self.expect(0, "run", "strip.yaml", "--out", "run", "--formats", "none", "--quiet")
        self.expect_refused("compare", "strip.yaml", "--out", "run", says="not written by wunderlich")


if __name__ == "__main__":
    main()
