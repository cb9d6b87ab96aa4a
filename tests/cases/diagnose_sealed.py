# timeout: 600
# cost: 20
# processors: 2
"""Requirement: the blind benchmark of the diagnosis goes on where it stopped, and its scores are no worse than chance allows."""
import harness
from diagnose import assert_no_score_is_worse_than_chance


class Sealed(harness.CaseTest):
    def test_blind_benchmark_of_the_sphere(self):
        """Two sealed sets of level L2: no score may be worse than chance allows if its target is true; and rows are not done twice."""
        options = ["diagnose", "--bench", "L2", "--twin", "sphere", "--seed", "1"]
        few = harness.snag([*options, "--n", "1", "--out", self.work / "bench"], 2, self.work / "bench")
        self.assertEqual(few.code, 0, few.tail())
        begun = (few.folder / "rows.csv").read_text()
        run = harness.snag([*options, "--n", "2", "--out", self.work / "bench"], 2, self.work / "bench")
        self.assertEqual(run.code, 0, run.tail())
        rows = (run.folder / "rows.csv").read_text()
        self.assertTrue(rows.startswith(begun), "rows that were there were done again")
        self.assertEqual(rows.count("\n"), 3)
        self.assertEqual((run.folder / "sealed.log").read_text().count("sha256"), 2)
        print(run.stdout)
        assert_no_score_is_worse_than_chance(self, run)
        self.assertIn("<svg", (run.folder / "report.html").read_text())


if __name__ == "__main__":
    harness.main()
