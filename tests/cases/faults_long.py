# labels: long
# timeout: 28800
# processors: 3
"""Requirement: faults.py at every operation of a run on one rank (or at SNAG_FAULTS of them), and at a sample on two and three ranks."""
import os

import faults
import harness

COUNT = os.environ.get("SNAG_FAULTS", "all")
EVERY = None if COUNT == "all" else int(COUNT)
SAMPLE = 40 if COUNT == "all" else max(1, int(COUNT) // 4)
MODES = os.environ.get("SNAG_FAULT_MODES", "kill half full broken").split()


class ManyFaults(faults.Faults):
    of_runs = {1: dict.fromkeys(MODES, EVERY), 2: dict.fromkeys(MODES, SAMPLE), 3: dict.fromkeys(MODES, SAMPLE)}
    of_resumed_runs = {1: dict.fromkeys(MODES, EVERY), 2: dict.fromkeys(MODES, SAMPLE)}
    of_meshes = dict.fromkeys(MODES, EVERY)


del faults.Faults

if __name__ == "__main__":
    harness.main()
