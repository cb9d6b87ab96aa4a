# timeout: 900
# cost: 60
"""Requirement: sets of fibres of another program are diagnosed as what was put into them, as often as docs/diagnosis-scores.md aims at."""
import harness
from scored_sets import ScoredSets

import fibre


class Fibres(ScoredSets):
    def test_sets(self):
        rows = self.rows(fibre, {"null": 1, "single": 1, "blunder": 1})
        self.assert_targets(fibre, rows)
        for row in rows:  # the drag along the axis is that of the base case
            self.assertNotIn("fibre_drag", row["said"].split("+"), row)


if __name__ == "__main__":
    harness.main()
