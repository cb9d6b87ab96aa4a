# labels: long
# timeout: 14400
# processors: 3
"""Requirement: kills.py, a thousand times."""
import harness
import kills


class ManyKills(kills.Kills):
    n_kills = int(kills.os.environ.get("SNAG_KILLS", 1000 // 6))
    channel_on = (1, 2, 3)


del kills.Kills

if __name__ == "__main__":
    harness.main()
