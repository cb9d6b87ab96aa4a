# labels: long
# timeout: 1200
# processors: 2
"""Requirement: rank_independence_coupled.py, over 50 steps on a finer mesh, on 1, 2, 3 and 5 ranks."""
import harness
import rank_independence_coupled
from small_cases import CHANNEL_MESH


class LongCoupledRun(rank_independence_coupled.CoupledRunOnAnyNumberOfRanks):
    n_steps, channel_mesh = 50, CHANNEL_MESH
    ranks = {"cell": (2, 3, 5), "gaussian": (2, 3, 5)}


del rank_independence_coupled.CoupledRunOnAnyNumberOfRanks

if __name__ == "__main__":
    harness.main()
