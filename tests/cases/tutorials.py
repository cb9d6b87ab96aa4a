# timeout: 600
# cost: 13
"""Requirement: the commands of the tutorials run as they are printed, and every key and column that their runs write is documented, with its unit:
keys in share/summary.schema.json, columns in docs/outputs.md, keys of the resolved case in docs/case-file.md."""
import copy
import json
import os
import re
import shlex

import jsonschema

import harness
from examples import printed_files

COMMAND = re.compile(r"    \./snag (?:-n \d+ )?((?:run|study|observe|calibrate) .*)")
# Two steps of the pump with a small rag show what the whole run would write; variants of it are only checked.
FEW_STEPS = [word for value in ("time.end_ms=1.6", "output.report=false", "rag.0.insert_time_ms=0", "rag.0.length_mm=120", "rag.0.width_mm=80")
             for word in ("--set", value)]
SCHEMA = json.loads((harness.SOURCE_DIR / "share" / "summary.schema.json").read_text())


def documented_columns():
    """{file of monitors/: {column: unit}} of docs/outputs.md."""
    files = {}
    for name, section in re.findall(r"^### (\w+)\.csv\n(.*?)(?=^##|\Z)", (harness.SOURCE_DIR / "docs" / "outputs.md").read_text(), re.M | re.S):
        files[name] = {column: unit for names, unit in re.findall(r"^\| (`[^|]*) \| ([^|]+) \|", section, re.M) for column in re.findall(r"`(\w+)`", names)}
    return files


def pattern(column):
    """Regular expression of the columns that a documented name stands for."""
    return column.replace("PATCH", r"\w+").replace("ZONE", "(rotor|stator)")


def documented_units(columns, name):
    """Units that docs/outputs.md states for a column of a monitor: one, if it is documented once."""
    return [unit for column, unit in columns.items() if re.fullmatch(pattern(column), name)]


class Tutorial(harness.CaseTest):
    """Shared with tutorials_long.py."""

    def run_tutorial(self, name):
        """Run all commands of a page in one folder, in order; the folders results/* that they leave."""
        text = (harness.SOURCE_DIR / "docs" / f"{name}.md").read_text()
        for file, content in printed_files(text).items():
            (self.work / file).write_text(content)
        (self.work / "cases").symlink_to(harness.SOURCE_DIR / "cases")
        before = os.getcwd()
        os.chdir(self.work)
        self.addCleanup(os.chdir, before)
        commands = [shlex.split(re.sub(r"\s+# .*", "", line)) for line in COMMAND.findall(text)]
        self.assertTrue(commands)
        for i, words in enumerate(commands):
            if name == "tutorial-pump":
                words = words + FEW_STEPS + (["--dry-run"] if i else [])
            run = harness.snag(words)
            self.assertEqual(run.code, 0, f"{name}: ./snag {' '.join(words)}\n{run.tail()}")
        print(f"  {name}: {len(commands)} commands")
        return self.work / "results"

    def assert_documented(self, folder):
        """One finished run."""
        jsonschema.validate(json.loads((folder / "summary.json").read_text()), SCHEMA)
        self.assertEqual(harness.undocumented_keys(folder / "case.resolved.toml"), [], "docs/case-file.md")
        written = documented_columns()
        for file in sorted((folder / "monitors").glob("*.csv")):
            columns, _ = re.subn(r"\s+$", "", file.read_text().splitlines()[0])
            for column in columns.split(","):
                name, unit = re.fullmatch(r"(\w+) \[(.+)\]", column).groups()
                self.assertEqual(documented_units(written[file.stem], name), [unit], f"docs/outputs.md, {file.name}: {column}")
            names = [column.split(" [")[0] for column in columns.split(",")]
            for one in written[file.stem]:
                self.assertTrue(any(re.fullmatch(pattern(one), name) for name in names), f"docs/outputs.md, {file.name}: {one} is not written")
        return {file.stem for file in (folder / "monitors").glob("*.csv")}


class Tutorials(Tutorial):
    def test_pump(self):
        seen = self.assert_documented(self.run_tutorial("tutorial-pump") / "pump")
        # All files but the one that needs two revolutions and the one that needs holds (held.py).
        self.assertEqual(set(documented_columns()) - seen, {"phase", "holds"})

    def test_study(self):
        results = self.run_tutorial("tutorial-study")
        runs = [folder for folder in (results / "drop").iterdir() if (folder / "summary.json").exists()]
        self.assertEqual(len(runs), 4)
        for folder in runs:
            self.assert_documented(folder)
        self.assertTrue((results / "drop" / "study.html").is_file())

    def test_film(self):
        results = self.run_tutorial("tutorial-film")
        self.assert_documented(results / "spin")
        for file in ("seen/observations.csv", "seen/statistics.json", "seen/coverage.png", "seen/extent.png", "compared/anova.csv"):
            self.assertTrue((results / file).is_file(), file)

    def test_schema_refuses(self):
        """What is renamed, missing or of another type is seen, in each table of the schema."""
        run = self.run_case(self.case('[case]\nname = "s"\n[time]\nend_ms = 1\nstep_ms = 1\n[[rag]]\nlength_mm = 20\nwidth_mm = 20\nradius_mm = 2\n[output]\nreport = false\n'))
        jsonschema.Draft7Validator.check_schema(SCHEMA)
        jsonschema.validate(run.summary, SCHEMA)

        def spoilt():
            for path in ([], ["mesh"], ["performance"], ["conservation"], ["rags", 0], ["rags", 0, "wall_contact_by_zone_s"]):
                for key in run.summary if not path else ["renamed"]:
                    wrong = copy.deepcopy(run.summary)
                    table = wrong
                    for step in path:
                        table = table[step]
                    table["new"] = table.pop(next(iter(table)) if key == "renamed" else key)
                    yield wrong
            yield run.summary | {"ranks": "1"}
            yield run.summary | {"rags": [run.summary["rags"][0] | {"outcome": "gone"}]}

        for wrong in spoilt():
            with self.assertRaises(jsonschema.ValidationError):
                jsonschema.validate(wrong, SCHEMA)


if __name__ == "__main__":
    harness.main()
