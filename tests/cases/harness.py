"""What every test of a whole case needs: run the program as a user does, read what it wrote, compare.

A script states its requirement in one sentence in its docstring, holds unittest.TestCases made from CaseTest, and ends with
harness.main(). The program is that of the build folder SNAG_BINARY_DIR; several ranks mean `mpirun -n RANKS`.

A test that needs several processors is marked `@harness.parallel`; `script.py serial` runs the others, `script.py parallel` these alone.
"""
import csv
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
import unittest

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkCellCenters
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPUnstructuredGridReader

BINARY_DIR = pathlib.Path(os.environ["SNAG_BINARY_DIR"])
SOURCE_DIR = pathlib.Path(os.environ["SNAG_SOURCE_DIR"])
sys.path.insert(0, str(SOURCE_DIR / "share" / "python"))
from snag.tables import read_columns  # noqa: E402  (of the source tree)

ENVIRONMENT = dict(
    os.environ,
    OMPI_ALLOW_RUN_AS_ROOT="1",
    OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
    OMPI_MCA_rmaps_base_oversubscribe="1",
    OMPI_MCA_hwloc_base_binding_policy="none",
    OMPI_MCA_btl_base_warn_component_unused="0",
    OMPI_MCA_odls_base_sigkill_timeout="0",  # mpirun otherwise waits two seconds after every run that ends with a code other than 0
)
# mpirun adds its own paragraphs to the stderr of a program that ends with a code other than 0.
MPIRUN_CHATTER = re.compile(
    r"^-{20,}$|^$|^Primary job +terminated normally|^a non-zero exit code\. *Per user-direction|^mpirun detected that one or more processes"
    r"|^a non-zero status, thus causing|^the job to be terminated|^The first process to do so was|^ +Process name:|^ +Exit code:|^\[.*\] +\d+ more process"
    r"|^,?mca_\w+: error in|^MPI_ABORT was invoked|^with errorcode|^NOTE: invoking MPI_ABORT|^You may or may not see output|^exactly when Open MPI kills them"
)


class Monitor:
    """One file of monitors/: names with units, the lines as written, the values [record][column]."""

    def __init__(self, file):
        self.lines = file.read_text().splitlines()
        self.columns = next(csv.reader(self.lines[:1]))
        self.names, _, self.values = read_columns(file)

    def column(self, name):
        """Values of "x" (or of "x [m]")."""
        for i, column in enumerate(self.columns):
            if name in (column, self.names[i]):
                return self.values[:, i]
        raise KeyError(f"no column {name}; there are {self.columns}")

    def physical(self):
        """Columns of the state: neither the clock, nor the route of a linear solver, nor what is left of a quantity that should be zero."""
        return [c for c in self.columns if not re.search(r"iterations|residual|seconds|_s \[s\]$|rebuilt|_rel \[1\]|continuity", c)]


class Run:
    """A finished run: exit code, what it printed, and its output folder."""

    def __init__(self, folder, code, stdout, stderr):
        self.folder, self.code, self.stdout, self.stderr = pathlib.Path(folder), code, stdout, stderr

    @property
    def messages(self):
        """Lines of stderr that the program wrote, without mpirun's own."""
        return [line for line in self.stderr.splitlines() if not MPIRUN_CHATTER.search(line)]

    @property
    def summary(self):
        return json.loads((self.folder / "summary.json").read_text())

    @property
    def physical_summary(self):
        """summary.json without what the clock and the memory gave."""
        return {key: value for key, value in self.summary.items() if key not in ("wall_s", "performance")}

    def monitor(self, name):
        return Monitor(self.folder / "monitors" / f"{name}.csv")

    def tail(self):
        return "\n".join((self.stdout + "\n" + self.stderr).strip().splitlines()[-25:])


def documented_keys():
    """{table: keys} of docs/case-file.md; tables of one name share their entry."""
    tables = {}
    for line in (SOURCE_DIR / "docs" / "case-file.md").read_text().splitlines():
        if heading := re.fullmatch(r"## `\[+([\w.]+)\]+`.*", line):
            keys = tables.setdefault(heading[1], set())
        elif row := re.match(r"\| `(\w+)` \| [^|]* \| [^|]* \|", line):
            keys.add(row[1])
    return tables


def undocumented_keys(resolved):
    """Keys of a resolved file, as "[table] key", that docs/case-file.md lacks."""
    known = documented_keys()
    missing = []

    def look(table, values):
        for key, value in values.items():
            inner = value if isinstance(value, list) and value and isinstance(value[0], dict) else [value] if isinstance(value, dict) else []
            for one in inner:
                look(f"{table}.{key}" if table else key, one)
            if not inner and key not in known.get(table, ()):
                missing.append(f"[{table}] {key}")

    look("", tomllib.loads(resolved.read_text()))
    return missing


def command(arguments, ranks=1):
    launcher = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    return [*launcher, str(BINARY_DIR / "snag"), *map(str, arguments)]


