# timeout: 200
"""Requirement: `snag mesh --info` accepts the pumps of several vanes that `snag mesh pump` makes. Snag computes their water in second order, with steps of 12 degrees too. In no cell does the velocity grow without bound."""
import numpy

import harness
from small_cases import pump_case

COARSE = ("impeller_width_mm=20", "side_gap_mm=5", "design_flow_L_s=8", "inlet_length_mm=60", "outlet_length_mm=80", "wall_size_mm=16", "core_size_mm=24",
          "interface_size_mm=13", "pipe_size_mm=40")


def three_vanes(mesh):
    return pump_case("three-vanes", mesh, rotor="rotation_speed_rpm = 1000", time="end_ms = 40\nstep_ms = 2", flow="n_outer_correctors = 2", flow_rate_L_s=6)


class Vanes(harness.CaseTest):
    def test_three_vanes(self):
        mesh = self.mesh("pump", "vanes=3", *COARSE)
        judged = harness.snag(["mesh", "--info", mesh])
        self.assertEqual(judged.code, 0, judged.tail())
        run = self.run_case(self.case(three_vanes(mesh)))
        self.assertEqual(run.summary["time_steps"], 20)
        pump = run.monitor("pump")
        # Water at rest that vanes set into motion: all five torques brake the impeller, and the interface lets all of the water through.
        self.assertTrue(numpy.all(pump.column("torque") < 0), pump.column("torque"))
        # With corrections for skewness everywhere the Courant number grew from 128 in step 3 to 110,000 in step 20.
        # At the start the water rushes round the tips of the vanes, 2.5 times as fast as the tips for two steps; then it slows down.
        self.assertLess(run.summary["water"]["max_speed_over_scale"], 3)
        courant = run.monitor("residuals").column("courant_max")
        self.assertLess(courant[10:].max(), 0.7 * courant[0])
        self.assertLess(run.summary["conservation"]["mass_imbalance_rel"], 1e-6)
        self.assertLess(run.summary["conservation"]["interface_closure_rel"], 1e-9)

    def test_two_vanes(self):
        # A tetrahedron of its rotor has a skew face and lies 66 degrees aslant over its wall. With the cell's own gradient of the pressure across
        # oblique faces, a pressure of this cell moved no flux and grew in each step: after 15 steps its water had six times the speed of the tips.
        mesh = self.mesh("pump", "vanes=2", "mesh_seed=12")
        settings = ["rotating_zone.rotation_speed_rpm=1200", "rotating_zone.ramp_ms=20", "time.step_ms=0.4", "time.end_ms=6",
                    "boundary.0.flow_rate_L_s=26.8", "boundary.0.ramp_ms=20", "turbulence.initial_k_m2_s2=0.04", "turbulence.initial_epsilon_m2_s3=0.2"]
        run = self.run_case(self.case(three_vanes(mesh), "two-vanes"), 1, *[word for s in settings for word in ("--set", s)], out="two")
        self.assertEqual(run.summary["time_steps"], 15)
        self.assertLess(run.summary["water"]["max_speed_over_scale"], 2)

    def test_edge_of_a_vane(self):
        # The neighbour of a tetrahedron at the blunt edge of this vane lies round its corner. With its gradient of the pressure for the slope at
        # the wall the water of the tetrahedron ran against the wall, with 2.8 times the speed of the tip at 20 ms and 4.5 times at 60 ms.
        mesh = self.mesh("pump", "vanes=1", "mesh_seed=19", "impeller_diameter_mm=150", "impeller_width_mm=50", "leading_edge_radius_mm=28",
                         "inlet_diameter_mm=75", "outlet_diameter_mm=65")
        settings = ["rotating_zone.rotation_speed_rpm=1200", "rotating_zone.ramp_ms=20", "time.step_ms=0.5", "time.end_ms=20",
                    "boundary.0.flow_rate_L_s=10", "boundary.0.ramp_ms=20", "turbulence.initial_k_m2_s2=0.04", "turbulence.initial_epsilon_m2_s3=0.2"]
        run = self.run_case(self.case(three_vanes(mesh), "edge"), 1, *[word for s in settings for word in ("--set", s)], out="edge")
        self.assertEqual(run.summary["time_steps"], 40)
        self.assertLess(run.summary["water"]["max_speed_over_scale"], 2)


if __name__ == "__main__":
    harness.main()
