# timeout: 900
# processors: 2
# cost: 20
"""Requirement: a pump with a sliding rotor tells flow, head, torque and its geometry at every time; a resumed run, and
one on other ranks, tells the same."""
import re
import shutil

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

import harness
from small_cases import FLANGES, pump_case, tight_flow

STEP, OMEGA = 2e-4, 1200 * 2 * numpy.pi / 60  # 1.44 degrees a step
WATER = "kinematic_viscosity_m2_s = 1.0048e-6\n"


def surface(file):
    """Points and cell arrays of a .vtp."""
    data = harness.read_vtk(file)
    return vtk_to_numpy(data.GetPoints().GetData()), harness.arrays(data.GetCellData())


class Pump(harness.CaseTest):
    """30 steps; pump_long.py has 60 of them, and as many on three ranks."""

    n_steps, n_between_fields, n_before_checkpoint, n_steps_on_three = 30, 10, 25, 6

    def setUp(self):
        super().setUp()
        self.file = self.case(pump_case(
            "pump", harness.SOURCE_DIR / "cases" / "meshes" / "pump_coarse.msh", rotor="rotation_speed_rpm = 1200", pump=FLANGES,
            time=f"end_s = {self.n_steps * STEP}\nstep_s = {STEP}", flow=WATER + tight_flow("1e-10"),
            output=f"single_precision = false\nfields_interval_s = {self.n_between_fields * STEP}\n"
                   f"[checkpoint]\ninterval_s = {self.n_before_checkpoint * STEP}"))

    def test_pump_and_its_resume(self):
        whole = self.run_case(self.file, 2, out="whole")
        self.looks_like_a_pump(whole)
        self.balances_close(whole)
        self.walls_turn(whole)
        shutil.copytree(whole.folder, self.work / "crashed")
        slots = sorted((self.work / "whole" / "checkpoint").glob("*.h5"), key=lambda slot: slot.stat().st_mtime_ns)
        broken = self.work / "crashed" / "checkpoint" / slots[-1].name
        broken.write_bytes(broken.read_bytes()[:-5000])  # the newest state is then the one before the end
        resumed = self.run_case(self.file, 2, "--resume", out="crashed")
        self.assertIn(f"resumed at {self.n_before_checkpoint * STEP:g}", resumed.stdout)
        for monitor in ("pump", "balance"):
            self.assertEqual(whole.monitor(monitor).lines, resumed.monitor(monitor).lines, "no line twice, none missing")
        other = self.run_case(self.file, 3, "--set", f"time.end_s={self.n_steps_on_three * STEP}", out="three").monitor("pump")
        self.assertEqual(len(other.values), self.n_steps_on_three)
        one = whole.monitor("pump")
        one.values = one.values[: self.n_steps_on_three]
        difference = max(harness.largest_difference(one, other).values())
        print(f"  on three ranks: largest difference {difference:.1e}")
        self.assertLessEqual(difference, 1e-3)

    def test_slow_flow_from_rest(self):
        """While the rotor still turns slower than the water around it, nothing runs away."""
        case = harness.SOURCE_DIR / "cases" / "pump-curve" / "case.toml"
        run = self.run_case(case, 2, "--set", "boundary.0.flow_rate_L_s=2", "--set", "time.step_ms=0.2", "--set", "time.end_ms=3", out="slow")
        self.assertLess(run.monitor("residuals").column("courant_max").max(), 5)

    def looks_like_a_pump(self, run):
        pump = run.monitor("pump")
        self.assertEqual(len(pump.values), self.n_steps)
        numpy.testing.assert_allclose(pump.column("angle"), numpy.degrees(OMEGA * STEP) * numpy.arange(1, self.n_steps + 1), rtol=1e-9)
        numpy.testing.assert_allclose(pump.column("flow_in"), 0.0268, rtol=1e-9)
        numpy.testing.assert_allclose(pump.column("flow_out"), 0.0268, rtol=1e-5)  # the interface loses nothing
        numpy.testing.assert_allclose(pump.column("shaft_power"), -OMEGA * pump.column("torque"), rtol=1e-12)
        self.assertLess(pump.column("torque")[-self.n_steps // 3:].max(), 0, "the water holds the impeller back")
        self.assertGreater(pump.column("head")[-self.n_steps // 3:].min(), 0)
        summary = run.summary
        self.assertAlmostEqual(summary["pump"]["revolutions"], OMEGA * STEP * self.n_steps / (2 * numpy.pi), places=9)
        self.assertGreater(summary["mesh"]["facets"], 3000)
        self.assertLess(summary["conservation"]["interface_closure_rel"], 1e-12)
        self.assertEqual(len(run.monitor("revolutions").values), 0, "no revolution is complete")

    def balances_close(self, run):
        """Both rows of the balance, summed here from their columns, leave less than 1e-6 of the shaft's torque and power; columns are documented."""
        balance = run.monitor("balance")
        names = [column.split(" ")[0] for column in balance.columns]
        torque, power = numpy.abs(balance.column("shaft_torque")), numpy.abs(balance.column("shaft_power"))
        numpy.testing.assert_allclose(balance.column("shaft_power"), run.monitor("pump").column("shaft_power"), rtol=1e-6)
        for zone in ("rotor", "stator"):
            skipped = {f"{zone}_{name}" for name in ("given", "lost_convection", "lost_pressure", "lost_friction", "residual")}
            row = sum(balance.column(name) for name in names if name.startswith(zone) and name not in skipped) - balance.column(f"{zone}_given")
            self.assertLess(numpy.abs(row / torque).max(), 1e-6, zone)
        spent = sum(balance.column(name) for name in names if name.startswith("dissipation") or name in ("hydraulic_power", "stored_power", "numerical"))
        left = balance.column("shaft_power") + balance.column("given_power") - spent
        self.assertLess(numpy.abs(left / power).max(), 1e-6)
        print(f"  lost of the torque {100 * (balance.column('rotor_lost') + balance.column('stator_lost'))[-1] / torque[-1]:.2f} %, "
              f"numerical share of the power {100 * balance.column('numerical')[-1] / power[-1]:.2f} %")
        page = (harness.SOURCE_DIR / "docs" / "outputs.md").read_text().split("### balance.csv")[1].split("\n### ")[0]
        for column in balance.columns:
            name, unit = re.fullmatch(r"(\S+) \[(.+)\]", column).groups()
            name = re.sub("^(rotor|stator)_", "ZONE_", name)
            name = re.sub("_wall_(impeller_walls|casing_walls)_", "_wall_PATCH_", name)
            self.assertTrue(any(f"`{name}`" in row and f"| {unit} |" in row for row in page.splitlines()), f"{column} has no row in docs/outputs.md")
        shares = run.summary["balance"]
        self.assertLess(shares["torque_residual_rel"], 1e-6)
        wall = run.monitor("wall")
        self.assertEqual(run.summary["walls"]["treatment"], "wall_functions")
        for patch in run.summary["walls"]["patches"]:
            for end in ("min", "mean", "max"):
                self.assertAlmostEqual(patch[f"y_plus_{end}"] / wall.column(f"{patch['patch']}_y_plus_{end}")[-1], 1, places=9)
        self.assertEqual([patch["patch"] for patch in run.summary["walls"]["patches"]], ["casing_walls", "impeller_walls"])

    def walls_turn(self, run):
        """The walls of the rotor turn as a whole about the axis, those of the casing stand; pressure is on both."""
        files, steps = sorted((run.folder / "walls").glob("walls_*.vtp")), range(0, self.n_steps + 1, self.n_between_fields)
        self.assertEqual([file.name for file in files], [f"walls_{n:06}.vtp" for n in steps])
        first, _ = surface(files[0])
        for file, n in zip(files, steps):
            points, arrays = surface(file)
            turning = numpy.repeat(arrays["turning [1]"] == 1, 3)
            self.assertTrue(turning.any() and not turning.all())
            angle = OMEGA * STEP * n
            turned = first[:, 0] * numpy.cos(angle) - first[:, 1] * numpy.sin(angle), first[:, 0] * numpy.sin(angle) + first[:, 1] * numpy.cos(angle), first[:, 2]
            expected = numpy.where(turning[:, None], numpy.stack(turned, axis=1), first)
            numpy.testing.assert_allclose(points, expected, atol=1e-6)
            if n:
                self.assertGreater(numpy.ptp(arrays["pressure [Pa]"]), 1000, "pressure on the walls")


if __name__ == "__main__":
    harness.main()
