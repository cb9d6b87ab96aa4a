"""One run: the output folder of snag run."""
import functools
import json
import pathlib

from .case import Case
from .tables import existing, frame


class Run:
    """summary, rags, case; monitor(NAME) for each of `monitors`. A run that still goes on can be read, but has no summary yet."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        existing(self.folder / "case.resolved.toml", "snag run --out")

    @staticmethod
    def is_in(folder):
        return (pathlib.Path(folder) / "case.resolved.toml").is_file()

    @functools.cached_property
    def summary(self):
        """summary.json as it is."""
        return json.loads(existing(self.folder / "summary.json", "a run that has ended").read_text())

    @functools.cached_property
    def rags(self):
        """A data frame with one row a rag."""
        import pandas

        return pandas.DataFrame(self.summary["rags"])

    @functools.cached_property
    def case(self):
        """The case with all its keys, in SI."""
        return Case(self.folder / "case.resolved.toml")

    @property
    def monitors(self):
        """Names of the time series."""
        return sorted(file.stem for file in (self.folder / "monitors").glob("*.csv"))

    def monitor(self, name):
        """A time series as a data frame, as long as it is now; attrs["units"] has the unit of each column."""
        if name not in self.monitors:
            raise KeyError(f"{self.folder} has no monitor {name}; it has {', '.join(self.monitors) or 'none'}")
        return frame(self.folder / "monitors" / f"{name}.csv")

    def __repr__(self):
        return f"Run({str(self.folder)!r}): monitors {', '.join(self.monitors)}"
