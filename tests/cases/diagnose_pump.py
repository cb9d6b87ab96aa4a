# cost: 13
"""Requirement: the diagnosis of the rags in a pump says, from the runs in its table alone, what these decide: neither reading of the design flow explains the data; and of observables that are counted or timed it says how many repeats would tell two hypotheses apart."""
# timeout: 300
import json
import math
import shutil

import harness

CASE = harness.SOURCE_DIR / "cases/diagnose-pump"
COUNTED = """
[experiment]
name = "exits at part load"
data = "data.csv"
[[observable]]
id = "exited"
unit = "1"
kind = "event"
numerics_u = 0.0
[[point]]
id = "part_load"
case = "CASE"
set = ["boundary.0.flow_rate_L_s=14.74", "time.step_ms=0.4", "time.end_ms=2112", "time.run_on_ms=0", "rag.0.insert_time_ms=112", "flow.n_outer_correctors=1", "coupling.forces=[\\"free_stream_drag\\"]"]
role = "train"
[[alternative]]
effect = "operating_point"
meaning = "the design flow is 26.8 m3/h, not 26.8 kg/s"
[[alternative.at]]
point = "part_load"
set = ["boundary.0.flow_rate_L_s=4.094"]
[model]
candidates = ["operating_point"]
pairs = false
[budget]
max_runs = 300  # five seeds a state at one point
runs_table = "RUNS"
seed = 1
"""


class DiagnosePump(harness.CaseTest):
    def verdict(self, folder):
        run = harness.snag(["diagnose", folder / "DIAGNOSIS.toml", "--out", self.work / "out"], 1, self.work / "out")
        self.assertEqual(run.code, 0, run.tail())
        return json.loads((run.folder / "verdict.json").read_text())

    def exits(self, of):
        """Of the runs in the table at part load whose key holds `of`, by crumple."""
        lines = [line.split("\t") for line in (CASE / "runs.tsv").read_text().splitlines()]
        part_load = [line for line in lines if line[1].startswith("169d0d2974ed3137|") and of in line[1]]
        self.assertEqual(len(part_load), 5)
        return [float(line[2].split(",")[0]) for line in part_load]

    def test_verdict_from_the_table(self):
        verdict = self.verdict(CASE)
        self.assertEqual(verdict["runs"], 0)
        self.assertTrue(any("30 runs were not made for this verdict" in note for note in verdict["notes"]), verdict["notes"])
        self.assertEqual(verdict["verdict"], "outside")
        self.assertEqual(verdict["effects"], ["operating_point"])
        evidence = verdict["evidence"]["log_evidence"]
        self.assertGreater(evidence["operating_point"], 100)
        self.assertGreater(evidence["outside"], evidence["operating_point"] + 6)
        self.assertLess(evidence["geometry"], 0)
        self.assertIn("What no effect explains shows most in retention_time at point design", verdict["identifiability"]["next_experiment"])

    def test_repeats_of_what_is_counted(self):
        folder = self.work / "counted"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        # What is asked of a run is part of its key: only part load has the same in both.
        (folder / "DIAGNOSIS.toml").write_text(
            COUNTED.replace("CASE", str(CASE.parent / "pump-demo/case.toml")).replace("RUNS", str(CASE / "runs.tsv"))
        )
        (folder / "data.csv").write_text("point,replicate,t_s,observable,value,n,sd\npart_load,1,,exited,0.04,50,\n")
        verdict = self.verdict(folder)
        self.assertEqual(verdict["runs"], 0)
        base = sum(self.exits("step=1;rag")) / 5
        other = sum(self.exits("flow_rate_L_s=4.094")) / 5
        mean = 0.5 * (base + other)
        repeats = math.ceil(12 / ((base - other) ** 2 / (mean * (1 - mean))))
        self.assertIn("of exited at point part_load", verdict["identifiability"]["next_experiment"])
        self.assertIn(f"{repeats} more repeats", verdict["identifiability"]["next_experiment"])


if __name__ == "__main__":
    harness.main()
