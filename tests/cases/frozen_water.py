# timeout: 300
# cost: 12
# processors: 3
"""Requirement: water that [initial_flow] freezes stays as it was at any rate of flow and carries rags, on any number of ranks and after a resume; a diagnosis runs such cases in memory and finds the same numbers."""
import json

import numpy

import harness
from start_from import CASE, COARSE, Water

# Goes on in [output] of the case of start_from.py.
RAG = """
rags_interval_s = 0.02
[initial_flow]
from = "steady"
frozen = true
velocity_factor = {factor}
[[rag]]
length_mm = 40
width_mm = 24
radius_mm = 2
centre_m = [0.3, 0.05, 0.05]
lengthwise = [0.6, 0.8, 0]
match_flow_velocity = true
[coupling]
mode = "{mode}"
kernel = "cell"
forces = ["published"]
[virtual_camera]
window_lower_m = [0.35, 0, 0]
window_upper_m = [0.45, 0.1, 0.1]
"""
STEPS = 10
FIELDS = {"velocity [m/s]": 1, "turbulent_kinetic_energy [m2/s2]": 2, "dissipation_rate [m2/s3]": 3, "pressure [Pa]": 2}  # and power of the factor


class FrozenWater(harness.CaseTest):
    def frozen(self, factor=1, mode="one_way", source='from = "steady"', more=""):
        text = CASE.format(mesh=self.mesh(*COARSE), end=0.02 * STEPS, more=RAG.format(factor=factor, mode=mode) + more)
        return self.case(text.replace('from = "steady"', source), f"frozen_{factor}_{mode}")

    def steady(self):
        run = self.run_once(self.case(CASE.format(mesh=self.mesh(*COARSE), end=1, more=""), "steady"), 1)
        (self.work / "steady").symlink_to(run.folder)

    def water(self, run, number):
        return Water(sorted((run.folder / "fields").glob("water_*.pvtu"))[number])

    def test_stands_at_any_rate(self):
        self.steady()
        run = {(factor, ranks): self.run_case(self.frozen(factor), ranks, out=f"by_{factor}_on_{ranks}") for factor, ranks in ((1, 1), (1, 3), (2, 1))}
        for one in run.values():
            for field in FIELDS:
                self.assertTrue(numpy.array_equal(self.water(one, 0).field[field], self.water(one, -1).field[field]), field)
        single, double = self.water(run[1, 1], 0), self.water(run[2, 1], 0)
        for field, power in FIELDS.items():
            self.assertTrue(numpy.array_equal(2**power * single.field[field], double.field[field]), field)
        way = [run[1, 1].monitor("rags").column("x")[-1] - 0.3, run[1, 3].monitor("rags").column("x")[-1] - 0.3, run[2, 1].monitor("rags").column("x")[-1] - 0.3]
        print(f"  way of the rag {way[0]:.4f} m, at twice the rate {way[2]:.4f} m")
        self.assertAlmostEqual(way[1] / way[0], 1, delta=1e-9)
        self.assertAlmostEqual(way[2] / way[0], 2, delta=0.05)  # drag of larger spheres goes with the square

    def test_resumed(self):
        self.steady()
        case = self.frozen(more="[checkpoint]\ninterval_s = 0.06\n")
        whole = self.run_case(case, 2, out="whole")
        lines = whole.monitor("rags").lines
        slots = sorted((whole.folder / "checkpoint").glob("*.h5"), key=lambda slot: slot.stat().st_mtime_ns)
        slots[-1].unlink()
        resumed = self.run_case(case, 2, "--resume", out="whole")
        self.assertIn("resumed at 0.18", resumed.stdout)
        self.assertEqual(lines, resumed.monitor("rags").lines)

    def test_refused(self):
        self.steady()
        for named, options in (("two_way", {"mode": "two_way"}), ("from", {"source": ""})):
            run = self.run_case(self.frozen(**options), 2, out="refused", code=2)
            self.assertEqual(len(run.messages), 1, run.stderr)
            for fragment in ("[initial_flow] frozen", named):
                self.assertIn(fragment, run.messages[0])

    def test_diagnosis_in_memory(self):
        """Data that are those of runs by the program: there is no gap, to round-off, at times and as means over the window."""
        self.steady()
        rows, points = ["point,replicate,t_s,observable,value"], ""
        for factor in (1, 1.5, 2):
            run = self.run_case(self.frozen(factor), 1, out=f"data_{factor}")
            rags, pictures = run.monitor("rags"), run.monitor("silhouettes")
            x, vx = rags.column("x"), rags.column("vx")
            rows += [f"{factor},1,{t:.2f},x,{v!r}" for t, v in zip(rags.column("time"), x.tolist())]
            seen = (x >= 0.35) & (x <= 0.45)
            self.assertGreater(seen.sum(), 1)
            rows += [f"{factor},1,,vx,{vx[seen].mean()!r}", f"{factor},1,,area,{pictures.column('area')[1:][seen].mean()!r}"]
            points += f"""
[[point]]
id = "{factor}"
case = "frozen_1_one_way.toml"
set = ["initial_flow.velocity_factor={factor}"]
input_u = {{ "flow.amplitude" = 0.01 }}
"""
        self.frozen(1)
        (self.work / "data.csv").write_text("\n".join(rows) + "\n")
        noise = 1e-6
        observables = "".join(f'[[observable]]\nid = "{id}"\nunit = "{unit}"\nnoise_u = {noise}\n' for id, unit in (("x", "m"), ("vx", "m/s"), ("area", "m2")))
        file = self.work / "DIAGNOSIS.toml"
        file.write_text(f'[experiment]\nname = "frozen"\ndata = "data.csv"\n{observables}{points}\n[model]\ncandidates = ["added_mass"]\n[budget]\nmax_runs = 100\n')
        run = harness.snag(["diagnose", file, "--out", self.work / "out"], 2, self.work / "out")
        self.assertEqual(run.code, 0, run.tail())
        verdict = json.loads((run.folder / "verdict.json").read_text())
        self.assertEqual(verdict["verdict"], "none", verdict)
        for cell in verdict["where"]:
            self.assertLess(abs(cell["z"]), 1e-4, cell)


if __name__ == "__main__":
    harness.main()
