# timeout: 300
# cost: 14
"""Requirement: when water or particles diverge, the run ends with code 4 while all numbers are finite. The message names the place and a remedy. The report does not say that the run ended as planned."""
import json

import harness
from small_cases import CHANNEL, CHANNEL_MESH, TWO_SHEETS

# Water with a sphere in it that leaves through a convective outlet in steps of three cells and more: too long for that outlet.
WATER_AND_SPHERE = """
[case]
name = "sphere"
[mesh]
file = "{mesh}"
[time]
end_s = 2
step_s = 0.01
[flow]
density_kg_m3 = 1000
dynamic_viscosity_Pa_s = 0.1
[[boundary]]
patch = "inlet"
kind = "velocity_inlet"
velocity_m_s = [5, 0, 0]
ramp_s = 0.1
[[boundary]]
patch = "outlet"
kind = "convective_outlet"
[[boundary]]
patches = ["bottom", "top", "side_z0", "side_z1"]
kind = "wall"
[gravity]
acceleration_m_s2 = [0, -9.81, 0]
[[particle]]
diameter_mm = 40
density_kg_m3 = 1010
position_m = [0.15, 0.05, 0.05]
[coupling]
mode = "two_way"
kernel = "cell"
forces = ["schiller_naumann"]
"""

# Water driven by the static pressure of an inlet through a pipe of tetrahedra.
PIPE = """
[case]
name = "pipe"
[mesh]
file = "{mesh}"
[time]
end_s = 5
step_s = 0.05
[flow]
density_kg_m3 = 1000
dynamic_viscosity_Pa_s = 0.001
initial_velocity_m_s = [0.01, 0, 0]
[[boundary]]
patch = "inlet"
kind = "pressure_inlet"
pressure_Pa = 0.048
total = false
[[boundary]]
patch = "outlet"
kind = "pressure_outlet"
[[boundary]]
patch = "walls"
kind = "wall"
"""

# A lid over a box that is closed but for one end.
LID = """
[case]
name = "lid"
[mesh]
file = "{mesh}"
[time]
end_s = 0.1
step_s = 0.01
[flow]
density_kg_m3 = 1000
dynamic_viscosity_Pa_s = 0.1
[[boundary]]
patch = "top"
kind = "moving_wall"
velocity_m_s = [1, 0, 0]
[[boundary]]
patch = "outlet"
kind = "pressure_outlet"
[[boundary]]
patches = ["inlet", "bottom", "side_z0", "side_z1"]
kind = "wall"
"""


class Diverging(harness.CaseTest):
    def diverges(self, case, ranks, *fragments, arguments=()):
        """Ends with 4 and one message with all fragments, the same in summary.json and, in red, in the report."""
        run = self.run_case(case, ranks, *arguments, out=f"out{ranks}", code=4)
        errors = [line for line in run.messages if "error" in line]
        self.assertEqual(len(errors), 1, run.stderr)
        print(f"  {errors[0]}")
        for fragment in fragments:
            self.assertIn(fragment, errors[0])
        self.assertEqual(run.summary["exit"], 4)
        self.assertIn(run.summary["error"], errors[0])
        page = (run.folder / "report.html").read_text()
        self.assertIn('<p class="outcome bad">The computation diverged', page)
        self.assertNotIn("as planned", page)
        for name in ("residuals", "rags"):
            if (run.folder / "monitors" / f"{name}.csv").exists():
                self.assertLess(abs(run.monitor(name).values).max(), 1e9, "numbers grew beyond all bounds before the run ended")
        return run

    def test_water_in_steps_too_long(self):
        case = self.case(WATER_AND_SPHERE.format(mesh=self.mesh(*CHANNEL_MESH)))
        self.diverges(case, 1, "the water diverged in step ", "[time] step_ms = ", "no checkpoint was written")


    def test_static_pressure_at_an_inlet(self):
        """The remedy is the condition of the inlet, and with it the run reaches its end."""
        mesh = self.mesh("pipe", "diameter_m=0.02", "length_m=0.06", "wall_size_m=0.004", "core_size_m=0.004")
        case = self.case(PIPE.format(mesh=mesh), "pipe")
        self.diverges(case, 1, 'at patch "inlet" try total = true')
        self.run_case(case, 1, "--set", "boundary.0.total=true", out="total")


class Checks(harness.CaseTest):
    def test_mass_imbalance(self):
        """A pressure equation that is not solved well enough: the run reaches its end, and does not end with 0."""
        case = self.case(CHANNEL.format(mesh=self.mesh(*CHANNEL_MESH), kernel="cell"))
        loose = ("--set", "flow.pressure_tolerance=0.1", "--set", "flow.pressure_tolerance_intermediate=0.5", "--set", "output.report=true", "--set", "time.end_s=0.005")
        run = self.run_case(case, 2, *loose, code=4)
        self.assertGreater(run.summary["conservation"]["mass_imbalance_rel"], 1e-4)
        self.assertIn("a check failed: Mass imbalance", run.stderr)
        self.assertNotIn("as planned", (run.folder / "report.html").read_text())

    def test_nothing_passes(self):
        """A lid drives water in a box that is open at one end: there is no flow through the domain to compare with, and nothing wrong."""
        run = self.run_case(self.case(LID.format(mesh=self.mesh(*CHANNEL_MESH))), 2)
        self.assertLess(abs(run.monitor("patches").column("outlet_flow")).max(), 1e-12)
        self.assertLess(run.summary["conservation"]["mass_imbalance_rel"], 1e-4)

    def test_wall_overlap(self):
        """Cloth that is thrown at a wall too fast for its contacts."""
        fast = ("--set", "rag.0.velocity_m_s=[0, 0, -12]", "--set", "time.end_s=0.008", "--set", "output.report=true")
        run = self.run_case(self.case(TWO_SHEETS), 2, *fast, code=5)
        self.assertGreater(run.summary["rags"][0]["max_wall_overlap_over_radius"], 0.5)
        page = (run.folder / "report.html").read_text()
        self.assertIn('<p class="outcome bad">', page)
        self.assertNotIn("as planned", page)


if __name__ == "__main__":
    harness.main()
