# timeout: 600
# cost: 30
# processors: 2
"""Requirement: `snag calibrate` makes a textile passport that a case can use and a report (the same on one rank as on two: calibrate_long.py); tests that no cloth gives end with exit code 2 and one clear message."""
import fcntl
import re
import shutil
import tomllib

import expected
import harness

TESTS = harness.SOURCE_DIR / "cases/textile-aro/tests.toml"
SHEET = """[time]
end_s = 1e-3
step_s = 1e-3
[[rag]]
length_mm = 60
width_mm = 60
radius_mm = {radius}
passport = "passport.toml"
[output]
report = false
"""


class Calibrate(harness.CaseTest):
    def refused(self, fragments, replace, by, *arguments):
        text = TESTS.read_text()
        self.assertIn(replace, text)
        file = self.case(text.replace(replace, by, 1), "tests")
        run = harness.snag(["calibrate", file, "--out", self.work / "out", *arguments])
        self.assertEqual(run.code, 2, run.tail())
        self.assertEqual(len(run.messages), 1, f"one message on stderr is wanted, these came:\n{run.stderr}")
        print(f"  2: {run.messages[0]}")
        for fragment in fragments:
            self.assertIn(fragment, run.messages[0])
        self.assertFalse((self.work / "out").exists(), "nothing may be written")

    def test_missing_direction(self):
        text = TESTS.read_text()
        for test, key, direction in (("bending", "CW", "crosswise"), ("elongation", "LW", "lengthwise")):
            block = re.search(rf"\[{test}\.{key}\]\n(?:[^\[\n].*\n)+", text).group(0)
            self.refused([f"[{test}]", direction, "missing"], block, "")

    def test_negative_force(self):
        self.refused(["max_force_mean_N", "-172"], "max_force_mean_N = 172.0", "max_force_mean_N = -172.0")

    def test_thickness_in_the_wrong_unit(self):
        self.refused(["[rag] thickness", "0.77 m", "743.82", "unit"], "thickness_m = 0.77e-3", "thickness_m = 0.77")

    def test_wave_count_that_no_cloth_has(self):
        self.refused(["wave_count_mean", "640", "100"], "wave_count_mean = 6.40", "wave_count_mean = 640")

    def test_strain_beyond_the_contact_radius(self):
        self.refused(["max_strain", "contact radius", "2.2"], "max_strain = 0.358\nmax_elongation_m = 0.0179", "max_strain = 0.70\nmax_elongation_m = 0.0350")

    def test_rag_that_cannot_reach_the_plane(self):
        self.refused(["reach", "overhang"], "overhang_mean_m = 0.034                 # Fig. 2.8 text: mean 33.5 mm\noverhang_range_m = [0.031, 0.036]", "overhang_mean_m = 0.3")

    def test_strip_lighter_than_tissue(self):
        self.refused(["[bending.CW]", "mass_per_area", "0.01"], "mass_per_area_kg_m2 = 0.38", "mass_per_area_kg_m2 = 1e-12")

    def test_overhang_below_a_particle(self):
        self.refused(["overhang", "radius", "--radius"], "overhang_mean_m = 0.021                 # Fig. 2.8 text: mean 21.5 mm\noverhang_range_m = [0.020, 0.024]", "overhang_mean_m = 0.004", "--radius", "5mm")

    def test_radius_near_the_overhang(self):
        """The strip shears at its one bond: no bending stiffness lifts it to the plane."""
        self.refused(["overhang", "--radius", "0.0075"], "", "", "--radius", "7.5mm")

    def test_misspelt_key(self):
        self.refused(["max_elongtion", "max_elongation"], "max_elongation_m = 0.0179", "max_elongtion_m = 0.0179")

    def test_radius_without_unit(self):
        self.refused(["--radius"], "", "", "--radius", "1.5")

    def test_folder_is_checked_first(self):
        """A folder that cannot be made, or that another process writes to, ends the command before anything is computed."""
        (self.work / "file").write_text("in the way")
        taken = self.work / "taken"
        taken.mkdir()
        with open(taken / ".lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            for out, words in ((self.work / "file" / "out", "cannot be written"), (taken, "is in use by")):
                run = harness.snag(["calibrate", TESTS, "--radius", "5mm", "--seeds", "2", "--out", out])
                self.assertEqual(run.code, 6, run.tail())
                self.assertIn(words, run.messages[0])
                self.assertNotIn("calibration of", run.stdout)

    def calibrate(self, radius, ranks, out, *arguments):
        run = harness.snag(["calibrate", TESTS, "--radius", radius, "--seeds", "2", *arguments, "--out", self.work / out], ranks, self.work / out)
        self.assertEqual(run.code, 0, run.tail())
        return (run.folder / "passport.toml").read_text()

    def test_passport(self):
        """On two ranks, with pictures and the numbers of expected.toml; then a case takes it."""
        passport = tomllib.loads(self.calibrate("5mm", 2, "two"))
        entries = tomllib.loads(TESTS.with_name("expected.toml").read_text())["expect"]
        expected.assert_entries(self, passport, [entry for entry in entries if not entry.get("long", False)])
        self.assertEqual([bond["direction"] for bond in passport["bond"]], ["LW", "CW"])
        for picture in passport["textile"]["pictures"]:
            self.assertTrue((self.work / "two" / picture).read_text().startswith("<svg"))
        self.assertIn("Grab test lengthwise", (self.work / "two/calibration.html").read_text())
        self.assert_ranges(passport)
        self.assert_case_takes(self.work / "two/passport.toml")

    def assert_ranges(self, passport):
        for bond in passport["bond"]:
            for name, unit in (("normal_stiffness", "N_m3"), ("tangential_stiffness", "N_m3"), ("bending_stiffness", "N_m3"), ("normal_strength", "Pa")):
                low, high = bond[f"{name}_range_{unit}"]
                self.assertTrue(low <= bond[f"{name}_{unit}"] <= high, f"{name}: {bond[f'{name}_{unit}']} is not in {low} to {high}")
            self.assertLess(bond["normal_stiffness_range_N_m3"][0], bond["normal_stiffness_N_m3"], "the tests scatter")

    def assert_case_takes(self, file):
        shutil.copy(file, self.work)
        self.run_case(self.case(SHEET.format(radius=5)))
        outside = harness.snag(["run", self.case(SHEET.format(radius=3)), "--out", self.work / "outside"])
        self.assertEqual(outside.code, 2, outside.tail())
        self.assertIn("3 mm is outside the calibrated radii 5 mm", outside.messages[0])


if __name__ == "__main__":
    harness.main()
