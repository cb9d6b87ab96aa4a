# timeout: 600
# processors: 5
"""Requirement: a two-way coupled run agrees to 1e-6 in every physical column of its monitors on 1, 2, 3 and 5 ranks over 50 steps."""
import numpy

import harness
from small_cases import CHANNEL, CHANNEL_MESH


class CoupledRunOnAnyNumberOfRanks(harness.CaseTest):
    def agree(self, kernel):
        case = self.case(CHANNEL.format(mesh=self.mesh(*CHANNEL_MESH), kernel=kernel))
        one = self.run_case(case, 1, out="1")
        self.assertEqual(one.summary["time_steps"], 50)
        force = one.monitor("coupling").column("force_on_rags_x")
        self.assertGreater(numpy.abs(force).max(), 1e-4, "water and rag must exchange momentum, else the case shows nothing")
        for ranks in (2, 3, 5):
            other = self.run_case(case, ranks, out=str(ranks))
            for monitor in ("rags", "contacts", "coupling", "patches", "residuals"):
                self.assert_monitors_agree(one, other, monitor, 1e-6)

    def test_cell_kernel(self):
        self.agree("cell")

    def test_gaussian_kernel(self):
        self.agree("gaussian")


if __name__ == "__main__":
    harness.main()
