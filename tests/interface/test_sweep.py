"""wunderlich sweep: many runs, resumable, with one table at the end."""

import csv
import html
import json
import os
import random
import shlex
import signal
import struct
import subprocess
import time

from program import PROGRAM, SCENES, ProgramTest, main

SWEEP = """\
title: Heavier and heavier
scene: strip.yaml
axes:
  - {name: width, key: ribbon.width, linear: {from: 0.05, to: 0.1, count: WIDTHS}}
  - {name: weight, key: gravity, values: ["[0,0,-1]", "[0,0,-2]", "[0,0,-4]", "[0,0,-8]"]}
collect:
  energy: energy.normalized
  largest_curvature: shape.max_kappa
  clamp_force: ends.0.force.2
  zeros: kappa_zeros.count
  seconds: timing.wall_seconds
fields: [kappa]
timeout: 60
"""
RUNS = int(os.environ.get("WUNDERLICH_SWEEP_RUNS", "400"))
KILLS = int(os.environ.get("WUNDERLICH_SWEEP_KILLS", "8"))
TIMING = 2  # columns at the end that the clock decides


def resident_kb(process):
    """Resident memory, or None if the process is gone."""
    try:
        with open(f"/proc/{process}/status", encoding="utf-8") as file:
            return next((int(line.split()[1]) for line in file if line.startswith("VmRSS")), None)
    except OSError:
        return None


def children_of(process):
    try:
        with open(f"/proc/{process}/task/{process}/children", encoding="utf-8") as file:
            return file.read().split()
    except OSError:
        return []


