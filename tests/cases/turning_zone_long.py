# labels: long
# timeout: 1200
# processors: 2
"""Requirement: turning_zone.py, over 50 steps, on 1, 2, 3 and 5 ranks."""
import harness
import turning_zone


class LongTurningZone(turning_zone.TurningZone):
    n_steps, n_before_checkpoint = 50, 30
    ranks = {"sliding": (2, 3, 5), "frame": (2, 3, 5)}


del turning_zone.TurningZone

if __name__ == "__main__":
    harness.main()
