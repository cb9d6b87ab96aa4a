"""Score card of the diagnosis on sealed sets of the programs of this folder, which share nothing with Snag but the format of the data.

    SNAG_BINARY_DIR=build/default /usr/bin/python3 tests/other_programs/card.py --out DIR --program sphere --sets 40 --seed 1

makes the sets (sets.py says what is true of each class and what is right to say of it), diagnoses each without its truth, opens the truth,
writes a row to DIR/PROGRAM/rows.csv and prints the card. What is in rows.csv is not done again; `--rows FILE ...` prints the cards of rows that
are there beside each other, as the table of docs/diagnosis-scores.md. Seeds below 1000 are those of development.

Two names are one where nothing can tell them apart: in water of one density `entrained_water` acts just as `added_mass` does, so that either
of them, or the tie of both, is the other.
"""
import argparse
import csv
import hashlib
import importlib
import json
import math
import os
import pathlib
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import sets  # noqa: E402

PROGRAMS = ("sphere", "fibre", "rag")
COLUMNS = ("program,number,seed,kind,truth,subset,strength,replicates,detectability,clear_of_library,clear_of_forms,gap_over_floor,verdict,said,wording,first,"
           "p_first,p_truth,right,first_right,brier,true_enough,blames_physics,runs,seconds,truth_sha256").split(",")
OF_MEASUREMENT = ("measurement", "clock", "frame_rate", "sign:", "unit:", "scale:", "offset:")
LIBRARY = ("single", "pair", "several")


def normalised(name, same):
    """Names of causes, each once. An effect that acts in a part only, lift@t, is that effect."""
    causes = {one[:-2] if one[-2:] in ("@t", "@x", "@y", "@z") else one for one in name.split("+")}
    return "+".join(sorted({same.get(one, one) for one in causes}))


def said_of(verdict, same):
    """Effects that are named, or the word of the verdict; the tie of two names of one cause names it."""
    if verdict["verdict"] == "effects":
        return normalised("+".join(verdict["effects"]), same)
    tied = {normalised(name, same) for name in verdict["tie"]}
    if verdict["verdict"] == "tie" and len(tied) == 1 and "none" not in tied and "outside" not in tied:
        return tied.pop()
    return verdict["verdict"]


def scored(truth, verdict, seconds, fingerprint):
    same = truth["same_cause"]
    right = {normalised(name, same) for name in truth["right"]}
    true_enough = right | ({"outside"} if truth["kind"] == "local" else set())  # no law of the library acts everywhere, and none is blamed
    probability = {}
    for name, p in verdict["probability"].items():
        one = normalised(name, same)
        probability[one] = probability.get(one, 0.0) + p
    first = max(probability, key=probability.get)
    p_truth = sum(probability.get(name, 0.0) for name in true_enough)
    said = said_of(verdict, same)
    named = said.split("+") if verdict["verdict"] == "effects" else []
    physics = [name for name in named if not name.startswith((*OF_MEASUREMENT, "input:")) and name != "operating_point"]
    return {
        **{key: truth[key] for key in ("program", "number", "seed", "kind", "truth", "subset", "strength", "replicates", "detectability")},
        **{key: "" if truth[key] is None else truth[key] for key in ("clear_of_library", "clear_of_forms")}, "gap_over_floor": truth["gap_over_floor"],
        "verdict": verdict["verdict"], "said": said, "wording": verdict["wording"].replace(",", ";"), "first": first,
        "p_first": probability[first], "p_truth": p_truth, "right": int(said in right), "first_right": int(first in true_enough),
        "brier": (1 - p_truth) ** 2 + sum(p * p for name, p in probability.items() if name not in true_enough),
        "true_enough": int(said in true_enough), "blames_physics": int(bool(physics)),
        "runs": verdict["runs"], "seconds": round(seconds, 2), "truth_sha256": fingerprint,
    }


def diagnosed(folder):
    """Verdict of `snag diagnose` on a set, and how long it took."""
    program = pathlib.Path(os.environ["SNAG_BINARY_DIR"]) / "snag"
    begun = time.monotonic()
    run = subprocess.run([str(program), "diagnose", str(folder / "DIAGNOSIS.toml"), "--out", str(folder / "out")], capture_output=True, text=True)
    if run.returncode != 0:
        raise RuntimeError(f"{folder}: snag diagnose ended with {run.returncode}\n{run.stdout}{run.stderr}")
    return json.loads((folder / "out" / "verdict.json").read_text()), time.monotonic() - begun


def run_set(program, kind, number, seed, folder):
    """Makes, seals, diagnoses, opens, scores."""
    name, fingerprint = sets.make_set(program, kind, number, seed, folder)
    verdict, seconds = diagnosed(folder / "sets" / name)
    text = (folder / "sealed" / f"{name}.json").read_text()
    if hashlib.sha256(text.encode()).hexdigest() != fingerprint:
        raise RuntimeError(f"{name}: not the truth that was sealed before the diagnosis")
    truth = json.loads(text)
    (folder / "sets" / name / "out" / "runs.tsv").unlink(missing_ok=True)  # some MB a set
    return scored(truth, verdict, seconds, fingerprint), truth, verdict


