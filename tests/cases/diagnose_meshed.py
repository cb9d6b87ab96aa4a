# timeout: 600
# cost: 23
"""Requirement: a diagnosis of cases with a mesh makes whole coupled runs, keeps each, names the cause that the data were made with, and goes on where it was stopped."""
import json
import shutil

import harness
from small_cases import CHANNEL

MESH = ("channel", "length_mm=300", "height_mm=100", "width_mm=100", 'cells="tetrahedra"', "size_mm=30", "wall_ratio=1")
SPEEDS = {"slow": 0.4, "middle": 0.6, "fast": 0.8, "faster": 1.0}  # m/s, as the cases say
TRUE_FACTOR = 1.25  # of the flow that the data come from
NOISE = {"x": 5e-5, "vx": 5e-3}
DIAGNOSIS = """
[experiment]
name = "channel with a mesh"
data = "data.csv"
[[observable]]
id = "x"
unit = "m"
noise_u = {x}
[[observable]]
id = "vx"
unit = "m/s"
noise_u = {vx}
{points}
[[alternative]]
effect = "geometry"
meaning = "a lower channel"
{alternatives}
[[alternative]]
effect = "inlet"
meaning = "a mesh that is not there"
set = ["mesh.file=absent.msh"]
[model]
candidates = ["operating_point", "drag_magnitude", "turbulent_dispersion", "geometry", "inlet"]
pairs = false
[budget]
max_runs = 200
"""

LOWER = tuple(argument.replace("height_mm=100", "height_mm=80") for argument in MESH)


