# timeout: 300
# cost: 25
# processors: 2
"""Requirement: a run that was interrupted and resumed gives the summary of the uninterrupted run. A damaged checkpoint and removed monitors are reported. A second run in an output folder that is in use is refused, others leave it alone."""
import os
import pathlib
import shutil
import signal
import time

import harness
from small_cases import CHANNEL, CHANNEL_MESH, SMALL_SHEETS

SHEETS = SMALL_SHEETS + "[checkpoint]\ninterval_s = 0.0036\n"
# A small rag at the outlet of the channel: it has left after some steps.
LEAVING = CHANNEL.replace("end_s = 0.05", "end_s = 0.5\nend_when_rags_left = true").replace("length_mm = 60\nwidth_mm = 40", "length_mm = 20\nwidth_mm = 16")
LEAVING = LEAVING.replace("centre_m = [0.08, 0.05, 0.05]", "centre_m = [0.285, 0.05, 0.05]\nvelocity_m_s = [0.5, 0, 0]").replace("lengthwise = [0.3, 0.2, 0.9]", "lengthwise = [0, 0, 1]")
LONG = ("--set", "time.end_s=40")


class Interrupted(harness.CaseTest):
    def copy(self, run, name):
        shutil.copytree(run.folder, self.work / name)
        return self.work / name

    def resumed_behind_the_end(self, case, ranks):
        """A run to its end, and one that was killed between its last checkpoint and its summary."""
        whole = self.run_case(case, ranks, out="whole")
        (self.copy(whole, "killed") / "summary.json").unlink()
        resumed = self.run_case(case, ranks, "--resume", out="killed")
        self.assert_equal_to_the_bit(whole, resumed, lambda run: sorted((run.folder / "rags").iterdir()))
        for rate in ("dem_particle_steps_per_s", "dem_s", "output_s"):
            self.assertGreater(resumed.summary["performance"][rate], 0)
        return whole

    @harness.parallel
    def test_resume_behind_the_end(self):
        whole = self.resumed_behind_the_end(self.case(SHEETS), 2)
        self.assertGreater(whole.summary["rags"][0]["projected_area_m2"], 0)

    def test_mesh_generator_ends_with_its_command(self):
        """Requirement: `snag mesh` that is killed leaves no mesh generator behind."""
        process = harness.start(["mesh", "box", "--set", "size_m=0.015", "--out", self.work / "box.msh"])
        children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children")
        while not children.read_text():
            time.sleep(0.01)
        generator = int(children.read_text().split()[0])
        time.sleep(0.5)
        self.assertIsNone(process.poll(), "a mesh of more than a million cells takes longer")
        process.kill()
        process.wait()
        try:
            harness.wait_for_the_end_of(generator, timeout=5)
        finally:
            process.communicate()  # ends when the generator, which has the same pipes, has ended

    def test_resume_when_the_rags_have_left(self):
        case = self.case(LEAVING.format(mesh=self.mesh(*CHANNEL_MESH), kernel="cell"))
        whole = self.resumed_behind_the_end(case, 1)
        self.assertEqual(whole.summary["rags"][0]["outcome"], "exited")
        self.assertLess(whole.summary["time_steps"], 500)

    def test_resume_while_the_run_goes_on_without_rags(self):
        """Requirement: with run_on the run ends that long after the last rag has left, also when it is resumed in between."""
        text = LEAVING.replace("end_when_rags_left = true", "end_when_rags_left = true\nrun_on_s = 0.025") + "[checkpoint]\ninterval_s = 0.01\n"
        case = self.case(text.format(mesh=self.mesh(*CHANNEL_MESH), kernel="cell"))
        whole = self.run_case(case, 1, out="whole")
        left = whole.summary["rags"][0]["events"][-1]
        self.assertEqual(left["what"], "exited")
        self.assertAlmostEqual(whole.summary["simulated_s"], left["t_s"] + 0.025, 9)
        killed = self.copy(whole, "killed")
        (killed / "summary.json").unlink()
        max((killed / "checkpoint").glob("*.h5"), key=lambda slot: slot.stat().st_mtime_ns).unlink()
        resumed = self.run_case(case, 1, "--resume", out="killed")
        begun = float(resumed.stdout.split("resumed at ")[1].split(" s")[0])
        self.assertTrue(left["t_s"] < begun < whole.summary["simulated_s"])
        self.assert_equal_to_the_bit(whole, resumed, lambda run: sorted((run.folder / "rags").iterdir()))

    @harness.parallel
    def test_resume_of_a_finished_run(self):
        case = self.case(SHEETS)
        whole = self.run_case(case, 2)
        before = harness.snapshot(whole.folder)
        again = self.run_case(case, 2, "--resume")
        self.assertIn("the run ended at 0.008 s", again.stdout)
        self.assertIn("nothing is changed", again.stdout)
        self.assertEqual(before, harness.snapshot(whole.folder))

    @harness.parallel
    def test_damaged_checkpoint(self):
        """A bit of the time step in the stamp of the newest checkpoint is another one; then one of the other checkpoint, too."""
        case = self.case(SHEETS)
        whole = self.run_case(case, 2, out="whole")
        damaged = self.copy(whole, "damaged")
        newest, other = sorted((damaged / "checkpoint").glob("*.h5"), key=lambda slot: slot.stat().st_mtime_ns, reverse=True)
        for slot, step in ((newest, 20), (other, 18)):
            content = slot.read_bytes()
            place = content.index(b"time_step\0") + content[content.index(b"time_step\0"):].index(step.to_bytes(8, "little"))
            slot.write_bytes(content[:place] + (step ^ 1).to_bytes(8, "little") + content[place + 8:])
            if slot == newest:
                resumed = self.run_case(case, 2, "--resume", out="damaged")
                self.assertRegex(resumed.stdout, rf"warning: .*{newest.name}: damaged: .*{other.name} is read instead: .* at 0.0072 s")
                self.assertIn(f"{newest.name}: damaged", (damaged / "log.txt").read_text())
                self.assert_equal_to_the_bit(whole, resumed, lambda run: sorted((run.folder / "rags").iterdir()))
                newest.write_bytes(slot.read_bytes()[:-1])
        refused = self.run_case(case, 2, "--resume", out="damaged", code=6)
        self.assertRegex(refused.messages[0], rf"no valid checkpoint .*damaged")

    def begun(self, *arguments, ranks=1):
        """A long run that goes on behind its first checkpoint."""
        run = harness.start(["run", self.case(SHEETS), "--out", self.work / "out", *LONG, *arguments], ranks)
        self.addCleanup(lambda: run.poll() is None and os.killpg(run.pid, signal.SIGKILL))
        harness.wait_for_records(self.work / "out" / "monitors" / "contacts.csv", 0 if arguments else 12, run)
        return run

    def ended(self, run, code):
        _, stderr = run.communicate(timeout=60)
        self.assertEqual(run.returncode, code, stderr)
        return stderr

    @harness.parallel
    def test_two_runs_at_once(self):
        first = self.begun(ranks=2)
        holder = harness.program_processes(first)[0]
        for how in ("--resume", "--overwrite"):
            second = self.run_case(self.case(SHEETS), 2, how, *LONG, code=6)
            self.assertEqual(len(second.messages), 1, second.stderr)
            self.assertRegex(second.messages[0], rf"is in use by process \d+ on host {os.uname().nodename}")
            self.assertIn(f"process {holder} on", second.messages[0])
        self.assertIsNone(first.poll(), "the first run goes on")
        os.killpg(first.pid, signal.SIGKILL)
        first.communicate()
        harness.wait_for_the_end_of(holder)
        self.run_case(self.case(SHEETS), 1, "--overwrite")  # a killed run holds nothing
        self.assertFalse((self.work / "out" / ".lock").exists())
        self.assertEqual([], sorted((self.work / "out" / "checkpoint").glob("*.lock")))

    @harness.parallel
    def test_runs_beside_a_run_do_not_disturb_it(self):
        """Runs that begin and end while another one writes checkpoints do not disturb it, whatever files of its own the library of MPI makes."""
        case = self.case(SMALL_SHEETS + "[checkpoint]\ninterval_s = 1e-4\n", "own")
        long = harness.start(["run", case, "--out", self.work / "long", "--set", "time.end_s=0.1"])
        n = 0
        while long.poll() is None:
            self.assertEqual(harness.snag(["--version"]).code, 0)
            n += 1
        self.ended(long, 0)
        self.assertGreater(n, 3)

    def test_two_studies_at_once(self):
        self.case(SHEETS)
        study = self.case('[study]\ncase = "case.toml"\nset = ["time.end_s=40"]\n[[vary]]\nkey = "rag.0.radius_mm"\nvalues = [1, 1.25]\n', "study")
        first = harness.start(["study", study, "--out", self.work / "study"])
        self.addCleanup(lambda: first.poll() is None and os.killpg(first.pid, signal.SIGKILL))
        harness.wait_for_records(self.work / "study" / "radius_mm-1" / "monitors" / "rags.csv", 4, first)
        second = harness.snag(["study", study, "--out", self.work / "study"])
        self.assertEqual(second.code, 6, second.tail())
        self.assertRegex(second.messages[0], "is in use by process")
        self.assertIsNone(first.poll(), "the first study goes on")

    def test_hangup(self):
        run = self.begun()
        os.kill(harness.program_processes(run)[0], signal.SIGHUP)
        self.ended(run, 7)
        self.assertIn("stopped on request (signal 1)", (self.work / "out" / "log.txt").read_text())

    def test_log_of_a_killed_run(self):
        run = self.begun()
        os.kill(harness.program_processes(run)[0], signal.SIGKILL)
        run.communicate()
        self.assertIn("case two-sheets", (self.work / "out" / "log.txt").read_text())

    @harness.parallel
    def test_monitors_removed(self):
        run = self.begun(ranks=2)
        shutil.rmtree(self.work / "out" / "monitors")
        self.assertRegex(self.ended(run, 6), r"monitors/\w+.csv: was removed while the run was writing to it")
        self.begun("--resume")
        self.assertRegex((self.work / "out" / "log.txt").read_text(), r"monitors/rags.csv: does not exist, so records up to .* s are lost")


if __name__ == "__main__":
    harness.main()
