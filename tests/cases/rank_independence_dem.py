# timeout: 300
# processors: 3
"""Requirement: a run of rags alone gives the same numbers to 1e-12 on 1, 2, 3 and 5 ranks after 1000 sub-steps and more."""
import harness
from small_cases import TWO_SHEETS


class RagsOnAnyNumberOfRanks(harness.CaseTest):
    def test_monitors_agree_to_round_off(self):
        case = self.case(TWO_SHEETS)
        one = self.run_case(case, 1, out="1")
        rags = one.monitor("rags")
        self.assertAlmostEqual(rags.column("time")[-1], 0.02, places=12)
        self.assertGreater(one.monitor("contacts").column("contacts").max(), 0, "the sheets must touch themselves or each other, else the case shows nothing")
        for ranks in (2, 3, 5):
            other = self.run_case(case, ranks, out=str(ranks))
            for monitor in ("rags", "contacts", "wall_contacts", "silhouettes"):
                self.assert_monitors_agree(one, other, monitor, 1e-12)


if __name__ == "__main__":
    harness.main()
