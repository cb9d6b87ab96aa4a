# labels: long
# timeout: 14400
# cost: 4000
"""Requirement: drum_in_water.py over a thousand turns."""
import drum_in_water
import harness


class ThousandTurns(drum_in_water.DrumInWater):
    n_turns, kills_at, timeout = 1000, (0.2, 0.5, 0.8), 7200


del drum_in_water.DrumInWater

if __name__ == "__main__":
    harness.main()
