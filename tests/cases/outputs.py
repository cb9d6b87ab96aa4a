# timeout: 300
"""Requirement: a run leaves every file of the documented output folder, each readable by the tools it is meant for and with units in its names."""
import html.parser
import json
import re
import tomllib
import xml.etree.ElementTree

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

import harness
from harness import arrays, read_vtk
from small_cases import CHANNEL, CHANNEL_MESH


def collection(file):
    """[(time, path)] of a .pvd."""
    entries = xml.etree.ElementTree.parse(file).getroot().iter("DataSet")
    return [(float(e.get("timestep")), file.parent / e.get("file")) for e in entries]


class OutputFolder(harness.CaseTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.run_done = None

    def setUp(self):
        super().setUp()
        if OutputFolder.run_done is None:
            text = CHANNEL.format(mesh=self.mesh(*CHANNEL_MESH), kernel="cell").replace("report = false", "fields_interval_s = 5e-3\nrags_interval_s = 2e-3")
            case = self.shared / "case.toml"
            case.write_text(text + "[checkpoint]\ninterval_s = 1e-2\n")
            run = harness.snag(["run", case, "--out", self.shared / "out", "--set", "time.end_s=0.02"], 2, self.shared / "out")
            self.assertEqual(run.code, 0, run.tail())
            OutputFolder.run_done = run
        self.done = OutputFolder.run_done
        self.folder = self.done.folder

    def test_all_files_are_there(self):
        for name in ("case.resolved.toml", "summary.json", "log.txt", "report.html", "walls/walls.vtp", "fields/water.pvd"):
            self.assertTrue((self.folder / name).is_file(), name)
        for monitor in ("residuals", "patches", "rags", "contacts", "wall_contacts", "rag_forces", "silhouettes", "coupling", "timing"):
            self.assertTrue((self.folder / "monitors" / f"{monitor}.csv").is_file(), monitor)
        self.assertTrue(list((self.folder / "rags").glob("*.pvd")))
        self.assertTrue(list((self.folder / "checkpoint").glob("*.h5")))
        self.assertFalse(list(self.folder.rglob("*.tmp*")), "temporary files must not stay behind")

    def test_summary(self):
        summary = self.done.summary
        self.assertEqual((summary["exit"], summary["ranks"], summary["time_steps"]), (0, 2, 20))
        self.assertAlmostEqual(summary["simulated_s"], 0.02, places=12)
        self.assertRegex(summary["case_sha256"], "^[0-9a-f]{64}$")

    def test_monitors_have_units_and_rising_times(self):
        for file in (self.folder / "monitors").glob("*.csv"):
            monitor = self.done.monitor(file.stem)
            for column in monitor.columns:
                self.assertRegex(column, r"^[A-Za-z][A-Za-z0-9_]* \[[^\]]+\]$", f"{file.name}: a name and a unit")
            self.assertTrue(numpy.isfinite(monitor.values).all(), file.name)
            self.assertEqual(monitor.columns[0], "time [s]")
            times = monitor.column("time")
            self.assertTrue((numpy.diff(times) > 0).all(), f"{file.name}: times must rise")
            self.assertAlmostEqual(times[-1], 0.02, places=12)

    def test_water_reads_back(self):
        entries = collection(self.folder / "fields" / "water.pvd")
        self.assertEqual([round(t, 9) for t, _ in entries], [0.0, 0.005, 0.010, 0.015, 0.020])
        self.assertEqual({p.resolve() for _, p in entries}, {p.resolve() for p in (self.folder / "fields").glob("*.pvtu")})
        for time, file in entries:
            grid = read_vtk(file)
            self.assertEqual(grid.GetNumberOfCells(), self.done.summary["mesh"]["cells"])
            found = arrays(grid.GetCellData())
            self.assertLessEqual({"velocity [m/s]", "pressure [Pa]", "solid_fraction [1]"}, set(found))
            for name, values in found.items():
                self.assertTrue(numpy.isfinite(values).all(), f"{file.name}: {name}")
        inner = numpy.abs(found["velocity [m/s]"]).max()
        self.assertTrue(0.1 < inner < 10, f"velocity of {inner} m/s")
        self.assertGreater(found["solid_fraction [1]"].max(), 0)

    def test_rags_read_back(self):
        rags = self.folder / "rags"
        listed = set()
        for file in rags.glob("*.pvd"):
            entries = collection(file)
            self.assertEqual([round(t, 9) for t, _ in entries], [round(0.002 * i, 9) for i in range(11)], file.name)
            listed |= {p.resolve() for _, p in entries}
        self.assertEqual(listed, {p.resolve() for p in rags.glob("*.vtp")})
        for file in sorted(listed):
            sheet = read_vtk(file)
            self.assertEqual(sheet.GetNumberOfPoints(), 15 * 10, file.name)
            if file.name.startswith("rags_"):
                self.assertEqual(sheet.GetNumberOfPolys(), 2 * 14 * 9, "two triangles between four neighbours of the 15 x 10 lattice")
            for name, values in {**arrays(sheet.GetPointData()), **arrays(sheet.GetCellData())}.items():
                self.assertTrue(numpy.isfinite(values).all(), f"{file.name}: {name}")

    def test_walls_read_back(self):
        walls = read_vtk(self.folder / "walls" / "walls.vtp")
        points = vtk_to_numpy(walls.GetPoints().GetData())
        numpy.testing.assert_allclose(points.max(axis=0) - points.min(axis=0), [0.3, 0.1, 0.1], rtol=1e-6)

    def test_resolved_case_is_the_same_case(self):
        resolved = self.folder / "case.resolved.toml"
        read = tomllib.loads(resolved.read_text())
        self.assertEqual(read["time"]["step_s"], 1e-3)
        again = self.work / "again"
        run = harness.snag(["run", resolved, "--out", again], 1, again)
        self.assertEqual(run.code, 0, run.tail())
        self.assertEqual(run.summary["case_sha256"], self.done.summary["case_sha256"])

    def test_report_is_one_file(self):
        """Self-contained: no address of the network and no other file is referred to."""
        text = (self.folder / "report.html").read_text()
        references = []

        class Finder(html.parser.HTMLParser):
            def handle_starttag(self, tag, attributes):
                references.extend(v for k, v in attributes if k in ("src", "href") and v)

        Finder().feed(text)
        outside = [r for r in references if not re.match(r"data:|#", r)]
        self.assertFalse(outside, "the report must hold everything itself")
        self.assertIn(json.loads((self.folder / "summary.json").read_text())["git"], text)

    def test_log_names_version_and_ranks(self):
        log = (self.folder / "log.txt").read_text()
        self.assertIn(self.done.summary["git"], log)
        self.assertRegex(log, r"2 ranks")


if __name__ == "__main__":
    harness.main()
