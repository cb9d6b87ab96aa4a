# labels: long
# timeout: 1800
"""Requirement: impulsive_sheet.py on cells of half the size."""
import harness
import impulsive_sheet


class OnFineCells(impulsive_sheet.ImpulsiveSheet):
    size = 0.00625


if __name__ == "__main__":
    harness.main()
