"""Requirement: `import snag` reads what the program writes, as the tutorial prints it: monitors with their units, summaries, cases, studies, verdicts
and posteriors. If a file is missing, the message says which command writes it."""
# timeout: 300
# cost: 12
import contextlib
import io
import json
import os
import pathlib
import re
import shutil

import numpy

import harness
import snag
from examples import printed_files
from tutorials import documented_columns, documented_units

EXAMPLE = harness.SOURCE_DIR / "cases" / "diagnose-sphere"
TUTORIAL = harness.SOURCE_DIR / "docs" / "tutorial-python.md"


class PythonPackage(harness.CaseTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        for file, content in printed_files((harness.SOURCE_DIR / "docs" / "tutorial-study.md").read_text()).items():
            (cls.shared / file).write_text(content)
        for words in (["study", cls.shared / "study.toml", "--out", cls.shared / "results" / "drop"],
                      ["diagnose", EXAMPLE / "DIAGNOSIS.toml", "--out", cls.shared / "results" / "diagnose-sphere"]):
            run = harness.snag(words)
            if run.code != 0:
                raise AssertionError(run.tail())

    def test_tutorial(self):
        """The code of the page runs as it is printed and draws its picture."""
        before = os.getcwd()
        os.chdir(self.shared)
        self.addCleanup(os.chdir, before)
        names, printed = {}, io.StringIO()
        with contextlib.redirect_stdout(printed):
            for code in re.findall(r"^```python\n(.*?)^```", TUTORIAL.read_text(), re.M | re.S):
                exec(code, names)
        for text in ("rags.0.max_bond_tension_N", "bond_energy", "added_mass", "effects attributed"):
            self.assertIn(text, printed.getvalue() + str(names["rags"].columns.tolist()))
        self.assertGreater((self.shared / "python.png").stat().st_size, 10000)
        if os.environ.get("SNAG_KEEP_PICTURE"):  # made again for docs/pictures
            shutil.copy(self.shared / "python.png", os.environ["SNAG_KEEP_PICTURE"])

    def test_run(self):
        folder = next(path for path in sorted((self.shared / "results" / "drop").iterdir()) if path.is_dir())
        run, summary = snag.open(folder), json.loads((folder / "summary.json").read_text())
        self.assertIsInstance(run, snag.Run)
        self.assertEqual(run.summary, summary)
        self.assertEqual(run.rags["outcome"].tolist(), [rag["outcome"] for rag in summary["rags"]])
        self.assertEqual(run.case["time.end_s"], 0.06)
        self.assertIn("rag.0.radius_m", run.case)
        documented = documented_columns()
        self.assertIn("rags", run.monitors)
        for name in run.monitors:
            frame = run.monitor(name)
            lines = (folder / "monitors" / f"{name}.csv").read_text().splitlines()
            self.assertEqual([f"{column} [{unit}]" for column, unit in frame.attrs["units"].items()], lines[0].split(","))
            for column, unit in frame.attrs["units"].items():
                self.assertEqual(documented_units(documented[name], column), [unit], f"{name}: {column}")
            self.assertEqual(frame.shape, (len(lines) - 1, len(lines[0].split(","))))
            self.assertEqual(frame.iloc[-1].tolist(), [float(value) for value in lines[-1].split(",")])
        with self.assertRaisesRegex(KeyError, "no monitor pump; it has .*rags"):
            run.monitor("pump")
        with self.assertRaisesRegex(KeyError, "time.end_ms"):
            run.case["time.end_ms"]

    def test_line_that_is_being_written(self):
        folder = next(path for path in sorted((self.shared / "results" / "drop").iterdir()) if path.is_dir())
        shutil.copytree(folder, self.work / "going")
        monitor = self.work / "going" / "monitors" / "rags.csv"
        whole = snag.Run(self.work / "going").monitor("rags")
        monitor.write_text(monitor.read_text() + "0.07,0,0.1")
        self.assertTrue(whole.equals(snag.Run(self.work / "going").monitor("rags")))
        (self.work / "going" / "summary.json").unlink()
        with self.assertRaisesRegex(FileNotFoundError, "a run that has ended writes it"):
            snag.Run(self.work / "going").summary

    def test_column_with_a_comma(self):
        """Patches are named by the user, and a monitor has columns of their names."""
        (self.work / "named" / "monitors").mkdir(parents=True)
        (self.work / "named" / "case.resolved.toml").write_text("")
        (self.work / "named" / "monitors" / "patches.csv").write_text('time [s],"a, ""b""_flow [m3/s]",outlet_flow [m3/s]\n0.1,2,3\n0.2,4,5\n')
        frame = snag.Run(self.work / "named").monitor("patches")
        self.assertEqual(frame.attrs["units"], {"time": "s", 'a, "b"_flow': "m3/s", "outlet_flow": "m3/s"})
        self.assertEqual(frame['a, "b"_flow'].tolist(), [2, 4])

    def test_study(self):
        study = snag.open(self.shared / "results" / "drop")
        self.assertIsInstance(study, snag.Study)
        self.assertEqual(len(study.runs), 4)
        self.assertEqual(study.runs["exit"].tolist(), [0] * 4)
        for name, row in study.runs.iterrows():
            self.assertEqual(row["rags.0.elongation_ratio"], study.run(name).rags["elongation_ratio"][0])
        first, last = (study.run(name).case for name in (study.runs.index[0], study.runs.index[-1]))
        self.assertEqual(set(first.difference(last).index), {"rag.0.radius_m", "rag.0.velocity_m_s"})

    def test_verdict(self):
        folder = self.shared / "results" / "diagnose-sphere"
        verdict, content = snag.open(folder), json.loads((folder / "verdict.json").read_text())
        self.assertIsInstance(verdict, snag.Verdict)
        self.assertEqual((verdict.verdict, verdict.effects), ("effects", ["added_mass"]))
        self.assertEqual(verdict.causes.loc["added_mass", "mean"], content["parameters"]["added_mass"]["mean"])
        self.assertEqual(verdict.causes.loc["added_mass", "probability"], content["acts"]["added_mass"])
        self.assertAlmostEqual(verdict.probability.sum(), 1, places=6)
        self.assertEqual(verdict.probability.index[0], max(content["probability"], key=content["probability"].get))
        self.assertEqual(len(verdict.cells), len(content["where"]))
        self.assertEqual(verdict.cells["significant"].sum(), sum(cell["significant"] for cell in content["where"]))
        self.assertEqual(verdict.evidence.index[0], max(content["evidence"]["log_evidence"], key=content["evidence"]["log_evidence"].get))
        self.assertEqual(verdict.shrinkage.loc["added_mass", "mean"], content["shrinkage"]["added_mass"]["mean"])
        self.assertEqual(len(verdict.curves), sum(len(curve["t_s"]) for curve in content["curves"]))

    def test_posterior(self):
        """Mean and standard deviation of the draws are those of the verdict, to the error of their number; the layout is ArviZ's.

        By the InferenceData schema a group has variables of [chain, draw, ...], none named as a dimension, and attributes that name what made it; its
        created_at is when a reader makes the group. arviz.from_json of ArviZ 0.21 read such a file and wrote the same draws back."""
        folder = self.shared / "results" / "diagnose-sphere"
        verdict, content = snag.Verdict(folder), json.loads((folder / "posterior.json").read_text())
        self.assertEqual(set(content), {"posterior", "posterior_attrs"})  # groups, and attributes of them, of arviz.from_dict
        self.assertFalse({"chain", "draw"} & set(content["posterior"]))
        self.assertEqual(content["posterior_attrs"]["inference_library"], "snag")
        self.assertRegex(content["posterior_attrs"]["inference_library_version"], r"^\d+\.\d+")
        self.assertTrue(all(numpy.isfinite(chains).all() for chains in content["posterior"].values()))
        for value in content["posterior_attrs"].values():
            self.assertIsInstance(value, str)  # netCDF holds no tables
        shapes = {numpy.shape(chains) for chains in content["posterior"].values()}
        self.assertEqual(shapes, {(4, 500)})
        draws, strength = verdict.posterior, verdict.strengths.loc["added_mass"]
        self.assertEqual(content["posterior_attrs"]["hypothesis"], "added_mass")
        self.assertLess(abs(draws["added_mass"].mean() - strength["mean"]), 4 * strength["sd"] / len(draws) ** 0.5)
        self.assertAlmostEqual(draws["added_mass"].std() / strength["sd"], 1, delta=4 / (2 * len(draws)) ** 0.5)
        self.assertEqual(set(draws) - {"added_mass"}, set(verdict.json["nuisances"]))
        for name, fitted in verdict.json["nuisances"].items():
            self.assertLess(abs(draws[name].mean() - fitted), 4 / len(draws) ** 0.5, name)

    def test_what_is_not_there(self):
        with self.assertRaisesRegex(FileNotFoundError, "snag run, study or diagnose"):
            snag.open(self.work)
        with self.assertRaisesRegex(FileNotFoundError, "snag diagnose --out writes it"):
            snag.Verdict(self.work)


if __name__ == "__main__":
    harness.main()
