# labels: long
# timeout: 1200
# processors: 2
"""Requirement: resume.py, with 50 steps on a finer mesh."""
import harness
import resume
from small_cases import CHANNEL_MESH


class LongResumedRun(resume.ResumedRun):
    n_steps, n_before_checkpoint, n_before_stop, channel_mesh = 50, 30, 8, CHANNEL_MESH


del resume.ResumedRun

if __name__ == "__main__":
    harness.main()
