# timeout: 900
# labels: long
# processors: 3
# cost: 30
"""Requirement: what auto_step.py requires of two ranks holds on three."""
import harness
import auto_step


class OnThreeRanks(auto_step.AutoStep):
    ranks = (3,)


del auto_step.AutoStep  # its tests run in its own script

if __name__ == "__main__":
    harness.main()
