# timeout: 600
# processors: 3
# cost: 25
"""Requirement: a two-way coupled run agrees to 1e-6 in every physical column of its monitors on any number of ranks."""
import numpy

import harness
from small_cases import CHANNEL, COARSE_CHANNEL_MESH


class CoupledRunOnAnyNumberOfRanks(harness.CaseTest):
    """20 steps on a coarse mesh; rank_independence_coupled_long.py has 50 on a finer one, and more numbers of ranks."""

    n_steps, channel_mesh = 20, COARSE_CHANNEL_MESH
    ranks = {"cell": (3,), "gaussian": (2, 5)}  # that are compared with one rank

    def agree(self, kernel):
        case = self.case(CHANNEL.format(mesh=self.mesh(*self.channel_mesh), kernel=kernel).replace("end_s = 0.05", f"end_s = {self.n_steps * 1e-3}"))
        one = self.run_case(case, 1, out="1")
        self.assertEqual(one.summary["time_steps"], self.n_steps)
        force = one.monitor("coupling").column("force_on_rags_x")
        self.assertGreater(numpy.abs(force).max(), 1e-4, "water and rag must exchange momentum, else the case shows nothing")
        for ranks in self.ranks[kernel]:
            other = self.run_case(case, ranks, out=str(ranks))
            for monitor in ("rags", "contacts", "coupling", "patches", "residuals"):
                self.assert_monitors_agree(one, other, monitor, 1e-6)

    def test_cell_kernel(self):
        self.agree("cell")

    def test_gaussian_kernel(self):
        self.agree("gaussian")


if __name__ == "__main__":
    harness.main()