def snag(arguments, ranks=1, folder=None, timeout=600, environment={}):
    """Run the program to its end; `folder` is where its output goes, for Run."""
    process = start(arguments, ranks, environment)
    try:
        stdout, stderr = process.communicate(timeout=timeout)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)  # its own process group
        stdout, stderr = process.communicate()
        raise AssertionError(f"snag {' '.join(map(str, arguments))} on {ranks} ranks took more than {timeout} s\n{stdout}{stderr}") from None
    return Run(folder or ".", process.returncode, stdout, stderr)


def start(arguments, ranks=1, environment={}):
    if Part.chosen == "serial" and ranks > 1:
        raise AssertionError("a test that runs on several ranks must be marked @harness.parallel")
    return subprocess.Popen(
        command(arguments, ranks),
        env=ENVIRONMENT | environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def program_processes(process):
    """Process ids of the program's ranks, lowest first: of those below mpirun, or of the one rank that was started alone."""
    children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children")
    ids = [process.pid, *(int(word) for word in children.read_text().split())]
    return sorted(i for i in ids if pathlib.Path(f"/proc/{i}/comm").read_text().strip() == "snag")


def wait_for_the_end_of(process, timeout=20):
    """Return once a process that is not a child of this one has ended: its files and locks are closed, even if nobody has asked for its exit code."""
    def runs():
        try:
            state = pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
            return state not in "ZX" or len(os.listdir(f"/proc/{process}/task")) > 1
        except (FileNotFoundError, ProcessLookupError):
            return False

    begun = time.monotonic()
    while runs():
        if time.monotonic() - begun > timeout:
            raise AssertionError(f"process {process} is still there after {timeout} s")
        time.sleep(0.02)


def snapshot(folder):
    """Name, time of change and content of every file."""
    return {str(p.relative_to(folder)): (p.stat().st_mtime_ns, p.read_bytes()) for p in sorted(folder.rglob("*")) if p.is_file()}


def wait_for_records(monitor_file, count, process, timeout=120):
    """Return once a monitor holds `count` records; the run must still be going."""
    begun = time.monotonic()
    while time.monotonic() - begun < timeout:
        if monitor_file.exists() and monitor_file.read_text().count("\n") > count:
            return
        if process.poll() is not None:
            raise AssertionError("the run ended before it could be stopped: " + "".join(process.communicate()))
        time.sleep(0.02)
    raise AssertionError(f"{monitor_file} had no {count} records after {timeout} s")


def quantity(column):
    """Columns of one vector are measured against one scale: "vx [m/s]" and "vz [m/s]" -> "v [m/s]"."""
    name, _, unit = column.partition(" [")
    return re.sub(r"(^|(?<=_)|(?<=v)|(?<=w))[xyz]$", "", name) + " [" + unit


def largest_difference(a, b):
    """Largest |a - b| of two monitors' physical columns, relative to the quantity's largest magnitude in a: {column: value}."""
    if a.columns != b.columns or a.values.shape != b.values.shape:
        raise AssertionError(f"monitors differ in shape: {a.columns} {a.values.shape}, {b.columns} {b.values.shape}")
    scale = {}
    for column in a.columns:
        scale[quantity(column)] = max(scale.get(quantity(column), 0), numpy.abs(a.column(column)).max(initial=0))
    differences = {}
    for column in a.physical():
        difference = numpy.abs(a.column(column) - b.column(column)).max(initial=0)
        differences[column] = 0.0 if difference == 0 else difference / scale[quantity(column)]  # not a number stays so, and is no agreement
    return differences


def read_vtk(file):
    """A .pvtu or .vtp as VTK has it."""
    reader = vtkXMLPUnstructuredGridReader() if file.suffix == ".pvtu" else vtkXMLPolyDataReader()
    reader.SetFileName(str(file))
    reader.Update()
    return reader.GetOutput()


def cell_centres(grid):
    centres = vtkCellCenters()
    centres.SetInputData(grid)
    centres.Update()
    return vtk_to_numpy(centres.GetOutput().GetPoints().GetData())


def arrays(attributes):
    """{name with unit: values} of the cell, point or field data of what was read."""
    return {attributes.GetArrayName(i): vtk_to_numpy(attributes.GetArray(i)) for i in range(attributes.GetNumberOfArrays())}


def particles(file):
    """Of a file particles_*.vtp: the places, and the numbers of the rags they belong to."""
    sheet = read_vtk(file)
    return vtk_to_numpy(sheet.GetPoints().GetData()), arrays(sheet.GetPointData())["rag [1]"].astype(int)


def touching_particles(position, rag, diameter):
    """Rags of all pairs of particles of different rags that are nearer than a diameter: [pair][2], the lower number first."""
    pairs = []
    for begin in range(0, len(rag), 500):  # a block against all, so that it fits into memory
        block = slice(begin, begin + 500)
        square = sum((position[block, None, k] - position[None, :, k]) ** 2 for k in range(3))
        one, other = numpy.nonzero((square < diameter**2) & (rag[block, None] < rag[None, :]))
        pairs.append(numpy.stack([rag[block][one], rag[other]], axis=1))
    return numpy.concatenate(pairs)


class CaseTest(unittest.TestCase):
    """Each test has a temporary folder; meshes are made once a script."""

    maxDiff = None

    @classmethod
    def setUpClass(cls):
        cls.shared = pathlib.Path(tempfile.mkdtemp(prefix="snag-case-"))
        cls.finished = {}
        cls.addClassCleanup(shutil.rmtree, cls.shared, ignore_errors=True)

    def setUp(self):
        self.work = pathlib.Path(tempfile.mkdtemp(prefix="snag-case-"))
        self.addCleanup(shutil.rmtree, self.work, ignore_errors=True)

    def mesh(self, kind, *settings):
        """A mesh by `snag mesh KIND`, settings as "key=value"."""
        file = self.shared / (re.sub(r"[^A-Za-z0-9]+", "-", " ".join([kind, *settings])) + ".msh")
        if not file.exists():
            made = snag(["mesh", kind, "--out", file, *[word for s in settings for word in ("--set", f"{kind}.{s}")]])
            self.assertEqual(made.code, 0, made.tail())
        return file

    def case(self, text, name="case"):
        """A case file in the temporary folder."""
        file = self.work / f"{name}.toml"
        file.write_text(text)
        return file

    def run_case(self, file, ranks=1, *arguments, out="out", code=0, timeout=600):
        """Run a case file; fails unless it ends with `code`."""
        run = snag(["run", file, "--out", self.work / out, *arguments], ranks, self.work / out, timeout)
        self.assertEqual(run.code, code, f"exit code of {file} on {ranks} ranks\n{run.tail()}")
        return run

    def run_once(self, file, ranks, *arguments, name=None):
        """A run to its end that several tests of a script look at: the first of them makes it. `name`: of its folder, by default that of
        the case and the number of ranks."""
        name = name or f"{file.stem}-on-{ranks}"
        if name not in self.finished:
            self.finished[name] = self.run_case(file, ranks, *arguments, out=self.shared / name)
        return self.finished[name]

    def crashed_and_resumed(self, whole, case, last_files, resumed_at):
        """Of a run to its end one that goes on after a crash: the finished folder without its last checkpoint and the fields of the end
        is what a crash leaves behind. `last_files`: those of a run that the crashed one has not written; `resumed_at`: time of the
        checkpoint before the last."""
        shutil.copytree(whole.folder, self.work / "crashed")
        slots = sorted((self.work / "crashed" / "checkpoint").glob("*.h5"), key=lambda slot: slot.stat().st_mtime_ns)
        self.assertEqual(len(slots), 2)
        slots[-1].write_bytes(slots[-1].read_bytes()[:-5000])
        for file in last_files(whole):
            (self.work / "crashed" / file.relative_to(whole.folder)).unlink()
        resumed = self.run_case(case, whole.summary["ranks"], "--resume", out="crashed")
        self.assertIn(f"resumed at {resumed_at}", resumed.stdout)
        return resumed

    def assert_equal_to_the_bit(self, whole, resumed, last_files):
        """Summary key by key, monitors line by line, `last_files(whole)` byte by byte."""
        self.assertEqual(whole.physical_summary, resumed.physical_summary)
        for file in sorted((whole.folder / "monitors").glob("*.csv")):
            if file.stem == "timing":  # the clock never shows the same twice
                continue
            a, b = (run.monitor(file.stem).lines for run in (whole, resumed))
            for i, (line, other) in enumerate(zip(a, b)):
                self.assertEqual(line, other, f"{file.name}, line {i + 1} of {len(a)}")
            self.assertEqual(len(a), len(b), file.name)
        files = last_files(whole)
        self.assertTrue(files, "nothing to compare")
        for file in files:
            self.assertEqual(file.read_bytes(), (resumed.folder / file.relative_to(whole.folder)).read_bytes(), f"{file.name} differs")

    def assert_monitors_agree(self, first, second, name, tolerance):
        """Prints the largest difference, so that a creeping loss shows before it fails."""
        differences = largest_difference(first.monitor(name), second.monitor(name))
        worst = max(differences, key=differences.get)
        print(f"  monitors/{name}.csv: {len(differences)} columns, largest difference {differences[worst]:.1e} in {worst}")
        bad = {column: f"{d:.1e}" for column, d in differences.items() if not d <= tolerance}
        self.assertFalse(bad, f"monitors/{name}.csv differs by more than {tolerance:g}")


def parallel(test):
    """Mark of a test that needs several processors."""
    test.parallel = True
    return test


class Part(unittest.TestLoader):
    """The tests of a script that are marked as parallel, those that are not, or all."""

    chosen = "all"

    def getTestCaseNames(self, case):
        is_parallel = lambda name: hasattr(getattr(case, name), "parallel")
        return [name for name in super().getTestCaseNames(case) if Part.chosen == "all" or is_parallel(name) == (Part.chosen == "parallel")]


def main():
    words = sys.argv[:]
    if len(words) > 1 and words[1] in ("serial", "parallel"):
        Part.chosen = words.pop(1)
    unittest.main(argv=words, testLoader=Part(), verbosity=2)