def read_rows(file):
    if not file.exists():
        return []
    with open(file) as lines:
        rows = list(csv.DictReader(lines))
    for row in rows:
        for key, value in row.items():
            try:
                row[key] = float(value)
            except ValueError:
                pass
    return rows


def run_card(name, kinds, n, seed, out):
    """Sets 0 to n - 1 of each class, all classes before the next number, so that a run that is stopped has as many of each."""
    program, folder = importlib.import_module(name), out / name
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "rows.csv"
    done = {(row["kind"], int(row["number"]), int(row["seed"])) for row in read_rows(file)}
    if not file.exists():
        file.write_text(",".join(COLUMNS) + "\n")
    for number in range(n):
        for kind in kinds:
            if (kind, number, seed) in done:
                continue
            row, truth, verdict = run_set(program, kind, number, seed, folder)
            with open(file, "a", newline="") as lines:
                csv.writer(lines).writerow([row[column] for column in COLUMNS])
            mark = "right" if row["right"] else "WRONG"
            print(f"{name} {kind} {number}: {row['truth']} ({row['subset']}), said {row['said']}, {row['wording']}, {mark}, "
                  f"{row['detectability']:.1f} sd, {row['seconds']} s", flush=True)
    return read_rows(file)


def binomial_tail(k, n, p):
    """P(at least k of n)."""
    return sum(math.comb(n, i) * p**i * (1 - p) ** (n - i) for i in range(k, n + 1))


def clopper_pearson(k, n):
    """95 % interval of a share: bounds at which so many, or so few, have a chance of 2.5 %."""

    def bisect(above):
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (low, middle) if above(middle) else (middle, high)
        return (low + high) / 2

    lower = 0.0 if k == 0 else bisect(lambda p: binomial_tail(k, n, p) > 0.025)
    upper = 1.0 if k == n else bisect(lambda p: 1 - binomial_tail(k + 1, n, p) < 0.025)
    return lower, upper


def calibration_error(rows):
    """Mean distance between the probability of the likeliest hypothesis and how often it is right, over ten bins."""
    bins = {}
    for row in rows:
        bins.setdefault(min(9, int(10 * row["p_first"])), []).append(row)
    return sum(abs(sum(r["p_first"] - r["first_right"] for r in bin)) for bin in bins.values()) / max(1, len(rows))


def scores(program, rows):
    """Name, hits, number, target (at least: positive; at most: negative; none) of each score."""
    singles = {"sphere": 0.90, "fibre": 0.85, "rag": 0.75}[program]
    of = lambda *kinds: [row for row in rows if row["kind"] in kinds]  # noqa: E731
    strong = [row for row in of("single") if row["strength"] >= 0.4]
    clear = lambda some, low, high=math.inf: [row for row in some if low <= row["detectability"] < high]  # noqa: E731
    whatever_the_form = lambda some, low: [row for row in some if row["clear_of_forms"] != "" and row["clear_of_forms"] >= low]  # noqa: E731
    right = lambda row: row["right"]  # noqa: E731
    attributed = lambda row: row["verdict"] == "effects" and row["wording"].startswith("attributed")  # noqa: E731
    table = [
        ("single effects of strength >= 1/2, 5 sd clear: named", clear(strong, 5), right, singles),
        ("single effects of strength >= 1/2, 3 to 5 sd clear: named", clear(strong, 3, 5), right, None),
        ("single effects of less strength: named", [row for row in of("single") if row["strength"] < 0.4], right, None),
        ("pairs, 3 sd clear of each other: both right", clear(of("pair"), 3), right, 0.75),
        ("the same, 5 sd clear", clear(of("pair"), 5), right, None),
        ("the same, 3 sd clear with the forms of the laws open", whatever_the_form(of("pair"), 3), right, None),
        ("three to five effects, each 5 sd clear: all right", clear(of("several"), 5), right, 0.70),
        ("the same, 5 sd clear with the forms of the laws open", whatever_the_form(of("several"), 5), right, None),
        ("outside, 5 sd clear: says outside", clear(of("outside"), 5), right, 0.90),
        ("the same, 5 sd clear of the library too", [row for row in of("outside") if row["clear_of_library"] >= 5], right, None),
        ("effects of the library: says outside", of(*LIBRARY), lambda row: row["said"] == "outside", -0.03),
        ("nulls: attributed", of("null"), attributed, -0.05),
        ("nulls: says none", of("null"), right, None),
        ("nulls with wrong noise, 3 repeats or more: says none", of("null_noise", "null_correlated"), right, 0.90),
        ("the same, 2 to 3 times as stated", of("null_noise"), right, None),
        ("the same, correlated", of("null_correlated"), right, None),
        ("inputs more than 3 u off, 5 sd clear: named", clear(of("input"), 5), right, None),
        ("blunders: named", of("blunder"), right, 0.90),
        ("blunders: blamed on physics", of("blunder"), lambda row: row["blames_physics"], -0.0),
        ("local causes, 5 sd clear: the effect is named", clear(of("local"), 5), right, None),
        ("local causes, 5 sd clear: the effect, or outside", clear(of("local"), 5), lambda row: row["true_enough"], None),
        ("outliers: right beside them", of("outliers"), right, None),
        ("stated >= 0.9: right", [row for row in rows if row["p_first"] >= 0.9], lambda row: row["first_right"], 0.90),
        ("the same, of sets that can be distinguished", [row for row in told(rows) if row["p_first"] >= 0.9], lambda row: row["first_right"], None),
    ]
    return [(name, sum(1 for row in some if hit(row)), len(some), target) for name, some, hit, target in table]


