"""A diagnosis: the output folder of snag diagnose."""
import functools
import json
import pathlib

from .tables import existing


class Verdict:
    """verdict, wording and effects as words; the rest as data frames and series. `json` is verdict.json as it is."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.json = json.loads(existing(self.folder / "verdict.json", "snag diagnose --out").read_text())
        self.verdict, self.wording, self.effects = self.json["verdict"], self.json["wording"], self.json["effects"]
        self.notes = self.json["notes"]

    @staticmethod
    def is_in(folder):
        return (pathlib.Path(folder) / "verdict.json").is_file()

    @functools.cached_property
    def causes(self):
        """One row for each named cause: share of the gap, nats that are lost without it, probability that it acts, fitted strength."""
        import pandas

        causes = pandas.DataFrame(self.json["causes"], columns=["effect", "share", "nats"]).set_index("effect")
        causes["probability"] = [self.json["acts"].get(name) for name in causes.index]
        return causes.join(self.strengths[["mean", "sd", "unit"]])

    @functools.cached_property
    def strengths(self):
        """Fitted strengths: mean, sd, unit, p that the points agree on them (cochran_p), whether they are far from what is expected."""
        import pandas

        columns = ["mean", "sd", "unit", "cochran_p", "absorbing"]
        rows = {name: {column: found[column] for column in columns} for name, found in self.json["parameters"].items()}
        return pandas.DataFrame.from_dict(rows, orient="index", columns=columns)

    @functools.cached_property
    def probability(self):
        """Of each hypothesis, the likeliest first."""
        import pandas

        return pandas.Series(self.json["probability"], name="probability", dtype=float).sort_values(ascending=False, kind="stable")

    @functools.cached_property
    def evidence(self):
        """One row for each hypothesis that was fitted, nats over none: evidence, and points left out one by one."""
        import pandas

        found = self.json["evidence"]
        table = pandas.DataFrame({name: found[name] for name in ("log_evidence", "leave_one_point_out")})
        return table.join(self.probability).sort_values("log_evidence", ascending=False, kind="stable")

    @functools.cached_property
    def cells(self):
        """Where the gap is: one row for each observable, point and window of time."""
        import pandas

        cells = pandas.DataFrame(self.json["where"])
        windows = [window or (None, None) for window in cells.pop("window_s")]
        cells.insert(3, "begin_s", pandas.Series([w[0] for w in windows], dtype=float))
        cells.insert(4, "end_s", pandas.Series([w[1] for w in windows], dtype=float))
        return cells

    @functools.cached_property
    def curves(self):
        """The paths that differ most, one row for each time: measured with u, base model, with the effect; in the unit of the data."""
        import pandas

        frames = [pandas.DataFrame(curve) for curve in self.json["curves"]]
        return pandas.concat(frames, ignore_index=True) if frames else pandas.DataFrame()

    @functools.cached_property
    def shrinkage(self):
        """By how much the gap at withheld points shrinks, of each hypothesis; empty where that was not computable."""
        import pandas

        found = self.json["shrinkage"]
        if isinstance(found, str):
            return pandas.DataFrame(columns=["mean", "low", "high"])
        named = {name: value for name, value in found.items() if name not in ("rejected", "regression")}
        rows = named | found["rejected"] | {"regression": found["regression"]}
        return pandas.DataFrame.from_dict(rows, orient="index", columns=["mean", "low", "high"])

    @functools.cached_property
    def posterior(self):
        """Draws of the strengths and of the inputs under the leading hypothesis, one row a draw; attrs["units"] has their units.
        ArviZ reads the same file: arviz.from_json(FOLDER / "posterior.json")."""
        import numpy
        import pandas

        found = json.loads(existing(self.folder / "posterior.json", "snag diagnose, unless the verdict is none or blind,").read_text())
        draws = pandas.DataFrame({name: numpy.ravel(chains) for name, chains in found["posterior"].items()})
        draws.attrs["units"] = json.loads(found["posterior_attrs"]["units"])
        return draws

    def __repr__(self):
        return f"Verdict({str(self.folder)!r}): {self.verdict}, {self.wording}" + (f": {', '.join(self.effects)}" if self.effects else "")
