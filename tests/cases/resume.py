# timeout: 600
# processors: 3
"""Requirement: a run that was stopped and resumed equals the uninterrupted one, to the bit on the same ranks, to solver tolerance on others."""
import os
import signal

import harness
from small_cases import CHANNEL, CHANNEL_MESH


class ResumedRun(harness.CaseTest):
    def channel(self):
        return self.case(CHANNEL.format(mesh=self.mesh(*CHANNEL_MESH), kernel="gaussian"))

    def stopped_run(self, case, ranks, stop, out):
        """A run that is told to stop by stop(mpirun, folder) after some steps; it must end with code 7 and leave steps to do."""
        folder = self.work / out
        mpirun = harness.start(["run", case, "--out", folder], ranks)
        harness.wait_for_records(folder / "monitors" / "coupling.csv", 8, mpirun)
        stop(mpirun, folder)
        stdout, stderr = mpirun.communicate(timeout=120)
        run = harness.Run(folder, mpirun.returncode, stdout, stderr)
        self.assertEqual(run.code, 7, run.tail())
        self.assertEqual(run.summary["exit"], 7)
        steps = run.summary["time_steps"]
        self.assertTrue(8 <= steps < 50, f"stopped after {steps} of 50 steps")
        print(f"  stopped after {steps} of 50 steps on {ranks} ranks")

    def by_signal(self, mpirun, folder):
        os.kill(harness.program_processes(mpirun)[-1], signal.SIGTERM)  # one rank is told, all stop

    def by_file(self, mpirun, folder):
        (folder / "stop").touch()

    def assert_no_line_twice(self, run):
        for file in (run.folder / "monitors").glob("*.csv"):
            monitor = run.monitor(file.stem)
            keys = [tuple(monitor.column(name)[i] for name in ("time", "rag") if f"{name} [" in monitor.lines[0]) for i in range(len(monitor.values))]
            self.assertEqual(keys, sorted(set(keys)), f"{file.name}: lines twice or out of order")

    def assert_equal_to_the_bit(self, whole, resumed):
        for file in sorted((whole.folder / "monitors").glob("*.csv")):
            if file.stem == "timing":  # the clock never shows the same twice
                continue
            a, b = (run.monitor(file.stem).lines for run in (whole, resumed))
            for i, (line, other) in enumerate(zip(a, b)):
                self.assertEqual(line, other, f"{file.name}, line {i + 1} of {len(a)}")
            self.assertEqual(len(a), len(b), file.name)
        finals = sorted((whole.folder / "fields").glob("water_000050*.vtu")) + sorted((whole.folder / "rags").glob("*_000050*.vtp"))
        self.assertGreaterEqual(len(finals), 2, "final fields of water and rags must be there")
        for file in finals:
            other = resumed.folder / file.relative_to(whole.folder)
            self.assertEqual(file.read_bytes(), other.read_bytes(), f"{file.name} differs")
        for name in ("rags", "conservation"):
            self.assertEqual(whole.summary[name], resumed.summary[name])

    def stop_and_resume(self, ranks, stop):
        case = self.channel()
        whole = self.run_case(case, ranks, out="whole")
        self.stopped_run(case, ranks, stop, "stopped")
        resumed = self.run_case(case, ranks, "--resume", out="stopped")
        self.assertEqual(resumed.summary["time_steps"], 50)
        self.assert_no_line_twice(resumed)
        self.assert_equal_to_the_bit(whole, resumed)

    def test_signal_on_one_rank(self):
        self.stop_and_resume(1, self.by_signal)

    def test_signal_to_one_of_two_ranks(self):
        self.stop_and_resume(2, self.by_signal)

    def test_stop_file_on_two_ranks(self):
        self.stop_and_resume(2, self.by_file)

    def test_resume_on_other_ranks(self):
        case = self.channel()
        whole = self.run_case(case, 2, out="whole")
        self.stopped_run(case, 2, self.by_file, "stopped")
        resumed = self.run_case(case, 3, "--resume", out="stopped")
        self.assertEqual(resumed.summary["ranks"], 3)
        self.assert_no_line_twice(resumed)
        for name in ("rags", "contacts", "coupling", "patches", "residuals"):
            self.assert_monitors_agree(whole, resumed, name, 1e-6)


if __name__ == "__main__":
    harness.main()