class Sweep(ProgramTest):
    def sweep(self, widths=5, extra=""):
        return self.write("sweep.yaml", SWEEP.replace("WIDTHS", str(widths)) + extra)

    def table(self, folder="there"):
        with open(self.folder / folder / "table.csv", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def table_text(self, folder):
        """The table without its timing columns."""
        lines = (self.folder / folder / "table.csv").read_text().splitlines()
        return [",".join(line.split(",")[:-TIMING]) for line in lines]

    def test_runs_all_and_collects(self):
        self.sweep()
        result = self.expect(0, "sweep", "sweep.yaml", "--out", "there", "--jobs", "2")
        self.assertIn("20 runs", result.stdout)
        rows = self.table()
        self.assertEqual(len(rows), 20)
        self.assertEqual({row["status"] for row in rows}, {"done"})
        self.assertEqual([row["run"] for row in rows], [str(i) for i in range(20)])
        # The figures are those of the same run by itself.
        one = rows[7]
        self.expect(0, "run", "strip.yaml", "--set", f"ribbon.width={one['width']}", "--set", f"gravity={one['weight']}",
                    "--out", "one", "--formats", "none", "--quiet")
        summary = json.loads((self.folder / "one/summary.json").read_text())
        self.assertEqual(float(one["energy"]), summary["energy"]["normalized"])
        self.assertEqual(float(one["clamp_force"]), summary["ends"][0]["force"][2])
        detail = (self.folder / "there/runs.html").read_text().split(f'<h2 id="{one["key"]}">')[1].split("</pre>")[0]
        command = next(line for line in detail.splitlines() if "wunderlich run" in line)
        again = shlex.split(html.unescape(command[command.index("wunderlich"):]))[1:]
        subprocess.run([PROGRAM, *again, "--out", "again", "--formats", "none", "--quiet"], cwd=self.folder / "there", check=True)
        self.assertEqual(json.loads((self.folder / "there/again/summary.json").read_text())["energy"], summary["energy"])
        self.assertEqual(json.loads(detail.splitlines()[-1])["summary"]["energy"], summary["energy"])
        page = (self.folder / "there/report.html").read_text()
        self.assertIn(one["key"], page)

    def test_fields_are_numpy_arrays(self):
        self.sweep(2)
        self.expect(0, "sweep", "sweep.yaml", "--out", "there", "--quiet")
        content = (self.folder / "there/kappa.npy").read_bytes()
        self.assertEqual(content[:8], b"\x93NUMPY\x01\x00")
        length = struct.unpack("<H", content[8:10])[0]
        self.assertEqual((10 + length) % 64, 0)
        self.assertIn(b"'shape': (8, 13)", content[:10 + length])
        values = struct.unpack("<104d", content[10 + length:])
        self.assertAlmostEqual(max(abs(v) for v in values[:13]), float(self.table()[0]["largest_curvature"]), delta=1e-15)

    def test_killed_anywhere_it_goes_on_and_ends_the_same(self):
        self.sweep(RUNS // 4)
        dice = random.Random(4)
        start = time.monotonic()
        self.expect(0, "sweep", "sweep.yaml", "--out", "whole", "--quiet")
        whole = time.monotonic() - start
        for _ in range(KILLS):
            process = subprocess.Popen([PROGRAM, "sweep", "sweep.yaml", "--out", "cut", "--quiet"], cwd=self.folder)
            time.sleep(dice.uniform(0.01, 1.8 * whole / KILLS))
            process.send_signal(signal.SIGKILL)
            process.wait()
        self.expect(0, "sweep", "sweep.yaml", "--out", "cut", "--quiet")
        self.assertEqual(self.table_text("cut"), self.table_text("whole"))
        self.assertEqual((self.folder / "cut/kappa.npy").read_bytes(), (self.folder / "whole/kappa.npy").read_bytes())
        lines = (self.folder / "cut/results/all.log").read_text().splitlines()
        keys = [line.split("\t")[1] for line in lines]
        self.assertEqual(len(keys), len(set(keys)), "a run was done twice")

    def test_memory_does_not_grow(self):
        self.sweep(max(1000, RUNS // 4))
        process = subprocess.Popen([PROGRAM, "sweep", "sweep.yaml", "--out", "there", "--quiet", "--jobs", "1",
                                    "--shard", "1/2"], cwd=self.folder)  # of a shard no page is made at the end
        sizes = []
        while process.poll() is None:
            worker = children_of(process.pid)
            sizes.append((resident_kb(process.pid), resident_kb(worker[0]) if worker else None))
            time.sleep(0.05)
        self.assertEqual(process.returncode, 0)
        for who in (0, 1):
            seen = [size[who] for size in sizes if size[who]]
            quarter = seen[len(seen) // 4:-1]  # the first runs make what later ones use again
            self.assertGreater(len(quarter), 4)
            self.assertLess(max(quarter) - min(quarter), 400, f"kB, {'worker' if who else 'parent'}: {seen}")

    def test_shards_make_the_same_table(self):
        self.sweep()
        self.expect(0, "sweep", "sweep.yaml", "--out", "whole", "--quiet")
        for shard in ("2/3", "1/3"):
            self.expect(0, "sweep", "sweep.yaml", "--out", "parts", "--shard", shard, "--quiet")
        self.assertIn("14 of 20", self.expect(0, "sweep", "status", "parts").stdout)
        self.expect(0, "sweep", "collect", "parts")
        self.assertEqual(sum(row["status"] == "" for row in self.table("parts")), 6)
        self.expect(0, "sweep", "sweep.yaml", "--out", "parts", "--shard", "3/3", "--quiet")
        self.expect(0, "sweep", "collect", "parts")
        self.assertEqual(self.table_text("parts"), self.table_text("whole"))

    def test_a_run_that_hangs_or_is_refused_is_recorded_and_the_rest_goes_on(self):
        self.sweep(1, "set: {output.frames: 2}\n")
        text = (self.folder / "sweep.yaml").read_text().replace(
            'values: ["[0,0,-1]", "[0,0,-2]", "[0,0,-4]", "[0,0,-8]"]', 'values: ["[0,0,-1]", "[0,0,-2]"]')
        text = text.replace("timeout: 60", "timeout: 0.5").replace("collect:", "  - {key: ribbon.segments, values: [12, 500000]}\ncollect:")
        self.write("sweep.yaml", text)
        self.expect(0, "sweep", "sweep.yaml", "--out", "there", "--quiet")
        rows = self.table()
        self.assertEqual([row["status"] for row in rows], ["done", "timed-out", "done", "timed-out"])
        self.assertIn("0.5 s", rows[1]["reason"])
        self.assertEqual(rows[1]["energy"], "")

    def test_interrupted_it_says_so_and_can_go_on(self):
        self.sweep(400)
        process = subprocess.Popen([PROGRAM, "sweep", "sweep.yaml", "--out", "there"], cwd=self.folder,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        _, error = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 130)
        self.assertIn("the same command goes on", error)
        self.expect(0, "sweep", "status", "there")

    def test_shards_may_start_at_once_and_be_killed_while_they_do(self):
        self.sweep(20)
        # As a process leaves it that is killed between any two of its first steps.
        (self.folder / "parts").mkdir()
        self.write("parts/.resolved-sweep.yaml.partial-1", "half of it")
        self.write("parts/resolved-scene.yaml", "half of it")
        for name in ("parts", "fresh"):
            shards = [subprocess.Popen([PROGRAM, "sweep", "sweep.yaml", "--out", name, "--shard", f"{i}/4", "--quiet"],
                                       cwd=self.folder) for i in range(1, 5)]
            self.assertEqual([shard.wait() for shard in shards], [0, 0, 0, 0], name)
            self.expect(0, "sweep", "collect", name)
            self.assertEqual({row["status"] for row in self.table(name)}, {"done"})

    def test_nothing_of_the_users_is_overwritten(self):
        self.sweep(2)
        self.expect_refused("sweep", "sweep.yaml", "--out", ".", says="no folder of a sweep")

    def test_equal_values_are_run_once(self):
        self.write("sweep.yaml", SWEEP.replace("linear: {from: 0.05, to: 0.1, count: WIDTHS}", "values: [0.1, 0.1, 0.1]"))
        self.expect(0, "sweep", "sweep.yaml", "--out", "there", "--quiet")
        self.assertEqual(len((self.folder / "there/results/all.log").read_text().splitlines()), 4)
        self.assertEqual(len(self.table()), 12)
        self.assertEqual({row["status"] for row in self.table()}, {"done"})

    def test_what_keep_asks_for_is_there_and_linked(self):
        self.sweep(1)
        self.expect(0, "sweep", "sweep.yaml", "--out", "there", "--quiet")
        self.sweep(1, "keep: [html]\n")
        self.expect(0, "sweep", "sweep.yaml", "--out", "there", "--quiet")
        for row in self.table():
            self.assertTrue((self.folder / f"there/runs/{row['key']}/report.html").exists())

    def test_the_slurm_script_is_plain(self):
        self.sweep(40)
        result = self.call("sweep", "sweep.yaml", "--out", "there", "--engine", "slurm", "--shards", "4", "--walltime",
                           "1:00:00", "--partition", "short", "--jobs", "2", "--sbatch=--mem=1G")
        script = (self.folder / "there/slurm/job.sh").read_text()
        for line in ("--array=1-4", "--time=1:00:00", "--partition=short", "--cpus-per-task=2", "--requeue", "--mem=1G"):
            self.assertIn(f"#SBATCH {line}", script)
        self.assertIn('--shard "$SLURM_ARRAY_TASK_ID/4"', script)
        if result.returncode == 2:  # as everywhere without Slurm
            self.assertIn("sbatch", result.stderr)

    def test_shipped_sweeps_can_be_run(self):
        for path in sorted((SCENES.parent / "sweeps").glob("*.yaml")):
            self.expect(0, "sweep", path, "--out", path.stem, "--shard", "1/400", "--quiet")
            self.expect(0, "sweep", "collect", path.stem)
            self.assertEqual(self.table(path.stem)[0]["status"], "done", path)

    def test_bad_input(self):
        self.sweep()
        self.expect_refused("sweep", "nowhere.yaml", says="nowhere.yaml")
        self.expect_refused("sweep", says="sweep")
        self.expect_refused("sweep", "strip.yaml", "--out", "there", says=["strip.yaml:2", "unknown key"])
        for shard in ("0/3", "4/3", "x", "1/3x"):
            self.expect_refused("sweep", "sweep.yaml", "--shard", shard, says="--shard")
        self.expect_refused("sweep", "sweep.yaml", "--engine", "cloud", says="local or slurm")
        self.expect_refused("sweep", "status", "nowhere", says="nowhere")
        (self.folder / "full").mkdir()
        self.write("full/mine.txt", "mine")
        self.expect_refused("sweep", "sweep.yaml", "--out", "full", says="full")
        self.write("bad.yaml", SWEEP.replace("WIDTHS", "3").replace("energy.normalized", "energy.normalised"))
        self.expect_refused("sweep", "bad.yaml", "--out", "there", says=["bad.yaml:7", "energy.normalized"])


if __name__ == "__main__":
    main()
