# timeout: 300
# cost: 24
"""Requirement: `snag check` refuses every case that `snag run` refuses. It warns before the run of what will go wrong. It gives no warning for the shipped cases (examples.py)."""
import re

import harness
from skew_mesh import CASE as SPHERE
from skew_mesh import ball
from small_cases import CHANNEL, CHANNEL_MESH, CHANNEL_OUTLET_AND_WALLS

WATER = """
[mesh]
file = "{mesh}"
[time]
end_s = 0.01
step_s = 1e-3
[[boundary]]
patch = "inlet"
kind = "velocity_inlet"
velocity_m_s = [0.3, 0, 0]
{ramp}
""" + CHANNEL_OUTLET_AND_WALLS

TURNING_PIPE = """
[mesh]
file = "{mesh}"
[time]
end_s = 3
step_s = 0.15
[flow]
kinematic_viscosity_m2_s = 1e-4
[[boundary]]
patches = ["inlet", "outlet"]
kind = "symmetry"
[[boundary]]
patch = "walls"
kind = "moving_wall"
rotation_speed_rpm = 60
axis = [1, 0, 0]
"""

BLADE_ROWS = """
[mesh]
geometry = "blade_rows"
set = ["blades=3", "blade_radius_mm=[115, 140, 140, 115]", "blade_angle_deg=[0, 0, 10, 10]", "vanes=5", "vane_radius_mm=[180, 205, 205, 180]", "vane_angle_deg=[0, 0, 6, 6]",
       "inlet_radius_mm=100", "sliding_radius_mm=160", "outlet_radius_mm=230", "thickness_mm=4",
       "wall_size_mm=5", "edge_size_mm=2", "core_size_mm=8", "layers=2", "first_layer_mm=1"]
[time]
end_s = 0.12
step_s = 0.002
[rotating_zone]
zone = "rotor"
rotation_speed_rad_s = -30
[turbulence]
model = "k_epsilon"
[[boundary]]
patch = "inlet"
kind = "velocity_inlet"
normal_speed_m_s = 0.16
[[boundary]]
patch = "outlet"
kind = "pressure_outlet"
[[boundary]]
patches = ["impeller_walls", "vane_walls"]
kind = "wall"
[[boundary]]
patch = "planes"
kind = "symmetry"
"""

PUMP = harness.SOURCE_DIR / "cases" / "pump-curve" / "case.toml"

# A closed box of 12 triangles with normals outwards: as STL the water is inside.
CORNERS = [(x, y, z) for z in (0, 0.2) for y in (0, 0.2) for x in (0, 0.2)]
BOX = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]
HOUSING = """
[time]
end_s = 0.001
step_s = 1e-4
[[wall]]
kind = "stl"
name = "housing"
file = "housing.stl"
normals_into_fluid = {flipped}
[[rag]]
length_mm = 40
width_mm = 40
radius_mm = 1
centre_m = [0.1, 0.1, 0.1]
"""


def stl():
    facets = []
    for triangle in BOX:
        vertices = "".join("vertex {} {} {}\n".format(*CORNERS[i]) for i in triangle)
        facets.append(f"facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n")
    return "solid housing\n" + "".join(facets) + "endsolid housing\n"


