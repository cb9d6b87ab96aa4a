# timeout: 1800
# labels: long
# processors: 3
# cost: 30
"""Requirement: [time] step = "auto" finds the same step on three ranks as on one."""
import harness
from auto_step import AutoStepCase


class OnThreeRanks(AutoStepCase):
    @harness.parallel
    def test_the_same_step_on_three_ranks(self):
        self.takes_the_same_step_on(3)


if __name__ == "__main__":
    harness.main()
