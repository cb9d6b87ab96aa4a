# timeout: 600
# cost: 20
# processors: 3
"""Requirement: a run that was stopped or crashed and then resumed equals the uninterrupted one, to the bit on the same ranks, to solver tolerance on others."""
import os
import signal

import harness
from small_cases import CHANNEL, COARSE_CHANNEL_MESH, K_EPSILON

STEP = 1e-3  # s


class ResumedRun(harness.CaseTest):
    """24 steps on a coarse mesh; resume_long.py has 50 on a finer one."""

    n_steps, n_before_checkpoint, n_before_stop, channel_mesh = 24, 14, 4, COARSE_CHANNEL_MESH

    def channel(self):
        text = CHANNEL.format(mesh=self.mesh(*self.channel_mesh), kernel="gaussian").replace("end_s = 0.05", f"end_s = {self.n_steps * STEP}")
        return self.case(text + f"[checkpoint]\ninterval_s = {self.n_before_checkpoint * STEP}\n")

    def assert_every_step_once(self, run):
        for file in (run.folder / "monitors").glob("*.csv"):
            monitor = run.monitor(file.stem)
            times = monitor.column("time")
            self.assertTrue((times[1:] > times[:-1]).all(), f"{file.name}: lines twice or out of order")
            if file.stem != "silhouettes":
                self.assertEqual(len(times), self.n_steps, file.name)

    def assert_equal(self, whole, resumed):
        self.assertGreaterEqual(len(self.final_fields(whole)), 3, "final fields of water, rags and particles must be there")
        self.assert_equal_to_the_bit(whole, resumed, self.final_fields)

    def final_fields(self, run):
        return sorted((run.folder / "fields").glob(f"water_{self.n_steps:06}_*.vtu")) + sorted((run.folder / "rags").glob(f"*_{self.n_steps:06}.vtp"))

    def crash_and_resume(self, ranks):
        case = self.channel()
        whole = self.run_once(case, ranks)
        resumed = self.crashed_and_resumed(whole, case, self.final_fields, self.n_before_checkpoint * STEP)
        self.assert_every_step_once(resumed)
        self.assert_equal(whole, resumed)

    def test_crash_on_one_rank(self):
        self.crash_and_resume(1)

    @harness.parallel
    def test_crash_on_two_ranks(self):
        self.crash_and_resume(2)

    def test_crash_with_turbulence_and_screens(self):
        """The first correction after the resume reads the screens of the sheet."""
        case = self.channel()
        text = case.read_text().replace('velocity_m_s = [0.5, 0, 0]\n\n', 'velocity_m_s = [0.5, 0, 0]\nturbulence_intensity = 0.1\n\n')
        text = text.replace('["free_stream_drag"]', '["free_stream_drag", "sheet_drag"]').replace("viscosity_Pa_s = 0.05", "viscosity_Pa_s = 0.001")
        case = self.case(text + K_EPSILON, "turbulent")
        whole = self.run_once(case, 1)
        resumed = self.crashed_and_resumed(whole, case, self.final_fields, self.n_before_checkpoint * STEP)
        self.assert_equal(whole, resumed)

    def stopped_run(self, case, ranks, stop):
        """A run that is told to stop by stop(mpirun, folder) after some steps; it must end with code 7 and leave steps to do."""
        folder = self.work / "stopped"
        mpirun = harness.start(["run", case, "--out", folder], ranks)
        harness.wait_for_records(folder / "monitors" / "coupling.csv", self.n_before_stop, mpirun)
        stop(mpirun, folder)
        stdout, stderr = mpirun.communicate(timeout=120)
        run = harness.Run(folder, mpirun.returncode, stdout, stderr)
        self.assertEqual(run.code, 7, run.tail())
        self.assertEqual(run.summary["exit"], 7)
        steps = run.summary["time_steps"]
        self.assertTrue(self.n_before_stop <= steps < self.n_steps, f"stopped after {steps} steps")
        print(f"  stopped after {steps} of {self.n_steps} steps on {ranks} ranks")

    def by_signal(self, mpirun, folder):
        os.kill(harness.program_processes(mpirun)[-1], signal.SIGTERM)  # one rank is told, all stop

    def by_signal_to_mpirun(self, mpirun, folder):
        os.kill(mpirun.pid, signal.SIGUSR1)  # which hands it on; a SIGTERM it would answer by killing its ranks

    def by_file(self, mpirun, folder):
        (folder / "stop").touch()

    def test_signal_on_one_rank(self):
        case = self.channel()
        whole = self.run_once(case, 1)
        self.stopped_run(case, 1, self.by_signal)
        resumed = self.run_case(case, 1, "--resume", out="stopped")
        self.assert_every_step_once(resumed)
        self.assert_equal(whole, resumed)

    def test_finished_run_goes_on_to_a_later_end(self):
        case = self.channel()
        whole = self.run_once(case, 1)
        half = whole.summary["simulated_s"] / 2
        self.run_case(case, 1, "--set", f"time.end_s={half}", out="half")
        longer = self.run_case(case, 1, "--resume", out="half")
        self.assert_every_step_once(longer)
        self.assert_equal(whole, longer)

        refused = self.run_case(case, 1, "--resume", "--set", f"time.end_s={half}", out="half", code=2)
        self.assertIn("give a later end", refused.stderr)

    def to_tolerance(self, ranks, stop, resume_ranks):
        case = self.channel()
        whole = self.run_once(case, ranks)
        self.stopped_run(case, ranks, stop)
        resumed = self.run_case(case, resume_ranks, "--resume", out="stopped")
        self.assertEqual(resumed.summary["ranks"], resume_ranks)
        self.assert_every_step_once(resumed)
        for name in ("rags", "contacts", "coupling", "patches", "residuals"):
            self.assert_monitors_agree(whole, resumed, name, 1e-6)

    @harness.parallel
    def test_signal_to_one_of_two_ranks(self):
        self.to_tolerance(2, self.by_signal, 2)

    @harness.parallel
    def test_signal_to_mpirun(self):
        self.stopped_run(self.channel(), 2, self.by_signal_to_mpirun)

    @harness.parallel
    def test_stop_file_and_other_ranks(self):
        self.to_tolerance(2, self.by_file, 3)


if __name__ == "__main__":
    harness.main()
