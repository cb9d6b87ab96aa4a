# labels: long
# timeout: 1200
# processors: 3
"""Requirement: many_rags.py with a pile of 240 rags."""
import harness
import many_rags


class LongPile(many_rags.Pile):
    side, layers = 4, 15


class LongPileOnRanks(many_rags.PileOnRanks):
    side, layers = 4, 15


del many_rags.Pile, many_rags.PileOnRanks, many_rags.ManyRags

if __name__ == "__main__":
    harness.main()
