# timeout: 200
# cost: 6
"""Requirement: a limp strip that hangs in a stream stands straight at the critical angle of a towed cable, where its weight across itself equals the drag across itself, and pulls on its
hold with weight and drag of its whole length: Glauert (1934), The form of a heavy flexible cable used for towing a heavy body below an aeroplane, R&M 1592; Pode (1951)."""
import math

import harness
import numpy

LENGTH, WIDTH, N, ROWS = 0.06, 0.009, 20, 3  # m, m, columns, rows
DENSITY, NORMAL, TANGENTIAL = 1.2, 1.17, 0.02  # of air, kg/m3; C_n, C_t
WEIGHT = (0.785 - DENSITY * 0.77e-3) * 9.81  # per area, less buoyancy, N/m2
STRIP = """
[case]
name = "hanging-strip"
[time]
end_s = 6
step_ms = 10
[gravity]
acceleration_m_s2 = [0, 0, -9.81]
[flow]
kind = "prescribed"
density_kg_m3 = 1.2
dynamic_viscosity_Pa_s = 1.8e-5
velocity_m_s = [{speed}, 0, 0]
[[rag]]
length_mm = 60
width_mm = 9
radius_mm = 1.5
lengthwise = [0.5, 0, -1]
crosswise = [0, 1, 0]
properties = "custom"
normal_stiffness_lengthwise_N_m3 = 1e8
normal_stiffness_crosswise_N_m3 = 1e8
tangential_stiffness_lengthwise_N_m3 = 1e8
tangential_stiffness_crosswise_N_m3 = 1e8
# Bending length 1.7 mm, less than the spacing: it damps a zigzag of neighbouring particles, which does not change the normals that the drag sees.
bending_stiffness_lengthwise_N_m3 = 1e4
bending_stiffness_crosswise_N_m3 = 1e4
[[hold]]
edge = "first_column"
kind = "pin"
[coupling]
mode = "one_way"
forces = ["sheet_drag"]
[coupling.sheet_drag]
normal_coefficient = 1.17
tangential_coefficient = 0.02
[output]
report = false
"""


class HangingStrip(harness.CaseTest):
    def test_critical_angle(self):
        for speed in (2, 2.6, 3.3):  # at 6 m/s it flutters
            run = self.run_case(self.case(STRIP.format(speed=speed)), out=f"{speed}")
            # Of the strip to the stream: w cos(phi) = k w sin(phi)^2, k: drag across the stream over weight.
            k = 0.5 * DENSITY * NORMAL * speed**2 / WEIGHT
            cosine = (math.sqrt(1 + 4 * k * k) - 1) / (2 * k)
            exact, sine = math.degrees(math.acos(cosine)), math.sqrt(1 - cosine**2)
            places, _ = harness.particles(sorted((run.folder / "rags").glob("particles_*.vtp"))[-1])
            row = places[N : 2 * N, ::2]
            direction = (row[-1] - row[0]) / numpy.linalg.norm(row[-1] - row[0])
            angle = math.degrees(math.acos(direction[0]))
            bow = numpy.abs((row - row[0]) @ numpy.array([-direction[1], direction[0]])).max() / LENGTH
            area, along = LENGTH * WIDTH, DENSITY * TANGENTIAL * speed**2 * cosine**2
            across = 0.5 * DENSITY * NORMAL * speed**2 * sine**2
            drag = numpy.array([across * sine + along * cosine, across * cosine - along * sine - WEIGHT]) * area
            force = -numpy.array([run.monitor("holds").column(f"force_{axis}")[-1] for axis in "xz"])
            off = numpy.linalg.norm(force - drag) / numpy.linalg.norm(drag)
            print(f"  {speed} m/s: {angle:.3f} degrees to the stream, exact {exact:.3f}; bow {bow:.1e} of the length; force off by {off:.1e}")
            self.assertLess(abs(angle - exact), 0.05)
            self.assertLess(bow, 1e-3)
            self.assertLess(off, 1e-3)


if __name__ == "__main__":
    harness.main()
