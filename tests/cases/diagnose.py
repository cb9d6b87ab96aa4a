"""snag diagnose finds what a base case lacks, the same on any number of ranks, goes on after a stop, and refuses what it cannot read."""
# timeout: 600
import csv
import json
import shutil
import unittest

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


def pathlib_copy(source, target):
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(source, target)
    return target


if __name__ == "__main__":
    harness.main()
