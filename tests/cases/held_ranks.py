# timeout: 120
# processors: 3
"""Requirement: holds, released or moved, give the same on 1, 2 and 3 ranks."""
import harness
import numpy
from held import RELEASED
from held_motion import MOVED
from small_cases import TWO_SHEETS


class HeldOnRanks(harness.CaseTest):
    def agree(self, holds, end):
        case = self.case(TWO_SHEETS.replace("end_s = 0.02", f"end_s = {end}") + holds)
        one = self.run_case(case, 1, out="1")
        for ranks in (2, 3):
            other = self.run_case(case, ranks, out=str(ranks))
            for monitor in ("rags", "contacts", "wall_contacts", "holds"):
                self.assert_monitors_agree(one, other, monitor, 1e-12)
        return one

    def test_released(self):
        self.agree(RELEASED, 0.01)

    def test_moved(self):
        moments = numpy.concatenate([self.agree(MOVED, 0.008).monitor("holds").column(f"moment_{axis}") for axis in "x"])
        self.assertGreater(numpy.abs(moments).max(), 1e-6)


if __name__ == "__main__":
    harness.main()
