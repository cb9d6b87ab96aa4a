"""Ranks of true values among the draws of their posteriors, of the sets that card.py has diagnosed.

    /usr/bin/python3 tests/other_programs/ranks.py results/other/sphere [...]

Where posteriors are as wide as they should be, the share of the draws below the true value is uniform from 0 to 1 over sets whose truths come
from the prior. Sources: Cook, Gelman and Rubin (2006), J. Comput. Graph. Stat. 15, 675; Talts et al. (2018), arXiv:1804.06788. The truths here
are those of another program, with laws of its own, so that a bias of the laws shows, too.

Sets of the classes single, pair and several count where the leading hypothesis is the truth: posterior.json is of that hypothesis. Such sets
are somewhat clearer than all sets. Ranks are printed of the strengths of the effects, and of the speed of the flow at each point that the fit
uses, an input that is off at each point by its own. Ranks of one set are not quite independent of each other.
"""
import argparse
import importlib
import json
import math
import pathlib
import sys

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import card  # noqa: E402

FLOW = "flow.amplitude"
BINS = 10
LEAST_RANKS = 10  # below, a test of uniformity says nothing


def ranks_of_set(truth, posterior, u_flow, points):
    """Of the strengths and of the flow at the points, [rank] each; None where another hypothesis leads."""
    if set(posterior["posterior_attrs"]["hypothesis"].split("+")) != set(truth["theta"]):
        return None

    def rank(name, value):
        return float(numpy.mean(numpy.ravel(posterior["posterior"][name]) < value))

    return ([rank(name, value) for name, value in truth["theta"].items()],
            [rank(f"{FLOW}@{point}", deviation / u_flow) for point, deviation in zip(points, truth["deviations"][FLOW])])


def ranks_of_folder(folder):
    """Of DIR/PROGRAM of card.py: ranks of the strengths, of the flow, number of sets, number of those that count."""
    program = importlib.import_module(folder.name)
    u_flow, points = program.INPUTS[FLOW], "ABCDEFG"[:program.N_TRAINING]
    strengths, flows, n_sets, n_right = [], [], 0, 0
    for sealed in sorted((folder / "sealed").glob("*.json")):
        truth, out = json.loads(sealed.read_text()), folder / "sets" / sealed.stem / "out"
        if truth["kind"] not in card.LIBRARY or not (out / "verdict.json").exists():
            continue
        n_sets += 1
        file = out / "posterior.json"
        ranks = ranks_of_set(truth, json.loads(file.read_text()), u_flow, points) if file.exists() else None
        if ranks is not None:
            n_right += 1
            strengths += ranks[0]
            flows += ranks[1]
    return strengths, flows, n_sets, n_right


def uniformity(ranks):
    """p of Kolmogorov and Smirnov's test; Stephens (1970), J. R. Stat. Soc. B 32, 115."""
    x, n = numpy.sort(ranks), len(ranks)
    distance = max(numpy.max(numpy.arange(1, n + 1) / n - x), numpy.max(x - numpy.arange(n) / n))
    scaled = (math.sqrt(n) + 0.12 + 0.11 / math.sqrt(n)) * distance
    return min(1.0, 2 * sum((-1) ** (k - 1) * math.exp(-2 * (k * scaled) ** 2) for k in range(1, 101)))


def line(name, ranks):
    """A row of the table of docs/diagnosis-scores.md."""
    x, n = numpy.array(ranks), len(ranks)
    cells = [name, str(n), " ".join(str(count) for count in numpy.histogram(x, BINS, (0, 1))[0])]
    for share in (0.5, 0.9):
        inside = int(numpy.sum(numpy.abs(x - 0.5) <= share / 2))
        cells.append("{:.2f}, {:.2f} to {:.2f}".format(inside / n, *card.clopper_pearson(inside, n)) if n else "-")
    cells.append(f"{uniformity(x):.2f}" if n >= LEAST_RANKS else "-")
    return "| " + " | ".join(cells) + " |"


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("folders", type=pathlib.Path, nargs="+", help="DIR/PROGRAM of card.py")
    print(f"| true value | ranks | counts in {BINS} bins from 0 to 1 | in the 50 % interval | in the 90 % interval | p, uniform |\n|---|---|---|---|---|---|")
    for folder in arguments.parse_args().folders:
        strengths, flows, n_sets, n_right = ranks_of_folder(folder)
        print(line(f"{folder.name}s, strengths ({n_right} of {n_sets} sets)", strengths))
        print(line(f"{folder.name}s, {FLOW} of each point", flows))


if __name__ == "__main__":
    main()
