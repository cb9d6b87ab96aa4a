# timeout: 1500
# processors: 3
# cost: 40
"""Requirement: rags that cross both parts of the sliding interface of a pump, touch its turning walls and are put in later lose nothing, and
the run agrees to 1e-6 on 1, 2, 3 and 5 ranks and after a stop and a resume to the bit."""
import os
import signal

import numpy

import harness
from small_cases import FLANGES, K_EPSILON, pump_case, tight_flow

WATER = "kinematic_viscosity_m2_s = 1.0048e-6\ninitial_velocity_m_s = [0, 0, -1]\n"
SPEED = "rotation_speed_rpm = 600     # an impact at full speed multiplies round-off of the water by some thousand"
RAGS = """
[[wall]]
kind = "patches"
patches = ["impeller_walls", "casing_walls"]
# Through the disc of the interface, from the inlet pipe into the eye.
[[rag]]
length_mm = 60
width_mm = 40
radius_mm = 2
centre_m = [0, 0, {height_m}]
lengthwise = [1, 0.2, 0.5]
crosswise = [0, 1, 0.3]
velocity_m_s = [0, 0, -6]
# Through the cylinder, from the volute towards the vane.
[[rag]]
length_mm = 40
width_mm = 16
radius_mm = 2
centre_m = [0.0038, 0.1079, 0.04]
lengthwise = [0, 0, 1]
crosswise = [0.03, 1, 0]
velocity_m_s = [0, -{speed_m_s}, 0]
# Beside the tongue, later.
[[rag]]
length_mm = 24
width_mm = 24
radius_mm = 2
centre_m = [-0.05, -0.135, 0.04]
lengthwise = [0, 0, 1]
crosswise = [1, -0.3, 0]
insert_time_ms = {insert_ms}
match_flow_velocity = true
[rag_passage]
inlet_flange_m = [0, 0, 0.086]
inlet_normal = [0, 0, -1]
inlet_radius_mm = 50
outlet_flange_m = [0.153, 0.22, 0.04]
outlet_normal = [0, 1, 0]
outlet_radius_mm = 40
tongue_m = [0.1023, 0.0499, 0.04]
tongue_reach_mm = 15
impeller_radius_mm = 100
[contact]
wall_stiffness_factor = 5
impact_speed_m_s = 15
[coupling]
mode = "two_way"
kernel = "{kernel}"
kernel_width_mm = 6
forces = ["recommended"]
"""
MONITORS = ("rags", "passage", "rag_forces", "contacts", "wall_contacts", "coupling", "patches", "pump")


