# labels: long
# timeout: 36000
"""Requirement: the score card of the programs of tests/other_programs is no worse than the recorded one, as far as chance allows, and posteriors
are as wide as they should be.

The seed is another one than that of the recorded rows: SEED is to be drawn anew where the method has been changed with its sets in sight.
"""
import sys

import harness
from diagnose import chance

sys.path.insert(0, str(harness.SOURCE_DIR / "tests" / "other_programs"))
import card  # noqa: E402
import ranks  # noqa: E402
import sets  # noqa: E402

SEED = 5
RECORDED = harness.SOURCE_DIR / "docs" / "scores" / "other-programs.csv"
FOLDER = harness.BINARY_DIR / "diagnose-other-programs"  # kept: a run that was stopped goes on


class Card(harness.CaseTest):
    def compare(self, program, n):
        rows = [row for row in card.run_card(program, sets.CLASSES, n, SEED, FOLDER) if row["seed"] == SEED]
        print(card.card(program, rows))
        recorded = [row for row in card.read_rows(RECORDED) if row["program"] == program]
        for (name, hits, n_now, target), (_, before, n_before, _) in zip(card.scores(program, rows), card.scores(program, recorded)):
            if n_now == 0 or n_before == 0:
                continue
            low, high = card.clopper_pearson(before, n_before)
            at_least = target is None or card.is_least(target)
            with self.subTest(name):
                self.assertGreater(chance(hits, n_now, low if at_least else high, at_least), 0.01, f"{hits} of {n_now}, recorded {before} of {n_before}")

    def test_spheres(self):
        self.compare("sphere", 40)
        strengths, flows, _, _ = ranks.ranks_of_folder(FOLDER / "sphere")
        for name, some in (("strengths", strengths), ("flow", flows)):
            with self.subTest(name):
                self.assertGreater(ranks.uniformity(some), 0.01)

    def test_fibres(self):
        self.compare("fibre", 20)

    def test_rags(self):
        self.compare("rag", 10)


if __name__ == "__main__":
    harness.main()
