# labels: long
# timeout: 1200
# processors: 3
"""Requirement: many_rags.py with a pile of 240 rags, 15 layers deep: 0.27, 0.32 and 0.35 of a radius are the deepest overlaps of 9, 12 and 15 layers, from 1 on a layer lies inside the other."""
import harness
import many_rags


class LongPile(many_rags.Pile):
    side, layers = 4, 15
    deepest = 0.4


class LongPileOnRanks(many_rags.PileOnRanks):
    side, layers = 4, 15


del many_rags.Pile, many_rags.PileOnRanks, many_rags.ManyRags

if __name__ == "__main__":
    harness.main()
