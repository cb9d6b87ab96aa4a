"""snag diagnose finds what a base case lacks, the same on any number of ranks, goes on after a stop, and refuses what it cannot read."""
# timeout: 1800
# cost: 37
import json
import math
import re
import shutil
import tomllib

import numpy

import harness

EXAMPLE = harness.SOURCE_DIR / "cases" / "diagnose-sphere"


class Diagnose(harness.CaseTest):
    def diagnose(self, file, out="out", ranks=1, code=0):
        run = harness.snag(["diagnose", file, "--out", self.work / out], ranks, self.work / out)
        self.assertEqual(run.code, code, run.tail())
        return run

    def verdict(self, run):
        return json.loads((run.folder / "verdict.json").read_text())

    def example(self):
        """A copy of the example that a test may spoil."""
        return pathlib_copy(EXAMPLE, self.work / "example")

    def test_example_names_the_added_mass(self):
        """Data of another program, with the added mass of a sphere that the base case leaves out."""
        run = self.diagnose(EXAMPLE / "DIAGNOSIS.toml")
        verdict = self.verdict(run)
        self.assertEqual(verdict["verdict"], "effects", verdict["wording"])
        self.assertEqual(verdict["effects"], ["added_mass"])
        mass = verdict["parameters"]["added_mass"]
        self.assertLess(abs(mass["mean"] - 0.5), 4 * mass["sd"])
        self.assertGreater(verdict["shrinkage"]["added_mass"]["mean"], 0.8)
        # Paths in the unit of the data, and the gap of the start, the only time at which the added mass acts, handed on.
        for curve in verdict["curves"]:
            measured = [float(line.split(",")[4]) for line in (EXAMPLE / "data.csv").read_text().splitlines()
                        if line.startswith(curve["point"] + ",") and line.split(",")[3] == curve["observable"]]
            self.assertEqual(curve["unit"], "mm")
            self.assertAlmostEqual(curve["measured"][-1], measured[-1], delta=5 * curve["u"][-1])
        origins = [cell["origin"] for cell in verdict["where"] if cell["significant"] and not cell["onset"]]
        self.assertGreater(len(origins), 5)
        self.assertGreaterEqual(origins.count("inherited"), 0.9 * len(origins))
        page = (run.folder / "report.html").read_text()
        for text in ("Which effect", "How far the gap shrinks", "Where the gap is", "added_mass"):
            self.assertIn(text, page)
        # A second start finds its runs again and says the same; so do two ranks.
        kept = (run.folder / "runs.tsv").read_bytes()
        again = self.verdict(self.diagnose(EXAMPLE / "DIAGNOSIS.toml"))
        self.assertEqual(again["runs"], 0)
        self.assertEqual((run.folder / "runs.tsv").read_bytes(), kept)
        two = self.verdict(self.diagnose(EXAMPLE / "DIAGNOSIS.toml", "two", 2))
        for other in (again, two):
            self.assertEqual({**other, "runs": 0}, {**verdict, "runs": 0})

    def test_alternative_is_there_or_not(self):
        """Base cases with spheres that are 5 % too heavy, and the right ones as another geometry: nothing of it is fitted, and it is told from drag."""
        file = self.example() / "DIAGNOSIS.toml"
        text, alternative = file.read_text(), '[[alternative]]\neffect = "geometry"\nmeaning = "spheres as ordered"\n'
        for point in "ABCDEFG":
            density = tomllib.loads((file.parent / f"point_{point}.toml").read_text())["particle"][0]["density_kg_m3"]
            setting = """set = ["coupling.forces=['schiller_naumann', 'added_mass']", "particle.0.density_kg_m3=%g"]\n"""
            text = re.sub(rf'(case = "point_{point}.toml"\n)', lambda found: found.group(1) + setting % (1.05 * density), text)
            alternative += f'[[alternative.at]]\npoint = "{point}"\nset = ["particle.0.density_kg_m3={density}"]\n'
        file.write_text(text + alternative + '[model]\ncandidates = ["geometry", "drag_magnitude", "history"]\n')
        verdict = self.verdict(self.diagnose(file))
        self.assertEqual((verdict["verdict"], verdict["effects"]), ("effects", ["geometry"]), verdict)
        found = verdict["parameters"]["geometry"]
        self.assertAlmostEqual(found["mean"], 1, delta=1e-3)
        self.assertEqual(found["sd"], 0)
        self.assertGreater(verdict["shrinkage"]["geometry"]["mean"], 0.8)
        # By a name that the library does not have it is a candidate beside those of the library; one that no list examines is misspelt.
        file.write_text(file.read_text().replace('"geometry"', '"spheres_as_ordered"'))
        renamed = self.verdict(self.diagnose(file, "renamed"))
        self.assertEqual((renamed["verdict"], renamed["effects"]), ("effects", ["spheres_as_ordered"]), renamed)
        self.assertEqual(renamed["evidence"]["log_evidence"]["spheres_as_ordered"], verdict["evidence"]["log_evidence"]["geometry"])
        file.write_text(file.read_text().replace('effect = "spheres_as_ordered"', 'effect = "spheres_as_orderd"'))
        refused = self.diagnose(file, "refused", code=2)
        self.assertIn('"spheres_as_orderd" is not among [model] candidates', refused.stderr)

    def test_own_candidates(self):
        """Spheres that started 3 mm lower than the cases say: a candidate of the file is named with its size, among those of the library; without
        a shift it is not named. (A camera whose place is not known would do the same.) One whose key the cases do not have is refused."""
        file = self.example() / "DIAGNOSIS.toml"
        own = """
[[candidate]]
name = "start"
meaning = "height of the start"
key = "particle.position_m"
direction = [0, 0, 1]
unit = "mm"
sd = 5
"""
        text = re.sub(r"(?m)^(case = .*)$", r"""\1\nset = ["coupling.forces=['schiller_naumann', 'added_mass']"]""", file.read_text())
        text = text.replace("bias_u = 0.05", "bias_u = 0")
        file.write_text(text + own + '[model]\ncandidates = ["start", "drag_magnitude", "drag_exponent", "history", "gravity"]\n')
        for shift, named in ((0, []), (-3e-3, ["start"])):
            place = [f"particle.0.position_m=[0.0, 0.0, {shift}]"]
            self.data_of_runs(file.parent, "coupling.forces=['schiller_naumann', 'added_mass']", *place)
            verdict = self.verdict(self.diagnose(file, f"own{shift}"))
            self.assertEqual(verdict["effects"] if verdict["verdict"] == "effects" else [], named, verdict["notes"])
        found = verdict["parameters"]["start"]
        self.assertAlmostEqual(found["mean"], -3, delta=4 * found["sd"])
        self.assertLess(found["sd"], 0.3)
        self.assertIn("#   start: strength", (self.work / "own-0.003" / "case_with_effects_A.toml").read_text())
        file.write_text(file.read_text().replace("particle.position_m", "particle.place_m"))
        refused = self.diagnose(file, "refused", code=2)
        self.assertIn('start: key "particle.place_m" is not a number of', refused.stderr)

    def test_one_scale_that_is_wrong_of_several_values(self):
        """Densities of seven spheres of seven kinds, all 2 % below the true ones, where 0.2 % is stated: the input is named with that error.
        With the right densities nothing is."""
        file = self.example() / "DIAGNOSIS.toml"
        text = file.read_text().replace("bias_u = 0.05", "bias_u = 0")
        self.data_of_runs(file.parent)
        for factor, said in ((0.98, ["input:particle.density_kg_m3"]), (1, [])):
            weighed = text
            for point in "ABCDEFG":
                density = tomllib.loads((file.parent / f"point_{point}.toml").read_text())["particle"][0]["density_kg_m3"]
                setting = f'set = ["particle.0.density_kg_m3={factor * density:g}"]\n'
                weighed = weighed.replace(f'case = "point_{point}.toml"\n', f'case = "point_{point}.toml"\n{setting}')
            file.write_text(weighed)
            verdict = self.verdict(self.diagnose(file, f"weighed-{factor}"))
            self.assertEqual(verdict["effects"], said, verdict["notes"])
            self.assertEqual(verdict["verdict"], "effects" if said else "none", verdict["notes"])
            if said:
                found = verdict["parameters"][said[0]]
                self.assertAlmostEqual(found["mean"], 1 / factor - 1, delta=4 * found["sd"])
                self.assertLess(found["sd"], 0.002)

    def data_of_runs(self, folder, *settings):
        """The data of the example made anew: by runs of its own cases with other settings, 20 times each, and noise."""
        noise = numpy.random.default_rng(1)
        rows = ["point,replicate,t_s,observable,value"]
        for point in "ABCDEFG":
            words = ["--overwrite", *(word for one in ("output.report=false", *settings) for word in ("--set", one))]
            rags = self.run_case(folder / f"point_{point}.toml", 1, *words, out=f"truth-{point}").monitor("rags")
            for t in numpy.arange(0.02, 0.401, 0.02):
                z = numpy.interp(t, rags.column("time"), rags.column("z"))
                rows += [f"{point},{r},{t:.3f},z,{1e3 * z + 0.2 * noise.standard_normal():.4f}" for r in (1, 2, 3)]
        (folder / "data.csv").write_text("\n".join(rows) + "\n")

    def test_improved_case_is_the_prediction(self):
        """The case that a verdict leaves is accepted as it is, and its run is the prediction of the verdict, digit by digit; a verdict that
        names nothing leaves none, and says why."""
        file = self.example() / "DIAGNOSIS.toml"
        text = file.read_text().replace("bias_u = 0.05", "bias_u = 0")
        file.write_text(text + '[model]\ncandidates = ["drag_magnitude", "drag_exponent", "added_mass"]\n')
        self.data_of_runs(file.parent, "coupling.schiller_naumann.drag_factor=1.4")
        done = self.diagnose(file)
        verdict = self.verdict(done)
        self.assertEqual((verdict["verdict"], verdict["effects"]), ("effects", ["drag_magnitude"]), verdict["notes"])
        improved = verdict["case_with_effects"]
        self.assertEqual(improved["files"], [f"case_with_effects_{point}.toml" for point in "ABCDEFG"])
        self.assertEqual(improved["off_by_forms_u"], 0)
        page = (done.folder / "report.html").read_text()
        self.assertIn("Go on with case_with_effects_A.toml", page)
        self.assertIn("drag_magnitude = ", page)
        self.assertTrue(verdict["curves"])
        for curve in verdict["curves"]:
            case = done.folder / f"case_with_effects_{curve['point']}.toml"
            self.assertIn("#   drag_magnitude: strength", case.read_text())
            checked = harness.snag(["check", case])
            self.assertEqual(checked.code, 0, checked.tail())
            rags = self.run_case(case, 1, out=f"improved-{curve['point']}").monitor("rags")
            for t, predicted, base in zip(curve["t_s"], curve["with_effect"], curve["base"], strict=True):
                z = 1e3 * numpy.interp(t, rags.column("time"), rags.column("z"))
                self.assertAlmostEqual(z / predicted, 1, delta=1e-9)
                self.assertNotAlmostEqual(z / base, 1, delta=1e-3)
        self.data_of_runs(file.parent)
        none = self.diagnose(file)
        verdict = self.verdict(none)
        self.assertEqual(verdict["verdict"], "none", verdict["notes"])
        self.assertEqual(verdict["case_with_effects"]["files"], [])
        self.assertIn("The verdict names no cause", (none.folder / "report.html").read_text())
        self.assertEqual(sorted(path.name for path in none.folder.iterdir() if path.name.startswith(("case_with", "posterior"))), [])

    def test_refuses_what_it_cannot_read(self):
        spoiled = {
            'unit = "mm"\n': ("", "unit"),
            '"particle.density_kg_m3" = 0.002': ('"particle.colour" = 0.002', "particle.colour"),
            'case = "point_C.toml"': ('case = "nowhere.toml"', "nowhere.toml"),
            'id = "z"': ('id = "head"', "head"),
        }
        for old, (new, named) in spoiled.items():
            folder = self.example()
            file = folder / "DIAGNOSIS.toml"
            file.write_text(file.read_text().replace(old, new))
            if named == "head":
                (folder / "data.csv").write_text((folder / "data.csv").read_text().replace(",z,", ",head,"))
            run = harness.snag(["diagnose", file, "--out", self.work / "bad"], 2)
            self.assertIn(run.code, (2, 6), f"{named}: {run.tail()}")
            self.assertEqual(len([m for m in run.messages if "error" in m]), 1, run.tail())
            self.assertIn(named, run.stderr)
        run = harness.snag(["diagnose", "--out", self.work / "none"])
        self.assertEqual(run.code, 2)
        run = harness.snag(["diagnose", "--bench", "L7", "--out", self.work / "none"])
        self.assertEqual(run.code, 2)
        self.assertIn("L7", run.stderr)

def assert_no_score_is_worse_than_chance(test, benchmark):
    for score in json.loads((benchmark.folder / "score.json").read_text())["scores"]:
        limit, at_least = float(score["target"].split()[1]), score["target"].startswith(">=")
        with test.subTest(score["name"]):
            test.assertGreater(chance(score["hits"], score["n"], limit, at_least), 0.01, score)


def chance(hits, n, p, at_least):
    """Probability of so few hits (so many, if p is a largest share) of n when the share is p."""
    counted = range(0, hits + 1) if at_least else range(hits, n + 1)
    return sum(math.comb(n, k) * p**k * (1 - p) ** (n - k) for k in counted)


def pathlib_copy(source, target):
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(source, target)
    return target


if __name__ == "__main__":
    harness.main()
