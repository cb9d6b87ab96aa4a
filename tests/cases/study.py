# timeout: 600
# cost: 22
# processors: 2
"""Requirement: a study runs a case with all values asked for, each as it would be by itself, runs nothing twice, and tells what came out."""
import csv
import json
import re
import shutil

import harness
from small_cases import TWO_SHEETS

STUDY = """
[study]
name = "sheets"
case = "case.toml"
set = ["time.end_s=0.008", "time.step_s=8e-4"]
results = ["rags.0.particles", "rags.0.elongation_ratio", "rags.1.outcome", "rags.7.outcome"]
{zip}
[[vary]]
key = "rag.0.radius_mm"
values = [1, 1.25]
[[vary]]
key = "rag.0.length"
name = "length"
texts = ["100 mm", "120 mm"]
[[plot]]
title = "Particles"
x = "radius_mm"
y = ["rags.0.particles", "rags.0.elongation_ratio"]
"""
NAMES = ["radius_mm-1_length-100_mm", "radius_mm-1_length-120_mm", "radius_mm-1.25_length-100_mm", "radius_mm-1.25_length-120_mm"]


# A sphere falls through still water with drag: its path in 0.2 s depends on the step only where the step is long.
FALL = """
[case]
name = "fall"
[time]
end_s = 0.2
step_ms = 1
[flow]
kind = "prescribed"
density_kg_m3 = 1000
dynamic_viscosity_Pa_s = {viscosity}
[gravity]
acceleration_m_s2 = [0, 0, -9.81]
[[particle]]
diameter_mm = 2
density_kg_m3 = 3000
[coupling]
mode = "one_way"
forces = ["schiller_naumann"]
[output]
report = false
"""
PLATEAU = """
[study]
name = "fall"
case = "fall.toml"
results = ["rags.0.before_contact.path_m"]
[[vary]]
key = "coupling.forces"
name = "drag"
texts = ['["schiller_naumann"]', '["{other}"]']
[[vary]]
key = "time.step_ms"
name = "step"
values = [1, 2.5, 5, 10, 200]
[plateau]
x = "step"
results = ["rags.0.before_contact.path_m"]
tolerance = {tolerance}
{more}
"""


class Plateau(harness.CaseTest):
    def study(self, other="haider_levenspiel", tolerance=0.05, more="", code=0):
        self.case(FALL.format(viscosity=0.1), "fall")
        (self.work / "fall.toml").write_text(FALL.format(viscosity=0.1))
        (self.work / "study.toml").write_text(PLATEAU.format(other=other, tolerance=tolerance, more=more))
        out = self.work / f"out-{other}-{bool(more)}"
        run = harness.snag(["study", self.work / "study.toml", "--out", out], 1, out)
        self.assertEqual(run.code, code, run.tail())
        return run, json.loads((out / "plateau.json").read_text()) if code == 0 else None

    def test_found(self):
        run, plateau = self.study()
        self.assertTrue(plateau["found"], plateau)
        self.assertEqual(plateau["window"]["to"], 10)
        self.assertEqual((plateau["window"]["from"], plateau["recommended"], plateau["unit"]), (1, 2.5, "ms"))
        self.assertLess(plateau["window"]["deviation"], 0.05)
        self.assertIn(plateau["words"], run.stdout)
        page = (run.folder / "study.html").read_text()
        self.assertIn("<h2>Plateau</h2>", page)
        self.assertIn("Use step", page)
        largest = self.study(more='recommend = "largest"')[1]
        self.assertEqual(largest["recommended"], plateau["window"]["to"])

    def test_refused(self):
        """Two laws of drag that differ are no numerical choice: no step is recommended, unless the study says that they are physical."""
        run, plateau = self.study("cylinder_segments", tolerance=0.01)
        self.assertFalse(plateau["found"], plateau)
        self.assertIsNone(plateau["recommended"])
        self.assertIn("no recommendation", run.stdout)
        self.assertTrue(self.study("cylinder_segments", 0.01, 'physical = ["drag"]')[1]["found"])

    def test_words_of_errors(self):
        for more, words in (('physical = ["force"]', 'physical has "force", which is not the name of a [[vary]]; there are: drag, step'), ("n_least = 1", "n_least")):
            self.assertIn(words, self.study(more=more, code=2)[0].stderr)


