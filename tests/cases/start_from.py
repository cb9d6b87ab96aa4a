# timeout: 300
# cost: 15
# processors: 3
"""Requirement: a run that starts from another one begins with its water, on any number of ranks and, where asked, on another mesh; what cannot be read is refused."""
import numpy

import harness
from small_cases import CHANNEL_OUTLET_AND_WALLS

# Turbulent water through a channel towards its steady state.
CASE = """
[mesh]
file = "{mesh}"
[time]
end_s = {end}
step_s = 0.02
[flow]
initial_velocity_m_s = [1, 0, 0]
pressure_tolerance = 1e-10
[turbulence]
model = "k_epsilon"
[[boundary]]
patch = "inlet"
kind = "velocity_inlet"
velocity_m_s = [1, 0, 0]
""" + CHANNEL_OUTLET_AND_WALLS + """
[output]
report = false
single_precision = false
fields_interval_s = 1
{more}
"""
FINE = ("channel", "length_mm=1000", "height_mm=100", "width_mm=100", 'cells="hexahedra"', "cells_x=20", "cells_y=6", "cells_z=6", "wall_ratio=1")
COARSE = ("channel", "length_mm=1000", "height_mm=100", "width_mm=100", 'cells="hexahedra"', "cells_x=10", "cells_y=3", "cells_z=3", "wall_ratio=1")
SCALARS = ("pressure [Pa]", "turbulent_kinetic_energy [m2/s2]", "dissipation_rate [m2/s3]")


class Water:
    """Cells of one field output: centres and fields, sorted by place."""

    def __init__(self, file):
        grid = harness.read_vtk(file)
        self.centre = harness.cell_centres(grid)
        order = numpy.lexsort(numpy.round(self.centre, 6).T)
        self.centre = self.centre[order]
        self.field = {name: values[order] for name, values in harness.arrays(grid.GetCellData()).items()}


def first_and_last(run):
    files = sorted((run.folder / "fields").glob("water_*.pvtu"))
    return Water(files[0]), Water(files[-1])


class StartFromAnotherRun(harness.CaseTest):
    def channel(self, name, mesh=FINE, end=0.1, more=""):
        return self.case(CASE.format(mesh=self.mesh(*mesh), end=end, more=more), name)

    def steady(self):
        run = self.run_once(self.channel("steady", end=2), 2)
        (self.work / "steady").symlink_to(run.folder)
        return run

    def test_same_mesh(self):
        steady = self.steady()
        left = first_and_last(steady)[1]
        for ranks in (1, 2, 3):
            run = self.run_case(self.channel("goes_on", more='[initial_flow]\nfrom = "steady"'), ranks, out=f"on_{ranks}")
            self.assertIn("start: water of", (run.folder / "log.txt").read_text())
            begun = first_and_last(run)[0]
            for name in ("velocity [m/s]", *SCALARS):
                self.assertTrue(numpy.array_equal(begun.field[name], left.field[name]), f"{name} on {ranks} ranks")
            self.assertEqual(run.summary["time_steps"], 5)
            patches, before = run.monitor("patches"), steady.monitor("patches")
            self.assertAlmostEqual(patches.column("time")[0], 0.02)
            drop, last = (m.column("inlet_pressure") for m in (patches, before))
            print(f"  {ranks} ranks: pressure drop {drop[0]:.4f} Pa after a step, {last[-1]:.4f} Pa of the steady run")
            self.assertLess(abs(drop[0] - last[-1]), 0.02 * last[-1])

    def test_goes_on(self):
        """A flow that still changes goes on on the same mesh as it would have in its own run, from the first step on."""
        early = self.run_case(self.channel("early"), 2, out="early")
        whole = self.run_case(self.channel("whole", end=0.2), 2, out="whole").monitor("patches")
        goes_on = self.run_case(self.channel("goes_on", more='[initial_flow]\nfrom = "early"'), 1, out="goes_on").monitor("patches")
        self.assertEqual(early.summary["time_steps"], 5)
        for column in ("inlet_pressure", "top_force_x"):
            expected, found = whole.column(column)[5:], goes_on.column(column)
            print(f"  {column}: {found} and {expected} in one run")
            numpy.testing.assert_allclose(found, expected, rtol=1e-6)

    def test_resumed(self):
        """A resume of a run with such a start goes on by itself: the other run may be gone."""
        self.steady()
        case = self.channel("goes_on", more='[initial_flow]\nfrom = "steady"\n[checkpoint]\ninterval_s = 0.04')
        whole = self.run_case(case, 2, out="whole")
        (self.work / "steady").rename(self.work / "gone")
        slots = sorted((whole.folder / "checkpoint").glob("*.h5"), key=lambda slot: slot.stat().st_mtime_ns)
        slots[-1].unlink()
        lines = whole.monitor("patches").lines
        resumed = self.run_case(case, 2, "--resume", out="whole")
        self.assertIn("resumed at 0.08", resumed.stdout)
        self.assertEqual(lines, resumed.monitor("patches").lines)

    def test_another_mesh(self):
        self.steady()
        for source, mesh in ((FINE, COARSE), (COARSE, FINE)):
            name = "coarse" if source is COARSE else "steady"
            if source is COARSE:
                self.run_case(self.channel("coarse", COARSE), 2, out="coarse")
            left = first_and_last(harness.Run(self.work / name, 0, "", ""))[1]
            begun = [
                first_and_last(self.run_case(self.channel("mapped", mesh, 0.02, f'[initial_flow]\nfrom = "{name}"\nmap_nearest_cell = true'), n, out=f"{name}_on_{n}"))[0]
                for n in (1, 3)
            ]
            distance = numpy.linalg.norm(begun[0].centre[:, None] - left.centre[None], axis=2)
            nearest = distance < distance.min(axis=1, keepdims=True) + 1e-9
            for field in SCALARS:
                taken = begun[0].field[field][:, None] == left.field[field][None]
                self.assertTrue((taken & nearest).any(axis=1).all(), f"{field} is not that of a nearest cell")
                self.assertTrue(numpy.array_equal(begun[0].field[field], begun[1].field[field]), f"{field} depends on the ranks")

    def refused(self, code, fragments, case):
        run = self.run_case(case, 2, out="refused", code=code)
        self.assertEqual(len(run.messages), 1, run.stderr)
        print(f"  {code}: {run.messages[0]}")
        for fragment in fragments:
            self.assertIn(fragment, run.messages[0])
        self.assertFalse((self.work / "refused" / "log.txt").exists())

    def test_refused(self):
        self.refused(6, ["[initial_flow]", "absent", "no valid checkpoint"], self.channel("a", more='[initial_flow]\nfrom = "absent"'))
        self.run_case(self.channel("coarse", COARSE), 1, out="coarse")
        self.refused(2, ["90 cells", "720", "map_nearest_cell = true"], self.channel("b", more='[initial_flow]\nfrom = "coarse"'))
        self.refused(2, ["[initial_flow]", "other positions", "map_nearest_cell = true"], self.shifted())
        self.refused(2, ["[initial_flow]", "no water"], self.case('[time]\nend_s = 1\nstep_s = 1\n[initial_flow]\nfrom = "coarse"\n[[rag]]\nlength_mm = 20\nwidth_mm = 20\nradius_mm = 1\n', "d"))

    def shifted(self):
        """The coarse case with its mesh half as large: as many cells, at other places."""
        text = CASE.format(mesh=self.mesh(*COARSE), end=0.1, more='[initial_flow]\nfrom = "coarse"').replace("[time]", "scale = 0.5\n[time]", 1)
        return self.case(text, "shifted")


if __name__ == "__main__":
    harness.main()
