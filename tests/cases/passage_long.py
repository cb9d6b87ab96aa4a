# labels: long
# timeout: 1200
# processors: 2
"""Requirement: passage.py, on 2 and 3 ranks."""
import harness
import passage


class LongRagThroughRings(passage.RagThroughRings):
    ranks = (2, 3)


del passage.RagThroughRings

if __name__ == "__main__":
    harness.main()
