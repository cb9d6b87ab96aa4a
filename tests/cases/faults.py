# timeout: 300
# cost: 43
# processors: 2
"""Requirement: whatever operation on a file a run is killed at, before it or in the middle of a write, it resumes to the results of the undisturbed run. On a full or broken disk it ends with code 6 and a message that names file and reason, and resumes once the disk works."""
import collections
import os
import random
import re
import shutil

import harness
from small_cases import CHANNEL, CHANNEL_MESH

LIBRARY = harness.BINARY_DIR / "tests" / "snag-faults.so"
KILLED = (-9, 137)  # of one rank, and of mpirun when it killed one
TIME_LIMIT = 60  # s
REASON = {"full": r"(?i:no space left on device)|only \d+ of \d+ bytes were written", "broken": "Input/output error"}
# Three checkpoints, so that both slots are used and one is replaced; fields between them and at the end.
CASE = CHANNEL.replace("end_s = 0.05", "end_s = 0.003").replace("length_mm = 60\nwidth_mm = 40", "length_mm = 30\nwidth_mm = 20")
CASE = CASE.replace("report = false", "report = false\nfields_interval_s = 2e-3\nrags_interval_s = 2e-3") + "[checkpoint]\ninterval_s = 1e-3\n"
COARSE = [setting.replace("size_mm=16", "size_mm=50") for setting in CHANNEL_MESH]

Operation = collections.namedtuple("Operation", "number name bytes file")


def spread(operations, count):
    """`count` of them: of every kind of operation on every kind of file one, as far as that goes, then evenly over the rest."""
    kinds = collections.defaultdict(list)
    for operation in operations:
        kinds[operation.name, re.sub(r"\d+", "N", operation.file)].append(operation)
    queues = [random.sample(kind, len(kind)) for kind in kinds.values()]
    random.shuffle(queues)
    order = [queue[i] for i in range(max(map(len, queues), default=0)) for queue in queues if i < len(queue)]
    return sorted(order[:count])


