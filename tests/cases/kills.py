# timeout: 300
# cost: 40
# processors: 3
"""Requirement: a run is killed several times at random moments and resumed each time. Its monitors, rags and summary then equal those of the uninterrupted run, on 1, 2 and 3 ranks."""
import os
import random
import shutil
import signal
import subprocess
import time

import harness
from small_cases import CHANNEL, CHANNEL_MESH, SMALL_SHEETS

CHECKPOINTS = "[checkpoint]\ninterval_s = {}\n"


class Kills(harness.CaseTest):
    n_kills = 1  # at least, of each case and number of ranks

    def sheets(self):
        return self.case(SMALL_SHEETS + CHECKPOINTS.format(8e-4), "sheets")

    def channel(self):
        text = CHANNEL.format(mesh=self.mesh(*CHANNEL_MESH), kernel="cell").replace("end_s = 0.05", "end_s = 0.012")
        return self.case(text + CHECKPOINTS.format(2e-3), "channel")

    def kill(self, run):
        """All processes of a run at once, as when the computer goes down; returns when none is left."""
        ranks = harness.program_processes(run)
        for process in [*ranks, run.pid]:
            try:
                os.kill(process, signal.SIGKILL)
            except ProcessLookupError:
                pass
        run.communicate()
        for process in ranks:
            harness.wait_for_the_end_of(process)

    def names(self, folder):
        """Of all files: nothing half written, no lock is left."""
        return sorted(str(file.relative_to(folder)) for file in folder.rglob("*") if file.is_file())

    def has_checkpoint(self, folder):
        return any(b"\nsnag checkpoint: " in slot.read_bytes()[-64:] for slot in folder.glob("checkpoint/*.h5"))

    def start(self, case, ranks, folder):
        how = "--resume" if self.has_checkpoint(folder) else "--overwrite"
        return harness.start(["run", case, "--out", folder, how], ranks)

    def chain(self, case, ranks, folder, longest):
        """Starts and resumes a run in a folder, killed after random times, until it ends by itself; returns the number of kills."""
        for kills in range(1000):
            run = self.start(case, ranks, folder)
            try:
                # Longer and longer, so that the run ends on a machine that has become busy, too.
                stdout, stderr = run.communicate(timeout=random.uniform(0, longest * 1.1**kills))
            except subprocess.TimeoutExpired:
                self.kill(run)
                continue
            self.assertEqual(run.returncode, 0, f"after {kills} kills on {ranks} ranks\n{stdout}{stderr}")
            return kills
        raise AssertionError(f"the run never ended within {longest} s")

    def campaign(self, case, ranks):
        begun = time.monotonic()
        whole = self.run_case(case, ranks, out=f"whole-{ranks}")
        longest = 1.5 * (time.monotonic() - begun)
        kills = chains = 0
        while kills < self.n_kills:
            folder = self.work / "killed"
            kills += self.chain(case, ranks, folder, longest)
            chains += 1
            self.assert_equal_to_the_bit(whole, harness.Run(folder, 0, "", ""), lambda run: sorted((run.folder / "rags").iterdir()))
            self.assertEqual(self.names(whole.folder), self.names(folder))
            shutil.rmtree(folder)
        print(f"  {case.stem} on {ranks} ranks: {kills} kills in {chains} runs, all equal to the uninterrupted run")

    channel_on = (2,)  # ranks

    def test_sheets(self):
        self.campaign(self.sheets(), 1)

    @harness.parallel
    def test_sheets_on_ranks(self):
        for ranks in (2, 3):
            self.campaign(self.sheets(), ranks)

    @harness.parallel
    def test_channel(self):
        for ranks in self.channel_on:
            self.campaign(self.channel(), ranks)


if __name__ == "__main__":
    harness.main()
