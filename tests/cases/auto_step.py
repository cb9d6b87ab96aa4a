# timeout: 300
# processors: 2
# cost: 20
"""Requirement: [time] step = "auto" finds the largest step that is as accurate as asked for, the same on any number of ranks, shows why, and a resumed run takes it without another trial."""
import csv
import json
import shutil
import signal
import time
import tomllib

import jsonschema
import numpy

import harness
from small_cases import pump_case
from turning_zone import RING_WALLS, START, Rings

PERIOD = 0.05  # s
AUTO, ACCURACY = 'step = "auto"\nstep_accuracy = 0.05', 0.05
ROTOR = 'rotation_speed = "1200 rpm"\nramp = "0.01 s"'
BALL = """
[[particle]]
diameter_mm = 4
density_kg_m3 = 1100
position_m = [0.04, 0, 0.056]
insert_time_ms = 130
match_flow_velocity = true
[[wall]]
kind = "patches"
patches = ["impeller_walls", "walls"]
[coupling]
mode = "one_way"
forces = ["schiller_naumann"]
"""


class AutoStepCase(harness.CaseTest):
    def rings(self, time=AUTO, name="auto", end="0.2 s", more="", rotor=ROTOR):
        mesh = self.shared / "rings.msh"
        if not mesh.exists():
            Rings().write(mesh)
        return self.case(pump_case("auto-step", mesh, rotor=rotor, time=f'end = "{end}"\n{time}',
                                   flow_rate_L_s=8, walls=RING_WALLS, more='[turbulence]\nmodel = "k_epsilon"\n' + START + more), name)

    def found(self, ranks=1):
        return self.run_once(self.rings(), ranks)

    def takes_the_same_step_on(self, ranks):
        one = self.found().summary["auto_step"]
        other = self.run_case(self.rings(), ranks, "--set", "time.end_s=0.005", out=f"on-{ranks}").summary["auto_step"]
        self.assertEqual(other["step_s"], one["step_s"])
        for a, b in zip(one["water"], other["water"], strict=True):
            for key in ("head_m", "torque_Nm"):
                self.assertAlmostEqual(a[key] / b[key], 1, delta=1e-3)


