# labels: long
# timeout: 600
"""Requirement: as of tutorials.py, for the tutorial that calibrates a cloth."""
import harness
from tutorials import Tutorial


class Cloth(Tutorial):
    def test_cloth(self):
        results = self.run_tutorial("tutorial-cloth")
        self.assert_documented(results / "calibrated")
        self.assertTrue((results / "cloth" / "calibration.html").is_file())
        self.assertRegex((results / "calibrated" / "case.resolved.toml").read_text(), 'passport = ".*results/cloth/passport.toml"')


if __name__ == "__main__":
    harness.main()
