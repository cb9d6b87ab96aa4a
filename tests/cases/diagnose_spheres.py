# timeout: 900
# cost: 150
"""Requirement: sets of spheres of another program are diagnosed as what was put into them, as often as docs/diagnosis-scores.md aims at."""
import harness
from scored_sets import ScoredSets, card

import sphere


class Spheres(ScoredSets):
    def test_sets_of_every_class(self):
        rows = self.rows(sphere, {"null": 2, "null_noise": 2, "null_correlated": 2, "single": 3, "pair": 3, "outside": 2, "input": 2, "blunder": 2,
                                  "outliers": 2})
        self.assert_targets(sphere, rows + self.several() + [self.local_cause()])

    def several(self):
        """All three effects of each set are named. In the second set an input could stand for one of them; in the third, a law between the two
        forms of the pressure gradient for the lift."""
        rows = self.rows(sphere, {"several": (2, 3)}, seed=1) + self.rows(sphere, {"several": (6,)}, seed=11)
        for row in rows:
            self.assertTrue(row["right"], row)
        return rows

    def local_cause(self):
        """A pressure gradient that acts from a time on is named with that time."""
        row, truth, verdict = card.run_set(sphere, "local", 0, 3, self.work)
        self.assertTrue(row["right"], verdict["probability"])
        (name,) = verdict["effects"]
        found = verdict["local"][name]
        self.assertEqual((found["effect"], found["coordinate"], found["acts"]), ("pressure_gradient", "t", "above"))
        self.assertLess(abs(found["mean"] - truth["other"]["gate_time"]), 4 * found["sd"])
        return row


if __name__ == "__main__":
    harness.main()
