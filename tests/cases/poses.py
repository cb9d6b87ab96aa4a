# processors: 2
"""Requirement: a crumpled pose is made before the run, the same on any number of ranks, told and stored; another run and a resume take the stored one."""
import harness

SHEET = """
[case]
name = "crumpled"
[time]
end_s = 0.004
step_s = 1e-3
[[rag]]
length_mm = 120
width_mm = 88
radius_mm = 2
{pose}
[output]
report = false
"""
CONFINED = 'pose = "confined"\nconfine_radius_mm = 28\nconfine_axis = [0, 0, -1]\ncentre_m = [0.1, 0, 0.2]'


class Poses(harness.CaseTest):
    def test_confined(self):
        file = self.case(SHEET.format(pose=CONFINED))
        one, two = self.run_case(file, out="one"), self.run_case(file, 2, out="two")
        stored = one.folder / "rags" / "pose_0.csv"
        self.assertEqual(stored.read_bytes(), (two.folder / "rags" / "pose_0.csv").read_bytes())
        log = (one.folder / "log.txt").read_text()
        self.assertIn("elongation ratio", log)
        self.assertIn("strain of the bonds", log)

        taken = self.run_case(self.case(SHEET.format(pose=f'pose_file = "{stored}"\ncentre_m = [0.1, 0, 0.2]'), "taken"), out="taken")
        self.assertEqual(one.monitor("rags").lines, taken.monitor("rags").lines)
        self.assertNotIn("strain of the bonds", (taken.folder / "log.txt").read_text())

        # A resume takes the pose of the checkpoint, not of a file that may have been damaged since.
        as_made = stored.read_text()
        stored.write_text(as_made.replace("\n1,", "\n1,9", 1))
        (one.folder / "summary.json").unlink()
        resumed = self.run_case(file, 1, "--resume", out="one")
        self.assertNotIn("making the pose", resumed.stdout + resumed.stderr)
        self.assertEqual(as_made, stored.read_text())
        self.assertEqual(two.summary["rags"], resumed.summary["rags"])
        for length in (60, 240):
            refused = self.run_case(file, 1, "--resume", "--set", f"rag.length_mm={length}", out="one", code=2)
            self.assertIn("its pose of", refused.stderr)

    def test_runs_of_a_study_share_it(self):
        """A pose is made once for all runs with the same cloth and seed, and each run is what it is by itself."""
        file = self.case(SHEET.format(pose=CONFINED))
        (self.work / "study.toml").write_text('[study]\ncase = "case.toml"\nresults = ["rags.0.particles"]\n[[vary]]\nkey = "rag.0.seed"\nvalues = [1, 2]\n'
                                              '[[vary]]\nkey = "time.end_ms"\nvalues = [3, 4]\n')
        study = harness.snag(["study", self.work / "study.toml", "--out", self.work / "study"], 2, self.work / "study")
        self.assertEqual(study.code, 0, study.tail())
        self.assertEqual(study.stdout.count("making the pose"), 2, study.stdout)
        logs = [(self.work / "study" / f"seed-{seed}_end_ms-{end}" / "log.txt").read_text() for seed in (1, 2) for end in (3, 4)]
        self.assertEqual(["as made for an earlier run" in log for log in logs], [False, True, False, True])
        alone = self.run_case(file, 2, "--set", "rag.0.seed=2", "--set", "time.end_ms=4", out="alone")
        shared = harness.Run(self.work / "study" / "seed-2_end_ms-4", 0, "", "")
        self.assert_equal_to_the_bit(alone, shared, lambda run: [run.folder / "rags" / "pose_0.csv"])

    def test_errors(self):
        file = self.case(SHEET.format(pose='pose = "confined"\nconfine_radius_mm = 6'))
        self.assertIn("confine_radius", self.run_case(file, 2, code=2).stderr)


if __name__ == "__main__":
    harness.main()