class MeshedDiagnosis(harness.CaseTest):
    def channel(self, name, speed):
        text = CHANNEL.format(mesh=self.mesh(*MESH), kernel="gaussian").replace("1e-11", "1e-6").replace("end_s = 0.05", "end_s = 0.03").replace("1e-3\n[flow]", "2e-3\n[flow]")
        return self.case(text.replace("[0.5, 0, 0]", f"[{speed}, 0, 0]"), name)

    def prepare(self):
        rows, points, alternatives = ["point,replicate,t_s,observable,value"], "", ""
        shutil.copy(self.mesh(*LOWER), self.work / "lower.msh")
        for number, (name, speed) in enumerate(SPEEDS.items()):
            self.channel(name, speed)
            truth = self.run_case(self.channel(f"truth_{name}", TRUE_FACTOR * speed), 1, out=f"truth_{name}").monitor("rags")
            for k in range(4, 15, 5):
                for observable, noise in NOISE.items():
                    error = noise * (1, -1, 0.5, -0.7)[(number + k) % 4]  # as noise would be, the same in each run of the test
                    rows.append(f"{name},1,{truth.column('time')[k]:.3f},{observable},{float(truth.column(observable)[k] + error)!r}")
            role = "withheld" if name == "faster" else "train"
            alternatives += f'[[alternative.at]]\npoint = "{name}"\nset = ["mesh.file=lower.msh"]\n'
            points += f'[[point]]\nid = "{name}"\ncase = "{name}.toml"\nrole = "{role}"\ninput_u = {{ "flow.amplitude" = 0.01 }}\n'
        (self.work / "data.csv").write_text("\n".join(rows) + "\n")
        file = self.work / "DIAGNOSIS.toml"
        file.write_text(DIAGNOSIS.format(points=points, alternatives=alternatives, **NOISE))
        return file

    def diagnosed(self, file, ranks):
        run = harness.snag(["diagnose", file, "--out", self.work / "out"], ranks, self.work / "out", timeout=500)
        self.assertEqual(run.code, 0, run.tail())
        return json.loads((run.folder / "verdict.json").read_text())

    def test_operating_point_is_found(self):
        file = self.prepare()
        verdict = self.diagnosed(file, 1)
        self.assertEqual((verdict["verdict"], verdict["effects"]), ("effects", ["operating_point"]), verdict)
        found = verdict["parameters"]["operating_point"]
        print(f"  operating point {found['mean']:.3f} +- {found['sd']:.3f}, true {TRUE_FACTOR - 1}, {verdict['runs']} runs")
        self.assertAlmostEqual(found["mean"], TRUE_FACTOR - 1, delta=3 * found["sd"])
        self.assertIn("fail", verdict["identifiability"]["blind"]["inlet"])
        self.assertIn("no turbulence", verdict["identifiability"]["blind"]["turbulent_dispersion"], "the mesh is laminar")

        runs = sorted((self.work / "out" / "runs").glob("run*/summary.json"))
        self.assertGreater(len(runs), 10, "whole runs are kept")
        lower = [file for file in runs if "lower.msh" in (file.parent / "case.resolved.toml").read_text()]
        self.assertGreaterEqual(len(lower), 3, "the alternative's mesh lies beside its case")
        made = {file: file.stat().st_mtime_ns for file in runs}
        shutil.copy(self.work / "out" / "verdict.json", self.work / "first.json")
        (self.work / "out" / "runs.tsv").unlink()
        again = self.diagnosed(file, 2)
        self.assertEqual({file: file.stat().st_mtime_ns for file in runs}, made, "no run is made twice")
        self.assertEqual(again["probability"], verdict["probability"])

    def test_misspelt_key_of_an_alternative_is_refused(self):
        """At once, by its file and key; a mesh that is refused is a run that failed, see above."""
        file = self.prepare()
        text = file.read_text()
        for key, near in (("mesh.fil", "file"), ("mesch.file", "mesh"), ("mesh.set.heigth_mm", None)):
            file.write_text(text.replace("mesh.file=absent.msh", f"{key}=1"))
            run = harness.snag(["diagnose", file, "--out", self.work / "refused"], 1, self.work / "refused")
            self.assertEqual(run.code, 2, run.tail())
            self.assertIn('DIAGNOSIS.toml', run.stderr)
            self.assertIn(f'[[alternative]] inlet "{key}=1": unknown', run.stderr)
            if near:
                self.assertIn(f'did you mean "{near}"?', run.stderr)

    def test_geometry_is_a_candidate_and_an_uncertain_input(self):
        """Numbers of a generated mesh: the runs of the candidate have meshes with another height, and what changes them is their length."""
        geometry = ", ".join(f"'{value}'" for value in MESH[1:]).replace("=100", "=100.0")
        text = self.channel("once", 0.5).read_text()
        mesh = text[text.index("[mesh]") : text.index("[time]")]
        (self.work / "A.toml").write_text(text.replace(mesh, f'[mesh]\ngeometry = "channel"\nset = [{geometry}]\n'))
        (self.work / "data.csv").write_text("point,replicate,t_s,observable,value\n" + "".join(f"A,{r},{t},x,{x}\n" for t, x in ((0.01, 0.0861), (0.02, 0.0922)) for r in (1, 2)))
        file = self.work / "DIAGNOSIS.toml"
        point = '[[point]]\nid = "A"\ncase = "A.toml"\ninput_u = {{ "mesh.set.{input}" = 0.05 }}\n'
        candidate = '[[candidate]]\nname = "height"\nkey = "mesh.set.height_mm"\nunit = "mm"\nmean = -5\nsd = 5\nminimum = -10\nmaximum = 15\n'
        head = f'[experiment]\nname = "geometry"\ndata = "data.csv"\n[[observable]]\nid = "x"\nunit = "m"\nnoise_u = {NOISE["x"]}\n'
        tail = candidate + '[model]\ncandidates = ["height"]\npairs = false\n[budget]\nmax_runs = 30\n'
        file.write_text(head + point.format(input="width_mm") + tail)
        failed = [note for note in self.diagnosed(file, 1)["notes"] if " failed" in note]
        self.assertEqual(len(failed), 1, "a fit tries channels that are too narrow for the rag")
        self.assertIn("outside the mesh", failed[0])
        sizes = set()
        for run in (self.work / "out" / "runs").glob("run*/case.resolved.toml"):
            values = [value for value in run.read_text().splitlines() if value.startswith("set = ")][0]
            sizes.add(tuple(key for key in ("height_mm", "width_mm") if f"{key}=100.0" not in values))
            self.assertIn("length_mm=300", values)
        self.assertTrue({(), ("height_mm",), ("width_mm",)} <= sizes, sizes)
        file.write_text(head + point.format(input="depth_mm") + tail)
        run = harness.snag(["diagnose", file, "--out", self.work / "refused"], 1, self.work / "refused")
        self.assertEqual(run.code, 2)
        self.assertIn("mesh.set.depth_mm", run.tail())


if __name__ == "__main__":
    harness.main()
