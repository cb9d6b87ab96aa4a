"""Requirement: the diagnosis says of published experiments and exact solutions what is known to be missing in them (cases/diagnose-*/expected_verdict.toml), and nothing of those in which nothing is missing; data.csv and cases are what make_data.py writes."""
# timeout: 900
# cost: 22
import json
import shutil
import subprocess
import sys
import tomllib

import expected
import harness


class Published(harness.CaseTest):
    long, is_long = {"diagnose-jeffery", "diagnose-tank"}, False  # diagnose_published_long.py has the verdicts on the fibres and in the tank

    def folders(self):
        found = sorted(file.parent for file in (harness.SOURCE_DIR / "cases").glob("diagnose-*/expected_verdict.toml"))
        self.assertGreaterEqual(len(found), 8)
        return found

    def test_verdicts(self):
        for folder in [folder for folder in self.folders() if (folder.name in self.long) == self.is_long]:
            with self.subTest(folder.name):
                run = harness.snag(["diagnose", folder / "DIAGNOSIS.toml", "--out", self.work / folder.name], 1, self.work / folder.name)
                self.assertEqual(run.code, 0, run.tail())
                verdict = json.loads((run.folder / "verdict.json").read_text())
                print(folder.name, verdict["verdict"], verdict["effects"], verdict["wording"], verdict["parameters"])
                # Where two coordinates were measured over time the page shows the ways.
                data = [line.split(",") for line in (folder / "data.csv").read_text().splitlines() if not line.startswith("#")][1:]
                coordinates = {row[3] for row in data if row[2]} & {"x", "y", "z"}
                self.assertEqual('aria-label="Ways"' in (run.folder / "report.html").read_text(), len(coordinates) > 1)
                for entry in tomllib.loads((folder / "expected_verdict.toml").read_text())["expect"]:
                    problem = expected.out_of_tolerance(entry, expected.looked_up(verdict, entry["key"]))
                    self.assertFalse(problem, f"{entry['key']} {problem}: {entry['why']}")

    def test_data_are_what_the_scripts_write(self):
        for folder in self.folders():
            with self.subTest(folder.name):
                copy = self.work / folder.name
                shutil.rmtree(copy, ignore_errors=True)
                copy.mkdir(parents=True)
                shutil.copy(folder / "make_data.py", copy)
                subprocess.run([sys.executable, copy / "make_data.py"], check=True, capture_output=True)
                for file in [folder / "data.csv", *folder.glob("point_*.toml")]:
                    self.assertEqual((copy / file.name).read_text(), file.read_text(), file)


if __name__ == "__main__":
    harness.main()