class Study(harness.CaseTest):
    def study(self, text="", ranks=2, code=0, out="study"):
        self.case(TWO_SHEETS)
        (self.work / "study.toml").write_text(text or STUDY.format(zip=""))
        run = harness.snag(["study", self.work / "study.toml", "--out", self.work / out], ranks, self.work / out)
        self.assertEqual(run.code, code, run.tail())
        return run

    def table(self, out="study"):
        with open(self.work / out / "study.csv", newline="") as file:
            return list(csv.DictReader(file))

    @harness.parallel
    def test_all_combinations(self):
        done = self.study()
        rows = self.table()
        self.assertEqual([row["run"] for row in rows], NAMES)
        self.assertEqual([row["length"] for row in rows], ["100 mm", "120 mm"] * 2)
        self.assertEqual([int(row["rags.0.particles"]) for row in rows], [50 * 40, 60 * 40, 40 * 32, 48 * 32])
        self.assertEqual({row["exit"] for row in rows}, {"0"})
        self.assertEqual({row["rags.7.outcome"] for row in rows}, {""})
        self.assertIn('no run has a value of "rags.7.outcome"', done.stdout, "an empty column is no secret")
        page = (done.folder / "study.html").read_text()
        self.assertGreaterEqual(page.count("<svg"), 2, "the plot that is asked for, and the runs over time")
        for label in ("Radius [mm]", "Elongation ratio at the end", "Outcome, rag 1"):
            self.assertIn(label, page)
        for name in NAMES:
            self.assertIn(f'href="{name}/report.html"', page)
        # The last of the four runs of one process is the run that it is by itself.
        alone = self.run_case(self.work / "case.toml", 2, *(word for one in ("time.end_s=0.008", "time.step_s=8e-4", "rag.0.radius_mm=1.25", "rag.0.length=120 mm") for word in ("--set", one)))
        last = json.loads((done.folder / NAMES[-1] / "summary.json").read_text())
        self.assertEqual(last["rags"], alone.summary["rags"])
        self.assertEqual(last["case_sha256"], alone.summary["case_sha256"])
        self.assertEqual(float(rows[-1]["rags.0.elongation_ratio"]), alone.summary["rags"][0]["elongation_ratio"])

    def test_what_goes_with_a_value(self):
        text = STUDY.replace("values = [1, 1.25]", 'values = [1, 1.25]\nwith = ["rag.1.radius_mm=2", "rag.1.radius_mm=1.25"]').replace("rags.7.outcome", "rags.1.particles")
        self.study(text.format(zip="zip = true"), ranks=1)
        particles = [int(row["rags.1.particles"]) for row in self.table()]
        self.assertEqual(particles[0] * 2**2, particles[1] * 1.25**2)

    @harness.parallel
    def test_nothing_is_run_twice(self):
        done = self.study(STUDY.format(zip="zip = true"))
        summaries = [done.folder / name / "summary.json" for name in (NAMES[0], NAMES[3])]
        self.assertEqual([row["run"] for row in self.table()], [NAMES[0], NAMES[3]])
        text = [file.read_text() for file in summaries]
        summaries[1].unlink()  # as if the computer had gone down: the checkpoint at the end is there
        again = self.study(STUDY.format(zip="zip = true"))
        self.assertIn("has been run before", again.stdout)
        self.assertIn("resumed at 0.008", again.stdout)
        self.assertEqual(summaries[0].read_text(), text[0], "an ended run is left alone")
        for key in ("max_bond_tension_N", "wall_contact_s", "bond_strain_p99"):
            self.assertEqual(json.loads(summaries[1].read_text())["rags"][0][key], json.loads(text[1])["rags"][0][key])
        summaries[1].unlink()
        shutil.rmtree(done.folder / NAMES[3] / "checkpoint")  # without it the run begins anew
        again = self.study(STUDY.format(zip="zip = true"))
        self.assertNotIn("resumed", again.stdout)
        self.assertEqual(json.loads(summaries[1].read_text())["rags"], json.loads(text[1])["rags"])

    @harness.parallel
    def test_too_many_runs_are_refused(self):
        """Seven keys of 13 values without zip are 62 million runs."""
        vary = "".join(f'[[vary]]\nkey = "rag.0.key_{i}"\nvalues = {list(range(13))}\n' for i in range(7))
        refused = self.study('[study]\nname = "sheets"\ncase = "case.toml"\nresults = ["wall_s"]\n' + vary, code=2)
        self.assertIn("more than 10000 runs", refused.stderr)
        long_key = "x" * 3000
        refused = self.study(STUDY.format(zip="").replace("rags.7.outcome", long_key), code=2)
        self.assertIn("which is not a key of summary.json", refused.stderr)
        self.assertNotIn("x" * 100, refused.stderr)

    @harness.parallel
    def test_changed_study_is_refused(self):
        text = STUDY.replace("[1, 1.25]", "[1]").replace('["100 mm", "120 mm"]', '["100 mm"]').format(zip="")
        self.study(text)
        refused = self.study(text.replace("0.008", "0.016"), code=2)
        self.assertIn("has a run of another case, of other values", refused.stderr)

    def test_file_that_changed_is_refused(self):
        """A mesh, or a text of a geometry, that was made again: the table would mix the old runs with new ones."""
        parameters = self.work / "box.toml"
        parameters.write_text('[box]\nsize_mm = 50\nlower_m = [0, 0, 0]\nupper_m = [0.1, 0.1, 0.1]\ncells = "hexahedra"\n')
        self.case('[case]\nname = "box"\n[mesh]\ngeometry = "box"\nparameters = "box.toml"\n[time]\nend_ms = 1\nstep_ms = 1\n'
                  '[flow]\n[[boundary]]\npatches = ["x0", "x1", "y0", "y1", "z0", "z1"]\nkind = "wall"\n[output]\nreport = false\n', "box_case")
        study = self.work / "study.toml"
        study.write_text('[study]\nname = "boxes"\ncase = "box_case.toml"\nresults = ["mesh.cells"]\n'
                         '[[vary]]\nkey = "flow.kinematic_viscosity_m2_s"\nname = "nu"\nvalues = [1e-6, 1e-5]\n')
        again = ["study", study, "--out", self.work / "study"]
        self.assertEqual(harness.snag(again).code, 0)
        self.assertIn("run 2 of 2: nu-1e-05 has been run before", harness.snag(again).stdout)
        of_run = self.work / "study" / "nu-1e-05" / "input.toml"
        written = of_run.read_text()
        of_run.write_text(re.sub(r"# [^\n]*: sha256 [0-9a-f]+\n", "", written))  # as an earlier version left it
        self.assertNotEqual(of_run.read_text(), written)
        self.assertIn("run 2 of 2: nu-1e-05 has been run before", harness.snag(again).stdout)
        self.assertNotIn("sha256", of_run.read_text(), "what was in the files of that run is not known")
        of_run.write_text(written)
        parameters.write_text(parameters.read_text().replace("50", "25"))
        refused = harness.snag(again)
        self.assertEqual(refused.code, 2, refused.tail())
        self.assertIn("of other files", refused.stderr)

    def test_names_twice(self):
        text = STUDY.format(zip="").replace('name = "length"', 'name = "radius_mm"')
        refused = harness.snag(["study", self.written(text), "--out", self.work / "study"])
        self.assertEqual(refused.code, 2, refused.tail())
        self.assertIn('another [[vary]] has the name "radius_mm"', refused.stderr)

    @harness.parallel
    def test_failed_run_does_not_stop_the_others(self):
        """A rag at 400 m/s leaves its bonds behind within a step: the study goes on and ends with the code of that run, a repeated one too."""
        text = STUDY.format(zip="zip = true").replace("rag.0.length", "rag.1.velocity_m_s").replace('"100 mm", "120 mm"', '"[4e4, 0, -3e4]", "[2, 0, -3]"')
        done = harness.snag(["study", self.written(text), "--out", self.work / "study"], 1, self.work / "study")
        rows = self.table()
        self.assertEqual(len(rows), 2)
        self.assertEqual(rows[1]["exit"], "0", done.tail())
        self.assertNotEqual(rows[0]["exit"], "0", done.tail())
        self.assertEqual(done.code, int(rows[0]["exit"]))
        again = harness.snag(["study", self.work / "study.toml", "--out", self.work / "study"])
        self.assertEqual(again.stdout.count("has been run before"), 2, again.tail())
        self.assertEqual(again.code, done.code)

    def test_refused_value_does_not_stop_the_others(self):
        """A radius for which the cloth is not calibrated: the other run is made, and the table says which one was refused."""
        text = STUDY.format(zip="zip = true").replace("[1, 1.25]", "[3, 1.25]")
        done = self.study(text, ranks=1, code=2)
        self.assertEqual([row["exit"] for row in self.table()], ["2", "0"], done.tail())

    def test_unfit_mesh_does_not_stop_the_others(self):
        """A cell of one run's mesh is turned inside out: the others are made. What no run can do without, a file that is absent, ends the study, with a table."""
        (self.work / "cube.toml").write_text("[box]\nsize_mm = 50\nlower_m = [0, 0, 0]\nupper_m = [0.1, 0.1, 0.1]\ncells = \"hexahedra\"\n")
        for name in ("first", "third"):
            made = harness.snag(["mesh", "box", self.work / "cube.toml", "--format", "2.2", "--out", self.work / f"{name}.msh"])
            self.assertEqual(made.code, 0, made.tail())
        first = (self.work / "first.msh").read_text()
        self.assertEqual(len(re.findall(r" 0\.05 0\.05 0\.05\n", first)), 1)
        (self.work / "second.msh").write_text(first.replace(" 0.05 0.05 0.05\n", " 0.15 0.05 0.05\n"))
        self.case('[case]\nname = "box"\n[mesh]\nfile = "first.msh"\n[time]\nend_ms = 1\nstep_ms = 1\n'
                  '[flow]\n[[boundary]]\npatches = ["x0", "x1", "y0", "y1", "z0", "z1"]\nkind = "wall"\n[output]\nreport = false\n', "box")
        study = self.work / "study.toml"
        study.write_text('[study]\nname = "boxes"\ncase = "box.toml"\nresults = ["mesh.cells"]\n'
                         '[[vary]]\nkey = "mesh.file"\nname = "mesh"\ntexts = ["first.msh", "second.msh", "third.msh"]\n')
        run = harness.snag(["study", study, "--out", self.work / "study"])
        self.assertEqual(run.code, 3, run.tail())
        self.assertEqual([(row["exit"], row["mesh.cells"]) for row in self.table()], [("0", "8"), ("3", ""), ("0", "8")], run.tail())
        (self.work / "second.msh").unlink()
        lost = harness.snag(["study", study, "--out", self.work / "lost"])
        self.assertEqual(lost.code, 6, lost.tail())
        self.assertIn("second.msh", lost.stderr)
        self.assertEqual([row["exit"] for row in self.table("lost")], ["0", "6", ""], lost.tail())

    @harness.parallel
    def test_generated_mesh_is_made_once(self):
        """Runs with the same geometry and parameters share a mesh, which is gone at the end."""
        for size in (25, 50):
            (self.work / f"box_{size}.toml").write_text(f"[box]\nsize_mm = {size}\nlower_m = [0, 0, 0]\nupper_m = [0.1, 0.1, 0.1]\ncells = \"hexahedra\"\n")
        self.case('[case]\nname = "box"\n[mesh]\ngeometry = "box"\nparameters = "box_25.toml"\n[time]\nend_ms = 2\nstep_ms = 1\n'
                  '[flow]\n[[boundary]]\npatches = ["x0", "x1", "y0", "y1", "z0", "z1"]\nkind = "wall"\n[output]\nreport = false\n', "box")
        (self.work / "study.toml").write_text('[study]\nname = "boxes"\ncase = "box.toml"\nresults = ["mesh.cells"]\n'
                                              '[[vary]]\nkey = "mesh.parameters"\nname = "mesh"\ntexts = ["box_25.toml", "box_50.toml"]\n'
                                              '[[vary]]\nkey = "flow.kinematic_viscosity_m2_s"\nname = "nu"\nvalues = [1e-6, 1e-5]\n')
        (self.work / "tmp").mkdir()
        run = harness.snag(["study", self.work / "study.toml", "--out", self.work / "study"], 2, self.work / "study", environment={"TMPDIR": str(self.work / "tmp")})
        self.assertEqual(run.code, 0, run.tail())
        self.assertEqual([row["mesh.cells"] for row in self.table()], ["64", "64", "8", "8"])
        self.assertEqual(run.stdout.count("of the shape"), 2, run.stdout)
        self.assertEqual([file.name for file in (self.work / "tmp").iterdir() if file.suffix in (".msh", ".toml")], [])
        (self.work / "set.toml").write_text((self.work / "study.toml").read_text().replace("results =", "set = ['mesh.set=[\"size_mm=50\", \"upper_m=[0.1, 0.1, 0.2]\"]']\nresults ="))
        shutil.rmtree(self.work / "study")
        run = harness.snag(["study", self.work / "set.toml", "--out", self.work / "study"], 2, self.work / "study")
        self.assertEqual(run.code, 0, run.tail())
        self.assertEqual([row["mesh.cells"] for row in self.table()], ["16"] * 4, "values of the case replace those of the parameter file")
        (self.work / "box_25.toml").write_text("")
        (self.work / "box_50.toml").unlink()
        lost = harness.snag(["study", self.work / "study.toml", "--out", self.work / "lost"], 1, self.work / "lost")
        self.assertEqual(lost.code, 6, lost.tail())
        self.assertIn("box_50.toml", lost.stderr, "an absent file is not one without parameters")

    def written(self, text):
        self.case(TWO_SHEETS)
        (self.work / "study.toml").write_text(text)
        return self.work / "study.toml"

    def test_words_of_errors(self):
        for change, words in (
            (("values = [1, 1.25]", ""), "give either values (numbers) or texts"),
            (("values = [1, 1.25]", "values = [1, 1]"), "two runs would be named"),
            (("values = [1, 1.25]", 'values = [1, 1.25]\nwith = ["rag.1.radius_mm=2"]'), "has 2 values, with has 1"),
        ):
            self.assertIn(words, self.study(STUDY.replace(*change).format(zip=""), code=2, ranks=1).stderr)
        lost = self.study(STUDY.replace('case = "case.toml"', 'case = "-inf"').format(zip=""), code=6, ranks=1)
        self.assertIn("study.toml: [study] case", lost.stderr)
        unknown = self.study(STUDY.replace("rags.1.outcome", "rags.1.outcom").format(zip=""), code=2, ranks=1)
        self.assertIn('"rags.1.outcom", which is not a key of summary.json; did you mean "rags.0.outcome"', unknown.stderr)
        self.assertIn("pump.head_m", unknown.stderr, "the known keys are named")
        self.assertIn("need as many", self.study(STUDY.replace("[1, 1.25]", "[1]").format(zip="zip = true"), code=2, ranks=1).stderr)


if __name__ == "__main__":
    harness.main()