class Faults(harness.CaseTest):
    # [ranks][mode] points of a run, and of one that is resumed; None: every operation of rank 0
    of_runs = {1: {"kill": 2, "half": 1, "full": 2, "broken": 1}, 2: {"kill": 1, "full": 1}}
    of_resumed_runs = {1: {"kill": 1, "full": 1}}
    of_meshes = {"half": 1, "full": 1}

    def environment(self, folder, program="snag", **variables):
        """Of the program, and of mpirun and all it starts. The sanitizers of the preset `debug` want to be the first library."""
        fixed = {"FOLDER": folder, "PROGRAM": program, "FLAG": self.work / "flag"}
        values = {f"SNAG_FAULT_{name}": str(value) for name, value in (fixed | variables).items()}
        return values | {"LD_PRELOAD": str(LIBRARY), "ASAN_OPTIONS": "verify_asan_link_order=0"}

    def operations(self, arguments, ranks, folder, program="snag"):
        """Runs the program undisturbed; returns the run and, for each rank, its operations in the folder."""
        log = self.work / "operations"
        run = harness.snag(arguments, ranks, folder, TIME_LIMIT, self.environment(folder, program, LOG=log))
        self.assertEqual(run.code, 0, run.tail())
        of_ranks = []
        for rank in range(ranks):
            file = log.with_name(f"{log.name}.{rank}")
            lines = [line.split(" ", 3) for line in file.read_text().splitlines()] if file.exists() else []
            of_ranks.append([Operation(int(n), name, int(size), os.path.relpath(path, folder)) for n, name, size, path in lines])
            file.unlink(missing_ok=True)
        return run, of_ranks

    def points(self, of_ranks, mode, count):
        """(rank, operation) at which this mode is tried; count None: at all of rank 0."""
        able = [[o for o in operations if mode != "half" or o.bytes > 1] for operations in of_ranks]
        if count is None:
            return [(0, operation) for operation in able[0]]
        share = [count // len(able) + (rank < count % len(able)) for rank in range(len(able))]
        return [(rank, o) for rank, operations in enumerate(able) for o in spread(operations, share[rank])]

    def disturbed(self, arguments, ranks, folder, mode, rank, operation, program="snag"):
        (self.work / "flag").unlink(missing_ok=True)
        environment = self.environment(folder, program, MODE=mode, RANK=rank, AT=operation.number)
        return harness.snag(arguments, ranks, folder, TIME_LIMIT, environment)

    def assert_is_a_message(self, run, mode):
        """Of the full or broken disk: few lines, one of them with the file and the reason."""
        self.assertEqual(run.code, 6, run.tail())
        self.assertTrue(1 <= len(run.messages) <= 3, f"some lines on stderr are wanted, these came:\n{run.stderr}")
        naming = [line for line in run.messages if str(run.folder) in line and re.search(REASON[mode], line)]
        self.assertTrue(naming, f"no line names a file and {REASON[mode]}:\n{run.stderr}")

    # runs

    def result_files(self, run):
        return sorted(file for part in ("fields", "rags", "walls") for file in (run.folder / part).iterdir())

    def names(self, folder):
        return sorted(str(file.relative_to(folder)) for file in folder.rglob("*") if file.is_file())

    def assert_equals(self, whole, folder):
        self.assert_equal_to_the_bit(whole, harness.Run(folder, 0, "", ""), self.result_files)
        self.assertEqual(self.names(whole.folder), self.names(folder))

    def has_checkpoint(self, folder):
        return any(re.search(rb"\nsnag checkpoint: .{16} bytes of CRC-32 .{8}\n$", slot.read_bytes()[-64:]) for slot in folder.glob("checkpoint/*.h5"))

    def gone_on(self, case, ranks, folder):
        """Resumes a run on a sound disk; without a checkpoint the program says so, and the run begins anew. Returns how it began."""
        resumed = harness.snag(["run", case, "--out", folder, "--resume"], ranks, folder, TIME_LIMIT)
        if resumed.code == 0:
            return "resumed"
        self.assertFalse(self.has_checkpoint(folder), f"there is a checkpoint\n{resumed.tail()}")
        self.assertEqual(resumed.code, 6, resumed.tail())
        self.assertRegex(resumed.messages[0], "no valid checkpoint .*run without --resume")
        anew = harness.snag(["run", case, "--out", folder, "--overwrite"], ranks, folder, TIME_LIMIT)
        self.assertEqual(anew.code, 0, anew.tail())
        return "anew"

    def try_run(self, case, whole, begun, ranks, mode, rank, operation):
        """One fault and what follows; `begun` is the folder of a run that is resumed. Returns in a word what became of the run."""
        folder = self.work / "out"
        shutil.rmtree(folder, ignore_errors=True)
        if begun:
            shutil.copytree(begun, folder)
        run = self.disturbed(["run", case, "--out", folder] + ["--resume"] * bool(begun), ranks, folder, mode, rank, operation)
        if run.code == 0 and mode in REASON:  # no result was lost
            (folder / ".lock").unlink(missing_ok=True)  # nobody holds it: a broken disk does not remove it
            self.assert_equals(whole, folder)
            return "harmless"
        if mode in REASON:
            self.assert_is_a_message(run, mode)
            self.assertNotIn("done after", run.stdout)
        else:
            self.assertIn(run.code, KILLED, run.tail())
        how = self.gone_on(case, ranks, folder)
        self.assert_equals(whole, folder)
        return how

    def campaign(self, case, whole, begun, ranks, of_ranks, n_points):
        for mode, count in n_points.items():
            became = collections.Counter()
            for rank, operation in self.points(of_ranks, mode, count):
                with self.subTest(resumed=bool(begun), ranks=ranks, mode=mode, rank=rank, operation=operation):
                    became[self.try_run(case, whole, begun, ranks, mode, rank, operation)] += 1
            print(f"  {mode}: {dict(became)}", flush=True)

    def begun(self, case, ranks, of_ranks):
        """Folder of a run that was killed when its second checkpoint was there."""
        trailers = [o for o in of_ranks[0] if o.name == "write" and o.file.endswith(".h5")]
        folder = self.work / "out"
        self.disturbed(["run", case, "--out", folder], ranks, folder, "kill", 0, of_ranks[0][trailers[1].number + 4])
        return folder.rename(self.work / f"begun-{ranks}")

    def runs_on(self, ranks):
        case = self.case(CASE.format(mesh=self.mesh(*COARSE), kernel="cell"))
        folder = self.work / "out"
        shutil.rmtree(folder, ignore_errors=True)
        run, of_ranks = self.operations(["run", case, "--out", folder], ranks, folder)
        whole = harness.Run(folder.rename(self.work / f"whole-{ranks}"), run.code, run.stdout, run.stderr)
        print(f"\n  a run on {ranks} ranks: {' + '.join(str(len(one)) for one in of_ranks)} operations")
        self.campaign(case, whole, None, ranks, of_ranks, self.of_runs[ranks])
        if ranks not in self.of_resumed_runs:
            return
        shutil.rmtree(folder, ignore_errors=True)
        begun = self.begun(case, ranks, of_ranks)
        shutil.copytree(begun, folder)
        _, of_ranks = self.operations(["run", case, "--out", folder, "--resume"], ranks, folder)
        print(f"  resumed on {ranks} ranks: {' + '.join(str(len(one)) for one in of_ranks)} operations")
        self.campaign(case, whole, begun, ranks, of_ranks, self.of_resumed_runs[ranks])

    def test_runs(self):
        self.runs_on(1)

    @harness.parallel
    def test_runs_on_ranks(self):
        for ranks in sorted(set(self.of_runs) - {1}):
            self.runs_on(ranks)

    # programs that write one file

    def try_mesh(self, sound, mode, operation):
        """A mesh that is made anew over an older one: the file is the older or the new one, never a part."""
        folder = self.work / "mesh"
        file = folder / "made.msh"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        file.write_text("an older mesh")
        run = self.disturbed(self.mesh_arguments(file), 1, folder, mode, 0, operation, "snag-mesh")
        self.assertIn(file.read_bytes(), (b"an older mesh", sound), "half a mesh")
        if mode in REASON and not (run.code == 0 and file.read_bytes() == sound):
            self.assert_is_a_message(run, mode)
        again = harness.snag(self.mesh_arguments(file), 1, folder, TIME_LIMIT)
        self.assertEqual(again.code, 0, again.tail())
        self.assertEqual(file.read_bytes(), sound)

    def mesh_arguments(self, file):
        return ["mesh", "channel", "--out", file, *[word for s in COARSE[1:] for word in ("--set", f"channel.{s}")]]

    def test_mesh(self):
        folder = self.work / "mesh"
        folder.mkdir()
        file = folder / "made.msh"
        _, of_ranks = self.operations(self.mesh_arguments(file), 1, folder, "snag-mesh")
        sound = file.read_bytes()
        print(f"\n  a mesh: {len(of_ranks[0])} operations")
        for mode, count in self.of_meshes.items():
            for _, operation in self.points(of_ranks, mode, count):
                with self.subTest(mode=mode, operation=operation):
                    self.try_mesh(sound, mode, operation)


if __name__ == "__main__":
    harness.main()
