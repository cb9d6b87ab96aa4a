# labels: long
# timeout: 1800
# cost: 200
"""Requirement: a buoyant blade of foam, 5 times as long as wide, that stands in a stream and bends over, two-way, has drag and height of the model of Luhar and Nepf (2011), with the drag coefficient of a rigid blade in the
same mesh, within 25 % and 0.12 of its length. The model counts the speed across the blade alone; an inclined plate as short as this one has more (inclined_plate.py)."""
import math

import elastica
import graded_box
import harness
import numpy

LENGTH, WIDTH, SPEED, SIZE = 0.1, 0.02, 0.2, 0.0025  # m, m, m/s; of cells, particles and kernel, m
FOAM, STIFFNESS = 330 * 9.81 * 1.9e-3, 2.86e-4  # buoyancy less weight per area, N/m2; of foam of 0.5 MPa and 1.9 mm, per width, N m
CASE = """
[case]
name = "blade"
[mesh]
file = "{mesh}"
[time]
end_s = 3.5
step_ms = 12.5
[gravity]
acceleration_m_s2 = [0, 0, -9.81]
[flow]
density_kg_m3 = 1000
dynamic_viscosity_Pa_s = 1e-3
initial_velocity_m_s = [0.2, 0, 0]
momentum_tolerance = 1e-6
[turbulence]
model = "realizable_k_epsilon"
[output]
report = false
[[rag]]
length_mm = 100
width_mm = 10                   # half of the blade, from the plane of symmetry on
radius_mm = 1.25
centre_m = [0, 0.005, 0.05]
lengthwise = [0, 0, 1]
crosswise = [0, 1, 0]
mass_per_area_kg_m2 = 1.273
thickness_mm = 1.9
bond_law = "timoshenko_beam"
properties = "custom"
bending_stiffness_lengthwise_N_m3 = {bending}
bending_stiffness_crosswise_N_m3 = {bending}
normal_stiffness_lengthwise_N_m3 = 1e9
normal_stiffness_crosswise_N_m3 = 1e9
tangential_stiffness_lengthwise_N_m3 = 1e9
tangential_stiffness_crosswise_N_m3 = 1e9
[rag.timoshenko_beam]
shear_factor = 0
[[hold]]
edge = "first_column"
[contact]
self_contact = false
[coupling]
mode = "two_way"
kernel_width_mm = 2.5
forces = ["sheet_drag", "gravity"]
[coupling.sheet_drag]
normal_coefficient = 1000
tangential_coefficient = 0.005
""" + graded_box.free_stream(SPEED)


class BladeLong(harness.CaseTest):
    def blade(self, stiffness):
        """The run, and the drag coefficient at its end."""
        mesh = self.shared / "stream.msh"
        if not mesh.exists():
            half = graded_box.axis(-1, 0.25, (0, 0.02), SIZE, 1.25), graded_box.axis(-1, 0.35, (0, 0.11), SIZE, 1.25)
            graded_box.write(mesh, (graded_box.axis(-0.3, 0.6, (-0.0125, 0.11), SIZE, 1.25), *(nodes[nodes > -1e-9] for nodes in half)))
        text = CASE.format(mesh=mesh, bending=4 * stiffness / (math.pi * (SIZE / 2) ** 4))
        run = self.run_case(self.case(text, f"{stiffness}"), out=f"{stiffness}", timeout=1500)
        return run, -2 * run.monitor("holds").column("force_x")[-1] / (500 * SPEED**2 * LENGTH * WIDTH)

    def model(self, rigid):
        """C, drag coefficient, and over the length the height of the last particles and places (x, z) from the ground to the tip, of a blade that has the drag coefficient `rigid` when it is upright."""
        free, held = LENGTH - SIZE / 2, SIZE / 2  # above and below the clamp
        C = 500 * rigid * SPEED**2 * free**3 / (3 * STIFFNESS)
        states = elastica.blade(C, FOAM * free**3 / (3 * STIFFNESS))
        theta = states[::-1, 0]
        way = [numpy.concatenate([[0], numpy.cumsum(of[1:] + of[:-1])]) / (2 * len(theta) - 2) * free for of in (numpy.sin(theta), numpy.cos(theta))]
        shape = numpy.concatenate([[[0, 0]], numpy.stack(way, axis=1) + [0, held]]) / LENGTH
        return C, rigid * (states[-1, 2] * free + held) / LENGTH, shape[-1, 1] - held / LENGTH * math.cos(theta[-1]), shape

    def test_blade_bends_over(self):
        _, rigid = self.blade(300 * STIFFNESS)
        run, drag = self.blade(3 * STIFFNESS)
        C, model, model_height, _ = self.model(rigid)
        height = run.monitor("rags").column("z_max")[-1] / LENGTH
        print(f"  Ca {C:.0f}: drag coefficient of the rigid blade {rigid:.3f}, bent {drag:.3f}, model {model:.3f} ({100 * (drag / model - 1):+.0f} %); height {height:.3f}, model {model_height:.3f}")
        self.assertLess(drag, 0.6 * rigid)
        self.assertLess(abs(drag / model - 1), 0.25)
        self.assertLess(abs(height - model_height), 0.12)


if __name__ == "__main__":
    harness.main()
