"""Sets of the programs of tests/other_programs, diagnosed and held against the targets of docs/diagnosis-scores.md, as far as their number allows.

So few sets cannot show that a target is met. They show that it is not missed by far: a test fails where the hits would have a chance of less
than 2 % if the share were the target.
"""
import sys

import harness
from diagnose import chance

sys.path.insert(0, str(harness.SOURCE_DIR / "tests" / "other_programs"))
import card  # noqa: E402

SEED = 7  # of development
# Shares of scores that have no target on the card, by its names, and of all sets that can be distinguished.
ALSO = {"inputs more than 3 u off, 5 sd clear: named": 0.9, "local causes, 5 sd clear: the effect, or outside": 0.75, "outliers: right beside them": 0.9,
        "nulls: says none": 0.95}
ALL_RIGHT = 0.85
LEAST_CHANCE = 0.02


class ScoredSets(harness.CaseTest):
    def rows(self, program, classes, seed=SEED):
        """Rows of the card: the first sets of each class, {class: how many}, or {class: their numbers}."""
        rows = []
        for kind, numbers in classes.items():
            for number in range(numbers) if isinstance(numbers, int) else numbers:
                row, truth, verdict = card.run_set(program, kind, number, seed, self.work)
                print(program.NAME, kind, number, row["truth"], "->", row["said"], row["wording"], round(row["detectability"], 1), row["runs"], row["seconds"], flush=True)
                if row["right"]:
                    self.assert_strengths(truth, verdict)
                rows.append(row)
        return rows

    def assert_strengths(self, truth, verdict):
        for effect, strength in truth["theta"].items():
            found = verdict["parameters"].get(effect)  # by its own name, not as another name of its cause or as local
            if found is not None and truth["kind"] != "local":
                self.assertLess(abs(found["mean"] - strength), 4 * found["sd"], effect)

    def assert_targets(self, program, rows):
        scores = [(name, hits, n, ALSO.get(name, target)) for name, hits, n, target in card.scores(program.NAME, rows)]
        clear = card.told(rows)
        scores.append(("all: right", sum(row["true_enough"] for row in clear), len(clear), ALL_RIGHT))
        for name, hits, n, target in scores:
            if target is None or n == 0:
                continue
            with self.subTest(name):
                self.assertGreater(chance(hits, n, abs(target), card.is_least(target)), LEAST_CHANCE, f"{hits} of {n}, target {target}")