def told(rows):
    """Sets whose data show the truth by 3 sd, or whose truth is nothing."""
    return [row for row in rows if row["truth"] == "none" or row["detectability"] >= 3]


def measures(rows):
    """Name, value, number of sets, target as in `scores`."""
    some = told(rows)
    brier = lambda of: sum(row["brier"] for row in of) / max(1, len(of))  # noqa: E731
    return [("calibration error, all sets", calibration_error(rows), len(rows), None),
            ("calibration error, sets that can be distinguished", calibration_error(some), len(some), -0.06),
            ("Brier score, all sets", brier(rows), len(rows), None),
            ("Brier score, sets that can be distinguished", brier(some), len(some), None)]


def is_least(target):
    """Whether a target is a least share; a negative one is a largest share."""
    return math.copysign(1, target) > 0


def judged(target, value):
    """The target in words, and whether it is met."""
    if target is None:
        return "", ""
    at_most = not is_least(target)
    return f"{'<=' if at_most else '>='} {abs(target):g}", "met" if (value <= -target if at_most else value >= target) else "missed"


def card(program, rows):
    """Lines for the terminal."""
    lines = []
    for name, hits, n, target in scores(program, rows):
        if n > 0:
            (low, high), (wanted, met) = clopper_pearson(hits, n), judged(target, hits / n)
            lines.append(f"  {met:7s} {name}: {hits} of {n} = {hits / n:.3f} ({low:.3f} to {high:.3f}) {wanted}")
    for name, value, n, target in measures(rows):
        wanted, met = judged(target, value)
        lines.append(f"  {met:7s} {name}: {value:.3f} of {n} sets {wanted}")
    return "\n".join(lines)


def table(rows):
    """The cards of the programs that have rows, side by side, for docs/diagnosis-scores.md."""
    by_program = {program: some for program in PROGRAMS if (some := [row for row in rows if row["program"] == program])}
    lines = ["| score | target | " + " | ".join(f"{program}s" for program in by_program) + " |", "|---" * (2 + len(by_program)) + "|"]
    for one in zip(*(scores(program, some) for program, some in by_program.items())):
        cells, wanted = [], []
        for name, hits, n, target in one:
            words, met = judged(target, hits / n if n else 0)
            wanted.append(words)
            interval = "{:.2f} to {:.2f}".format(*clopper_pearson(hits, n))
            cells.append(f"{hits} of {n}, {interval}{', **missed**' if met == 'missed' else ''}" if n else "-")
        words = wanted[0] if len(set(wanted)) == 1 else ", ".join([wanted[0]] + [word[3:] for word in wanted[1:]])
        lines.append(f"| {one[0][0]} | {words} | " + " | ".join(cells) + " |")
    for one in zip(*(measures(some) for some in by_program.values())):
        cells = [f"{value:.3f} ({n} sets){', **missed**' if judged(target, value)[1] == 'missed' else ''}" if n else "-" for _, value, n, target in one]
        lines.append(f"| {one[0][0]} | {judged(one[0][3], 0)[0]} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--program", choices=PROGRAMS, default="sphere")
    arguments.add_argument("--sets", type=int, default=40, help="sets of each class")
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--classes", nargs="*", default=list(sets.CLASSES), choices=sets.CLASSES)
    arguments.add_argument("--out", type=pathlib.Path, help="folder of results; what is in it is not done again")
    arguments.add_argument("--rows", type=pathlib.Path, nargs="*", help="files of rows: only their cards beside each other, as in docs/diagnosis-scores.md")
    options = arguments.parse_args()
    if options.rows:
        print(table([row for file in options.rows for row in read_rows(file)]))
    else:
        print(card(options.program, run_card(options.program, options.classes, options.sets, options.seed, options.out)))


if __name__ == "__main__":
    main()
