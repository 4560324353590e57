"""The paper's figures, quickly, and that their checks notice a program that computes something else."""

import json
import subprocess
import sys
from pathlib import Path

from program import PROGRAM, ProgramTest, main

RUN = Path(__file__).resolve().parents[2] / "validation" / "run.py"


class Validation(ProgramTest):
    def validate(self, *arguments, program=PROGRAM):
        """The exit code, what was printed, and the failed quantities by claim."""
        out = self.folder / "validation"
        result = subprocess.run([sys.executable, "-B", RUN, "--quick", "--no-figures", "--program", program, "--out", out,
                                 *arguments], capture_output=True, text=True, timeout=280, check=False)
        table = out / "results.json"
        rows = json.loads(table.read_text(encoding="utf-8")) if table.exists() else {}
        failed = {claim: [row["quantity"] for row in found if not row["ok"]] for claim, found in rows.items()}
        return result.returncode, result.stdout + result.stderr, failed

    def wrapped(self, words):
        """A program that adds `words` to what it is asked."""
        script = self.write("other", f'#!/bin/sh\nexec "{PROGRAM}" "$@" {words}\n')
        script.chmod(0o755)
        return script

    def test_every_claim_holds(self):
        code, printed, failed = self.validate()
        self.assertEqual(code, 0, printed)
        self.assertEqual(set(failed), {"facets", "area", "dynamics-alpha", "moebius-profile", "loop", "coil", "drape",
                                       "belts", "models", "taylor"})

    def test_a_softer_coupling_is_noticed(self):
        code, printed, failed = self.validate("area", program=self.wrapped("--set solver.weight_scale=0.1"))
        self.assertGreater(code, 0, printed)
        self.assertTrue(any("area error" in name for name in failed["area"]), printed)

    def test_another_aspect_is_noticed(self):
        code, printed, failed = self.validate("moebius-profile", program=self.wrapped("--set ribbon.aspect=4pi"))
        self.assertGreater(code, 4, printed)
        for what in ("kappa", "tau", "energy"):
            self.assertTrue(any(what in name for name in failed["moebius-profile"]), printed)

    def test_a_program_that_fails_fails_the_claims(self):
        code, printed, failed = self.validate("area", "taylor", program="/bin/false")
        self.assertEqual(code, 2, printed)
        self.assertEqual(failed, {"area": ["ran to its end"], "taylor": ["ran to its end"]})

    def test_an_unknown_claim_is_refused(self):
        code, printed, _ = self.validate("nix")
        self.assertEqual(code, 2)
        self.assertIn("no claim 'nix'", printed)


if __name__ == "__main__":
    main()
