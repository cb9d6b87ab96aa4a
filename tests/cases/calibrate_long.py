# labels: long
# timeout: 1800
# processors: 2
"""Requirement: calibrate.py; the dust cloth drapes as measured, and the independence of numerical parameters is written and does not change the passport."""
import math
import tomllib

import calibrate
import harness


class LongCalibrate(calibrate.Calibrate):
    def test_passport_of_coarse_particles(self):
        """The dust cloth at 5 mm drapes as measured; then a case takes the passport."""
        text = self.calibrate("5mm", 1, "one")
        self.assertEqual(text, self.calibrate("5mm", 2, "two", "--independence"), "the number of ranks must not matter")
        self.assertIn("Independence of numerical parameters", (self.work / "two/calibration.html").read_text())
        for name in ("strip_LW", "strip_CW", "damping", "friction"):
            self.assertTrue((self.work / f"two/pictures/independence_{name}.svg").read_text().startswith("<svg"))
        passport = tomllib.loads(text)
        self.assertEqual([bond["direction"] for bond in passport["bond"]], ["LW", "CW"])
        for picture in passport["textile"]["pictures"]:
            self.assertTrue((self.work / "one" / picture).read_text().startswith("<svg"))
        drape = passport["drape"][0]
        print("  " + ", ".join(f"{key} = {value}" for key, value in drape.items()))
        self.assertLess(abs(drape["area_deviation"]), 0.07)
        self.assertLess(abs(drape["wave_size_deviation"]), 0.03)
        self.assertIn(drape["waves"], [6, 6.5, 7])
        self.assertIn("Grab test lengthwise", (self.work / "one/calibration.html").read_text())
        self.assert_ranges(passport)
        self.assert_case_takes(self.work / "one/passport.toml")

    def test_clamps_counted_twice(self):
        """As published: half of the stiffness and strength."""
        published = tomllib.loads(self.calibrate("5mm", 2, "published", "--as-published"))
        self.assertEqual(published["textile"]["clamps"], "counted twice, as published")
        area, columns = math.pi * 0.005**2, 2 * 0.1 / 0.01
        for bond, force, strain in zip(published["bond"], (172, 70.1), (0.358, 0.264)):
            self.assertAlmostEqual(bond["normal_strength_Pa"] / (force / columns / area), 1, delta=1e-5)
            self.assertAlmostEqual(bond["normal_stiffness_N_m3"] / (force / columns / area / strain / 0.01), 1, delta=1e-5)
        for check in published["check"]:
            self.assertAlmostEqual(check["grab_force_deviation"], -0.5, delta=0.02)


del calibrate.Calibrate

if __name__ == "__main__":
    harness.main()
