# timeout: 200
# cost: 7
"""Requirement: a blade that stands on the ground in a prescribed stream, bends over and is lifted by its buoyancy has the drag, the pull and the height of the model of Luhar and Nepf (2011), Limnol. Oceanogr.
56, 2003-2017, for blades of foam and of plastic like theirs."""
import math

import elastica
import harness

LENGTH, DENSITY, DRAG, GRAVITY = 0.2, 1000.0, 1.95, 9.81  # m, kg/m3, C_D, m/s2
COLUMNS, ROWS = 40, 2  # of particles
RADIUS = LENGTH / (2 * COLUMNS - 1)  # m: from the clamp at the middle of the first column to the end of the last
# Density, modulus, thickness (kg/m3, Pa, m), and speeds of the stream (m/s) with the time in which the blade comes to rest (s).
BLADES = {"foam": (670, 5e5, 1.9e-3, {0.05: 12, 0.16: 6}), "plastic": (950, 0.93e9, 0.4e-3, {0.11: 7, 0.32: 3})}
CASE = """
[case]
name = "blade"
[time]
end_s = {end}
step_ms = 10
[gravity]
acceleration_m_s2 = [0, 0, -9.81]
[flow]
kind = "prescribed"
density_kg_m3 = 1000
dynamic_viscosity_Pa_s = 1e-3
velocity_m_s = [{speed}, 0, 0]
[[rag]]
length_m = {length}
width_m = {width}
radius_m = {radius}
centre_m = [0, 0, {middle}]     # the clamp is at z = 0
lengthwise = [0, 0, 1]
crosswise = [0, 1, 0]
mass_per_area_kg_m2 = {mass}
thickness_m = {thickness}
bond_law = "timoshenko_beam"
properties = "custom"
bending_stiffness_lengthwise_N_m3 = {bending}
bending_stiffness_crosswise_N_m3 = {bending}
normal_stiffness_lengthwise_N_m3 = 1e8
normal_stiffness_crosswise_N_m3 = 1e8
tangential_stiffness_lengthwise_N_m3 = 1e8
tangential_stiffness_crosswise_N_m3 = 1e8
[rag.timoshenko_beam]
shear_factor = 0
[[hold]]
edge = "first_column"
[coupling]
mode = "one_way"
forces = ["sheet_drag", "gravity"]
[coupling.sheet_drag]
normal_coefficient = 1.95
tangential_coefficient = 0
[output]
report = false
"""


class Blade(harness.CaseTest):
    def test_blades_bend_and_drag_like_the_model(self):
        for name, (density, modulus, thickness, speeds) in BLADES.items():
            stiffness = modulus * thickness**3 / 12  # per width, N m
            buoyancy = (DENSITY - density) * GRAVITY * thickness * LENGTH**3 / stiffness
            for speed, end in speeds.items():
                text = CASE.format(length=2 * COLUMNS * RADIUS, width=2 * ROWS * RADIUS, radius=RADIUS, middle=LENGTH / 2 - RADIUS / 2, end=end, speed=speed, mass=density * thickness, thickness=thickness, bending=4 * stiffness / (math.pi * RADIUS**4))
                run = self.run_case(self.case(text, f"{name}-{speed}"), out=f"{name}-{speed}")
                C = 0.5 * DENSITY * DRAG * speed**2 * LENGTH**3 / stiffness
                states = elastica.blade(C, buoyancy)
                unit = 0.5 * DENSITY * DRAG * speed**2 * ROWS * 2 * RADIUS * LENGTH  # N
                # The held particles stand upright; half of them is below the clamp.
                drag, pull = (states[-1, 2] + RADIUS / LENGTH) * unit, (states[-1, 3] + buoyancy / C * RADIUS / LENGTH) * unit
                cosines = [math.cos(angle) for angle in states[::-1, 0]]
                height = LENGTH * (sum(cosines) - (cosines[0] + cosines[-1]) / 2) / (len(cosines) - 1) - RADIUS * cosines[-1]
                holds, rags = run.monitor("holds"), run.monitor("rags")
                found = {"drag": -holds.column("force_x")[-1], "pull": -holds.column("force_z")[-1], "height": rags.column("z_max")[-1]}
                print(f"  {name}, {speed} m/s (Ca {C:.0f}, B {buoyancy:.1f}): drag over that upright {found['drag'] / unit:.4f}, model {drag / unit:.4f}; pull {found['pull'] / unit:.4f}, {pull / unit:.4f}; "
                      f"height {found['height'] / LENGTH:.4f}, {height / LENGTH:.4f}", flush=True)
                with self.subTest(name=name, speed=speed):
                    self.assertLess(abs(found["drag"] / drag - 1), 0.005)
                    self.assertLess(abs(found["pull"] - pull), 0.005 * unit)
                    self.assertLess(abs(found["height"] - height), 0.003 * LENGTH)


if __name__ == "__main__":
    harness.main()
