"""A study: the output folder of snag study."""
import pathlib

from .run import Run
from .tables import existing


class Study:
    """runs: the table of the study; run(NAME): one of them."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self._file = existing(self.folder / "study.csv", "snag study --out")

    @staticmethod
    def is_in(folder):
        return (pathlib.Path(folder) / "study.csv").is_file()

    @property
    def runs(self):
        """One row a run, by its name: what was varied, the results, the exit code."""
        import pandas

        return pandas.read_csv(self._file, float_precision="round_trip").set_index("run")

    def run(self, name):
        return Run(self.folder / name)

    def __repr__(self):
        return f"Study({str(self.folder)!r}): {len(self.runs)} runs"