class CheckPredicts(harness.CaseTest):
    def check(self, case, *arguments, code=0):
        run = harness.snag(["check", case, *arguments])
        self.assertEqual(run.code, code, run.tail())
        return run

    def water(self, more="", ramp=""):
        return self.case(WATER.format(mesh=self.mesh(*CHANNEL_MESH), ramp=ramp) + more)

    def test_start_of_k_and_epsilon(self):
        run = self.check(self.water('[turbulence]\nmodel = "k_epsilon"\n', "ramp_s = 1"), code=2)
        self.assertIn("no fluid enters at the start", run.stderr)

    def test_patch_of_the_pump(self):
        run = self.check(PUMP, "--set", 'pump.walls=["vane"]', code=2)
        self.assertIn("vane", run.stderr)

    def test_degrees_a_step(self):
        run = self.check(PUMP, "--set", "time.step_ms=10", "--set", "time.end_ms=200", code=2)
        self.assertIn("72 degrees", run.stderr)
        self.assertIn("step_ms = 0.694 gives 5", run.stderr)
        run = self.check(PUMP, "--set", "time.step_ms=2")
        self.assertIn("14.4 degrees a step, advised at most 6", run.stdout)

    def test_degrees_a_step_of_walls(self):
        """A pipe whose wall turns by 54 degrees a step: with one outer correction the water then settles to an eccentric vortex."""
        mesh = self.mesh("pipe", "diameter_m=0.1", "length_m=0.04", 'cells="swept"', "n_around=16", "n_layers=3", "first_layer_m=0.006", "axial_size_m=0.02")
        case = self.case(TURNING_PIPE.format(mesh=mesh))
        self.assertIn("the walls turn 54 degrees a step, advised at most 30", self.check(case).stdout)
        run = self.run_case(case, 2)
        self.assertIn("the walls turn 54 degrees a step", run.stdout + run.stderr)
        for remedy in ("flow.n_outer_correctors=5", "time.step_s=0.05"):
            self.assertNotIn("warning", self.check(case, "--set", remedy).stdout)

    def test_what_is_foreseen(self):
        run = self.check(PUMP)
        for words in ("5.76 degrees a step", "Courant number a step", "y+ on impeller_walls", "y+ on casing_walls", "Reynolds number", "cost: "):
            self.assertIn(words, run.stdout)
        self.assertNotIn("warning", run.stdout)

    def test_laminar_above_transition(self):
        run = self.check(self.water())
        self.assertIn("laminar at a Reynolds number of 3", run.stdout)
        self.assertNotIn("warning", self.check(self.water('[turbulence]\nmodel = "laminar"\n')).stdout)

    def test_laminar_flow_around_a_body(self):
        """The width is that of the body, not of the far boundary: a sphere of 1 m at a Reynolds number of 300."""
        (self.work / "ball.msh").write_text(ball())
        run = self.check(self.case(SPHERE.format(mesh=self.work / "ball.msh")))
        reynolds = float(re.search(r"Reynolds number (\S+) with the speed of the case and the width of body sphere", run.stdout)[1])
        self.assertAlmostEqual(reynolds, 300, delta=15)
        self.assertNotIn("laminar at a Reynolds number", run.stdout)

    def test_a_ring_of_vanes_is_no_body(self):
        """The Reynolds number of a rotor in an open ring is that of an opening."""
        run = harness.snag(["check", self.case(BLADE_ROWS)])
        self.assertEqual(run.code, 0, run.tail())
        self.assertRegex(run.stdout, r"Reynolds number \S+ with the speed of the case and the width of patch (inlet|outlet)")

    def test_thin_cells_at_a_wall(self):
        run = self.check(self.water('[turbulence]\nmodel = "k_epsilon"\n[flow]\nkinematic_viscosity_m2_s = 1e-4\n'))
        self.assertIn("a cell below 11 counts as one at 11", run.stdout)
        self.assertNotIn("warning", run.stdout)
        run = self.check(self.water('[turbulence]\nmodel = "k_omega_sst"\n[flow]\nkinematic_viscosity_m2_s = 1e-4\n'))
        self.assertNotIn("counts as one", run.stdout)

    def test_rough_walls_and_large_eddies(self):
        """Metres for millimetres: sand higher than the cells at the wall, eddies wider than the inlet, gravity in cm/s2."""
        text = WATER.format(mesh=self.mesh(*CHANNEL_MESH), ramp="turbulence_length_scale_m = 7").replace('kind = "wall"', 'kind = "wall"\nroughness_height_m = 0.25') + '[turbulence]\nmodel = "k_epsilon"\n'
        run = self.check(self.case(text))
        self.assertRegex(run.stdout, r"roughness_height is 250 mm, more than the \S+ mm from the wall")
        self.assertRegex(run.stdout, r"turbulence_length_scale is 7e\+03 mm, wider than the patch")
        self.assertIn("gravity", self.check(PUMP, "--set", "pump.gravity_m_s2=981", code=2).stderr)

    def test_velocity_along_its_patch(self):
        text = WATER.format(mesh=self.mesh(*CHANNEL_MESH), ramp="").replace("[0.3, 0, 0]", "[0, 0.3, 0]") + '[turbulence]\nmodel = "laminar"\n'
        self.assertIn("the velocity lies along the patch", self.check(self.case(text)).stdout)

    def test_files_that_are_no_cases(self):
        for file, command in (("pump-demo/study.toml", "snag study"), ("diagnose-sphere/DIAGNOSIS.toml", "snag diagnose")):
            self.assertIn(f"belongs to a file of `{command}`", self.check(harness.SOURCE_DIR / "cases" / file, code=2).stderr)

    def test_rag_that_starts_fast(self):
        rag = "[time]\nend_s = 0.1\nstep_s = 0.01\n[[rag]]\nlength_mm = 60\nwidth_mm = 40\nradius_mm = 2\ncentre_m = [0, 0, 0]\nvelocity_m_s = [%g, 0, 0]\n"
        self.assertIn("starts at 9 m/s, faster than [contact] impact_speed, 5 m/s", self.check(self.case(rag % 9)).stdout)
        self.assertNotIn("impact_speed, ", self.check(self.case(rag % 4)).stdout)

    def test_walls_that_face_away(self):
        (self.work / "housing.stl").write_text(stl())
        self.check(self.case(HOUSING.format(flipped="false")))
        run = self.check(self.case(HOUSING.format(flipped="true")), code=2)
        self.assertIn('inside of the closed [[wall]] "housing"', run.stderr)
        self.assertIn("normals_into_fluid", run.stderr)


if __name__ == "__main__":
    harness.main()