class AutoStep(AutoStepCase):
    """auto_step_long.py has three ranks, too."""

    def mean_of_last_revolution(self, steps_per_revolution):
        """Head and torque of a run with a given step."""
        run = self.run_once(self.rings(f"step_s = {PERIOD / steps_per_revolution!r}", f"steps-{steps_per_revolution}"), 1)
        self.assertNotIn("auto_step", run.summary)
        return numpy.array([run.summary["pump"][key] for key in ("head_m", "torque_Nm")])

    def test_the_step_is_the_largest_accurate_one(self):
        """Runs with each step from the start say what the trial says. The error of these blades is of first order in the step."""
        found = self.found().summary["auto_step"]
        self.assertTrue(found["accuracy_reached"], found)
        self.assertEqual(found["accuracy"], ACCURACY)
        self.assertEqual(found["steps_per_revolution"], 120, found)
        coarse, chosen, fine = (self.mean_of_last_revolution(n) for n in (60, 120, 240))
        exact = 2 * fine - chosen
        error = {n: numpy.abs(of / exact - 1) for n, of in ((60, coarse), (120, chosen))}
        print(f"  errors of head and torque at 6 degrees a step {error[60]}, at 3 degrees {error[120]}")
        self.assertLess(error[120].max(), ACCURACY)
        self.assertGreater(error[60].max(), ACCURACY, "a larger step would have done: the case shows nothing")
        for trial in found["water"][:2]:
            n = trial["steps_per_revolution"]
            numpy.testing.assert_allclose([trial["head_error_rel"], trial["torque_error_rel"]], error[n], rtol=0.35)
            numpy.testing.assert_allclose([trial["head_m"], trial["torque_Nm"]], coarse if n == 60 else chosen, rtol=0.005)

    def test_the_trial_is_shown_and_leaves_nothing_else(self):
        run = self.found()
        log = (run.folder / "log.txt").read_text()
        for words in ('[time] step = "auto": 0.000416667 s, 3 degrees a step, 120 steps a revolution, for an accuracy of 5 %', "water alone, mean of revolution 3", "the trial took",
                      "of it for the trial of the step"):
            self.assertIn(words, log)
        resolved = tomllib.loads((run.folder / "case.resolved.toml").read_text())["time"]
        self.assertAlmostEqual(resolved["step_s"], PERIOD / 120, places=15)
        self.assertFalse((run.folder / "step_trial").exists())
        self.assertAlmostEqual(run.summary["time_steps"] * PERIOD / 120, 0.2, places=12)
        self.assertGreater(run.summary["wall_s"], run.summary["auto_step"]["trial_wall_s"])

    def test_summary_and_report_have_the_trial(self):
        run = self.found()
        schema = json.loads((harness.SOURCE_DIR / "share" / "summary.schema.json").read_text())
        jsonschema.validate(run.summary, schema)
        folder = self.work / "reported"
        folder.mkdir()
        for name in ("summary.json", "case.resolved.toml", "log.txt"):  # without fields and monitors nothing is drawn
            shutil.copy(run.folder / name, folder)
        reported = harness.snag(["report", folder])
        self.assertEqual(reported.code, 0, reported.tail())
        page = (folder / "report.html").read_text()
        for words in ("<h2>Time step</h2>", "3 degrees of the rotor, the largest one that gives head and torque within 5 %", "error by the step"):
            self.assertIn(words, page)

    def test_each_run_of_a_study_finds_its_step(self):
        self.rings()
        (self.work / "study.toml").write_text('[study]\nname = "flow"\ncase = "auto.toml"\nset = ["time.end_s=0.005"]\nresults = ["auto_step.step_s", "auto_step.accuracy_reached"]\n'
                                              '[[vary]]\nkey = "boundary.0.flow_rate_L_s"\nname = "flow"\nvalues = [8, 7]\n')
        done = harness.snag(["study", self.work / "study.toml", "--out", self.work / "study"])
        self.assertEqual(done.code, 0, done.tail())
        with open(self.work / "study" / "study.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(float(rows[0]["auto_step.step_s"]), self.found().summary["auto_step"]["step_s"])
        self.assertTrue(all(row["auto_step.step_s"] for row in rows), rows)

    def test_the_resolved_case_is_the_same_run(self):
        run = self.found()
        again = self.run_case(run.folder / "case.resolved.toml", 1, "--set", "time.end_s=0.005", out="again")
        self.assertIn("step_accuracy = 0.05 has no effect", again.stdout)
        self.assertEqual(again.monitor("pump").lines, run.monitor("pump").lines[: len(again.monitor("pump").lines)])

    def test_a_resumed_run_has_no_trial(self):
        case = self.rings()
        begun = self.run_case(case, 1, "--set", "time.end_s=0.01")
        resumed = self.run_case(case, 1, "--set", "time.end_s=0.02", "--resume")
        self.assertNotIn("settling", resumed.stdout)
        self.assertEqual(resumed.summary["auto_step"], begun.summary["auto_step"])
        self.assertEqual(resumed.summary["time_steps"], 48)
        (resumed.folder / "step.json").unlink()
        lost = harness.snag(["run", case, "--out", resumed.folder, "--resume"])
        self.assertEqual(lost.code, 2, lost.tail())
        self.assertIn("step_s of case.resolved.toml", lost.stderr)

    @harness.parallel
    def test_the_same_step_on_two_ranks(self):
        self.takes_the_same_step_on(2)

    def test_a_rag_is_tried_as_well(self):
        """A ball that enters after two and a half revolutions."""
        run = self.run_case(self.rings(more=BALL), 1, "--set", "time.end_s=0.14")
        found = run.summary["auto_step"]
        self.assertEqual(found["rag_accuracy"], 0.03)
        self.assertGreaterEqual(len(found["rag"]), 2)
        chosen = next(one for one in found["rag"] if one["steps_per_revolution"] == found["steps_per_revolution"])
        self.assertLessEqual(max(chosen["path_error_rel"], chosen["impulse_error_rel"]), 0.03)
        self.assertGreater(chosen["path_m"], 0.002)
        self.assertEqual(len({one["duration_s"] for one in found["rag"]}), 1, "compared at the same time")
        self.assertGreater(found["settling_revolutions"] * PERIOD, 0.12, "the water alone goes on until the ball enters")

    def test_degrees(self):
        run = self.run_case(self.rings('step = "auto"\ndegrees_per_step = 7'), 1, "--set", "time.end_ms=2.1")
        self.assertEqual(run.summary["auto_step"]["steps_per_revolution"], 52, "the next whole number above 360/7")
        self.assertEqual(run.summary["auto_step"]["water"], [])
        resolved = tomllib.loads((run.folder / "case.resolved.toml").read_text())["time"]
        self.assertAlmostEqual(resolved["step_s"], PERIOD / 52, places=15)
        self.assertAlmostEqual(resolved["end_s"], 3 * PERIOD / 52, places=15)
        self.assertIn("the next whole step after 0.0021 s", run.stdout)
        again = self.run_case(run.folder / "case.resolved.toml", out="again")
        self.assertEqual(again.summary["time_steps"], 3)

    def test_a_request_to_stop_ends_the_trial(self):
        case, out = self.rings(), self.work / "stopped"
        process = harness.start(["run", case, "--out", out])
        begun = time.monotonic()
        while not (out / "step_trial").exists():
            self.assertLess(time.monotonic() - begun, 60)
            time.sleep(0.01)
        process.send_signal(signal.SIGTERM)
        _, stderr = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 7, stderr)
        self.assertIn("nothing is written yet", stderr)
        self.assertFalse((out / "step_trial").exists())

    def test_check_says_what_happens(self):
        checked = harness.snag(["check", self.rings()])
        self.assertEqual(checked.code, 0, checked.tail())
        for words in ("before the run a trial computes the water alone", "6 degrees, 3 degrees", "within 5 %", "720 to 3900 steps"):
            self.assertIn(words, checked.stdout)

    def test_words_of_errors(self):
        def refused(words, time, **more):
            for command in (["check"], ["run", "--out", self.work / "refused"]):
                run = harness.snag([command[0], self.rings(time, **more), *command[1:]])
                self.assertEqual(run.code, 2, run.tail())
                for word in words:
                    self.assertIn(word, run.stderr)
            self.assertFalse((self.work / "refused").exists())

        refused(["degrees_per_step = 6", "step_accuracy = 0.01", "keep one"], 'step = "auto"\ndegrees_per_step = 6\nstep_accuracy = 0.01')
        refused(["step_s = 0.001", "degrees_per_step = 6", "contradict", "remove one"], "step_ms = 1\ndegrees_per_step = 6")
        refused(["degrees_per_step is 31", "lie between 0.25 and 30"], 'step = "auto"\ndegrees_per_step = 31')
        refused(["atuo", 'did you mean "auto"'], 'step = "atuo"')
        refused(['step = "auto"', "sliding", "degrees_per_step or step_ms"], AUTO, rotor=ROTOR + '\nmotion = "frame"')
        refused(["[rotating_zone]", "rotation_speed", "step_ms"], AUTO, rotor='ramp = "0.01 s"')
        text = self.rings().read_text()
        lacks_pump = self.work / "lacks_pump.toml"
        lacks_pump.write_text(text.replace("[pump]\n", ""))
        run = harness.snag(["check", lacks_pump])
        self.assertEqual(run.code, 2, run.tail())
        self.assertIn("needs [pump]", run.stderr)


if __name__ == "__main__":
    harness.main()
