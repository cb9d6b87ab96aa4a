"""Outputs of Snag as data frames: cases, runs, studies, verdicts. The package reads and changes nothing.

    import snag
    run = snag.Run("results/pump-demo")
    pump = run.monitor("pump")          # a data frame; pump.attrs["units"] has the unit of each column
    run.summary["pump"]["head_m"], run.rags, run.case["time.end_s"]
    snag.Study("results/drop").runs     # one row a run
    verdict = snag.Verdict("results/diagnose-sphere")
    verdict.causes, verdict.probability, verdict.cells, verdict.posterior

`snag.open(FOLDER)` finds out which of them a folder holds. docs/tutorial-python.md is the tutorial, docs/outputs.md names every column and key.
"""
from .case import Case
from .run import Run
from .study import Study
from .tables import label
from .verdict import Verdict

__all__ = ["Case", "Run", "Study", "Verdict", "label", "open"]


def open(folder):
    """The Run, Study or Verdict of an output folder."""
    for kind in (Verdict, Study, Run):
        if kind.is_in(folder):
            return kind(folder)
    raise FileNotFoundError(f"{folder}: no verdict.json, study.csv or summary.json; give the output folder of snag run, study or diagnose")
