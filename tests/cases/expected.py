# timeout: 1200
# cost: 25
"""Requirement: a case of cases/ gives the numbers of its expected.toml, each within its tolerance and for the reason given there.

expected.py CASE [--long]     entries with `long = true` are checked with --long only; the case then runs as it stands, else on one rank and with [short] set = [...].

A cloth is calibrated instead, with the arguments `calibrate = [...]`, or those of [short], and the keys are those of its passport.
"""
import sys
import tomllib

import harness


def looked_up(summary, path):
    """"rags.0.elongation_ratio" in summary.json."""
    for word in path.split("."):
        summary = summary[int(word) if isinstance(summary, list) else word]
    return summary


def out_of_tolerance(entry, found):
    """What is wrong with a number, or "" if nothing: value with absolute or relative tolerance, minimum, maximum, or an exact text."""
    if "minimum" in entry and not found >= entry["minimum"]:
        return f"below {entry['minimum']:g}"
    if "maximum" in entry and not found <= entry["maximum"]:
        return f"above {entry['maximum']:g}"
    if "value" in entry:
        value = entry["value"]
        if isinstance(value, str):
            return "" if found == value else f"not {value}"
        tolerance = entry.get("tolerance", entry.get("tolerance_rel", 0) * abs(value))
        return "" if abs(found - value) <= tolerance else f"not {value:g} within {tolerance:g}"
    return ""


def assert_entries(test, numbers, entries):
    wrong = []
    for entry in entries:
        test.assertTrue(entry["why"], f"{entry['key']}: say why this value is expected")
        test.assertTrue({"value", "minimum", "maximum"} & set(entry), f"{entry['key']}: give value, minimum or maximum")
        found = looked_up(numbers, entry["key"])
        problem = out_of_tolerance(entry, found)
        print(f"  {entry['key']} = {found}" + (f"  WRONG: {problem}" if problem else ""))
        if problem:
            wrong.append(f"{entry['key']} = {found}: {problem} ({entry['why']})")
    test.assertFalse(wrong, "\n".join(wrong))


class Expected(harness.CaseTest):
    def ranks(self, expected):
        return expected.get("ranks", 2) if LONG else 1

    def test_numbers(self):
        folder = harness.SOURCE_DIR / "cases" / CASE
        expected = tomllib.loads((folder / "expected.toml").read_text())
        entries = [e for e in expected["expect"] if LONG or not e.get("long", False)]
        self.assertTrue(entries, "nothing is expected: the test would show nothing")
        numbers = self.calibrated(folder, expected) if "calibrate" in expected else self.summary(folder, expected)
        assert_entries(self, numbers, entries)

    def summary(self, folder, expected):
        shortened = [] if LONG else [word for s in expected.get("short", {}).get("set", []) for word in ("--set", s)]
        return self.run_case(folder / "case.toml", self.ranks(expected), *shortened, "--set", "output.report=false", timeout=expected.get("timeout_s", 600)).summary

    def calibrated(self, folder, expected):
        arguments = expected["calibrate"] if LONG else expected["short"]["calibrate"]
        out = self.work / "out"
        run = harness.snag(["calibrate", folder / "tests.toml", *arguments, "--out", out], self.ranks(expected), out, expected.get("timeout_s", 600))
        self.assertEqual(run.code, 0, run.tail())
        return tomllib.loads((out / "passport.toml").read_text())


if __name__ == "__main__":
    LONG = "--long" in sys.argv
    CASE = next(word for word in sys.argv[1:] if not word.startswith("-"))
    sys.argv = sys.argv[:1]
    harness.main()
