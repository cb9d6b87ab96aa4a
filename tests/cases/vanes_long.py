# labels: long
# timeout: 10800
"""Requirement: ten pumps of one to seven vanes, of several sizes and mesh seeds, run for three turns in second order on the mesh that `snag mesh pump` makes of them: at most a tenth of the volume is next to a skew face, and nothing grows."""
import re

import harness
import vanes

PUMPS = {  # flow in L/s, parameters
    "one_vane": (26.8, ["vanes=1", "mesh_seed=11"]),
    "two_vanes": (26.8, ["vanes=2", "mesh_seed=12"]),
    "three_vanes": (20, ["vanes=3", "mesh_seed=13", "impeller_width_mm=40"]),
    "four_vanes": (20, ["vanes=4", "mesh_seed=14", "impeller_width_mm=30", "design_flow_L_s=20"]),
    "five_vanes": (15, ["vanes=5", "mesh_seed=15", "impeller_width_mm=25", "design_flow_L_s=15", "wall_size_mm=8"]),
    "six_vanes": (15, ["vanes=6", "mesh_seed=16", "impeller_width_mm=25", "wall_size_mm=8", "core_size_mm=12"]),
    "seven_vanes": (20, ["vanes=7", "mesh_seed=17", "impeller_width_mm=30", "wall_size_mm=7"]),
    "two_vanes_large": (30, ["vanes=2", "mesh_seed=18", "impeller_diameter_mm=260", "leading_edge_radius_mm=50", "inlet_diameter_mm=130",
                             "outlet_diameter_mm=100", "tongue_gap=0.15"]),
    "one_vane_small": (10, ["vanes=1", "mesh_seed=19", "impeller_diameter_mm=150", "impeller_width_mm=50", "leading_edge_radius_mm=28",
                            "inlet_diameter_mm=75", "outlet_diameter_mm=65"]),
    "three_vanes_narrow_tongue": (25, ["vanes=3", "mesh_seed=20", "tongue_gap=0.05", "impeller_width_mm=50", "wall_size_mm=10", "core_size_mm=18"]),
}


class ManyVanes(harness.CaseTest):
    def test_ten_pumps(self):
        for name, (flow, parameters) in PUMPS.items():
            with self.subTest(pump=name):
                mesh = self.mesh("pump", *parameters)
                judged = harness.snag(["mesh", "--info", mesh])
                self.assertEqual(judged.code, 0, judged.tail())
                skew = float(re.search(r"skew cells.* ([\d.e-]+) % of the volume", judged.stdout).group(1))
                self.assertLess(skew, 10)
                settings = ["rotating_zone.rotation_speed_rpm=1200", "rotating_zone.ramp_ms=20", "time.step_ms=0.4", "time.end_ms=160",
                            f"boundary.0.flow_rate_L_s={flow}", "boundary.0.ramp_ms=20",
                            "turbulence.initial_k_m2_s2=0.04", "turbulence.initial_epsilon_m2_s3=0.2"]
                run = self.run_case(self.case(vanes.three_vanes(mesh), name), 1, *[word for s in settings for word in ("--set", s)],
                                    out=name, timeout=3600)
                self.assertGreaterEqual(run.summary["pump"]["revolutions"], 3)
                self.assertLess(run.summary["water"]["max_speed_over_scale"], 3)
                self.assertEqual(run.summary["water"]["unsolved_steps"], 0)
                courant = run.monitor("residuals").column("courant_max")
                turn = 125  # steps
                self.assertLess(courant[-turn:].max(), 1.5 * courant[-2 * turn : -turn].max())
                pump = run.monitor("pump")
                print(f"  {name}: {run.summary['mesh']['cells']} cells, quality {run.summary['mesh']['min_quality']:.3f}, skew {skew:.1f} % of the volume, "
                      f"Courant {courant[-1]:.1f}, head {pump.column('head')[-turn:].mean():.2f} m, torque {pump.column('torque')[-turn:].mean():.2f} N m")


if __name__ == "__main__":
    harness.main()