class RagInPump(harness.CaseTest):
    """25 steps, in which each rag does what it is there for; rag_in_pump_long.py has 50 of them, more numbers of ranks and another kernel."""

    n_steps, n_steps_before_last_rag = 25, 10
    settings = {"end_ms": 2.5, "height_m": 0.0906, "speed_m_s": 7, "insert_ms": 1, "picture_ms": 1.25}
    ranks = {"gaussian": (3,)}  # that are compared with one rank

    def pump(self, kernel="gaussian"):
        return self.case(pump_case(
            "rag-in-pump", harness.SOURCE_DIR / "cases" / "meshes" / "pump_coarse.msh", rotor=SPEED, pump=FLANGES,
            time=f"end_ms = {self.settings['end_ms']}\nstep_ms = 0.1", flow=WATER + tight_flow("1e-11"),
            more=K_EPSILON + RAGS.format(kernel=kernel, **self.settings),
            output=f"single_precision = false\nfields_interval_s = 1\nrags_interval_ms = {self.settings['picture_ms']}"), kernel)

    def whole(self, kernel, ranks):
        return self.run_once(self.pump(kernel), ranks)

    def look_at(self, run):
        """The case shows something: rags cross the interface and touch the impeller; nothing is lost."""
        summary, rags = run.summary, run.monitor("rags")
        self.assertEqual(summary["time_steps"], self.n_steps)
        number, centre = rags.column("rag"), numpy.stack([rags.column(axis) for axis in "xyz"], axis=1)
        self.assertGreater(centre[number == 0][0, 2], 0.09)
        self.assertLess(centre[number == 0][-1, 2], 0.08, "the first rag must come through the disc at z = 86 mm")
        radius = numpy.hypot(centre[number == 1][:, 0], centre[number == 1][:, 1])
        self.assertGreater(radius[0], 0.1045)
        self.assertLess(radius.min(), 0.1045, "the second rag must come through the cylinder of 104.5 mm")
        self.assertEqual((number == 2).sum(), self.n_steps - self.n_steps_before_last_rag, "the third rag is there from its time on")
        last = rags.values[(number == 2)][0]
        self.assertGreater(abs(last[rags.columns.index("vx [m/s]")]), 0.01, "it starts with the water")
        self.assertGreater(run.monitor("contacts").column("wall_contacts").max(), 0)
        self.assertGreater(run.monitor("passage").column("touching_impeller").max(), 0)
        self.assertEqual(run.monitor("coupling").column("particles_outside_cells").max(), 0)
        pump, walls = run.monitor("pump"), run.monitor("wall_contacts")
        torque = walls.column("impeller_walls_normal_torque") + walls.column("impeller_walls_friction_torque")
        self.assertGreater(numpy.abs(torque).max(), 1e-3, "the rags must touch the impeller")
        numpy.testing.assert_allclose(pump.column("torque_contacts"), torque, rtol=1e-12)
        speed = 600 * numpy.pi / 30
        numpy.testing.assert_allclose(walls.column("impeller_walls_power"), -speed * torque, rtol=1e-9, atol=1e-12)
        numpy.testing.assert_allclose(pump.column("shaft_power_total"), pump.column("shaft_power") - speed * torque, rtol=1e-12)
        self.assertEqual(numpy.abs(walls.column("casing_walls_power")).max(), 0)
        lost, worst = summary["coupling"]["couple_lost_rel"], run.monitor("coupling").column("couple_lost_rel").max()
        print(f"  couple lost in the exchange: {100 * lost:.2f} % of the torque on the rags, {100 * worst:.2f} % in the worst step")
        self.assertLess(lost, 0.05)
        conservation = summary["conservation"]
        for name in ("particles_lost", "bonds_lost", "particles_beyond_walls"):
            self.assertEqual(conservation[name], 0, name)
        self.assertLess(conservation["momentum_exchange_rel"], 1e-10)
        self.assertLess(conservation["interface_closure_rel"], 1e-12)
        self.assertLess(conservation["mass_imbalance_rel"], 1e-6)
        for rag in summary["rags"]:
            print(f"  {rag['name']}: wall overlap {rag['max_wall_overlap_over_radius']:.3f} r, contact {rag['wall_contact_s']} s")
            self.assertLess(rag["max_wall_overlap_over_radius"], 0.5)

    def agree(self, kernel):
        one = self.whole(kernel, 1)
        self.look_at(one)
        for ranks in self.ranks[kernel]:
            for monitor in MONITORS:
                self.assert_monitors_agree(one, self.whole(kernel, ranks), monitor, 1e-6)

    def test_gaussian_kernel_on_any_number_of_ranks(self):
        self.agree("gaussian")

    def stop_and_resume(self, ranks, kernel="gaussian", *, after):
        """Stopped after each of these numbers of steps and resumed; the end is that of the run that was not."""
        case, folder, how = self.pump(kernel), self.work / "stopped", []
        whole = self.whole(kernel, ranks)
        for n_steps in after:
            mpirun = harness.start(["run", case, "--out", folder, *how], ranks)
            harness.wait_for_records(folder / "monitors" / "coupling.csv", n_steps, mpirun)
            os.kill(harness.program_processes(mpirun)[-1], signal.SIGTERM)
            stdout, stderr = mpirun.communicate(timeout=120)
            self.assertEqual(mpirun.returncode, 7, stdout + stderr)
            how = ["--resume"]
        resumed = self.run_case(case, ranks, "--resume", out="stopped")
        self.assert_equal_to_the_bit(whole, resumed, lambda run: sorted((run.folder / "rags").glob(f"*_{self.n_steps:06}.vtp")))

    def test_stops_before_the_last_rag_is_put_in_and_in_mid_transit(self):
        self.stop_and_resume(3, after=(4, 14))


if __name__ == "__main__":
    harness.main()
