# timeout: 300
# cost: 10
"""Requirement: a strip of cloth that is folded over on a table comes to rest as a loop of the height (B/w)^(1/3)/1.103, B bending stiffness and w weight per width, within 0.3 %, and
the error of a coarser lattice falls with its spacing: loop test of Stuart (1966), Br. J. Appl. Phys. 17, 1215-1220."""
import math

import elastica
import harness
import numpy

LENGTH, BENDING_LENGTH = 0.24, 0.04  # of the strip and c, m
WEIGHT = 0.785 * 9.81  # per area, N/m2
ROWS, STRETCH = 3, 5e3  # stretch: S_n r^2, N/m; the strip hardly stretches
END = 0.7  # s
DAMPING = 30  # of the air, 1/s: nearly the critical one of a motion over c
STRIP = """
[case]
name = "loop"
[time]
end_s = {end}
step_ms = 5
[gravity]
acceleration_m_s2 = [0, 0, -9.81]
[contact]
impact_speed_m_s = 0.5
[[wall]]
kind = "plane"
point_m = [0, 0, {floor}]
normal = [0, 0, 1]
[[rag]]
length_m = 0.24
width_m = {width}
radius_m = {radius}
pose_file = "pose.csv"
properties = "custom"
{bonds}
[flow]
kind = "prescribed"
density_kg_m3 = 1e-3
dynamic_viscosity_Pa_s = {viscosity}
velocity_m_s = [0, 0, 0]
[coupling]
mode = "one_way"
forces = ["free_stream_drag", "gravity"]
[output]
report = false
"""


def fold(n, spacing):
    """Places (x, z) and angles of a strip that lies on the table, turns over in a half circle of the radius 0.6 c, and goes back flat in the air."""
    flat, radius = 0.9 * BENDING_LENGTH, 0.6 * BENDING_LENGTH
    s = (numpy.arange(n) + 0.5) * spacing
    angle = numpy.clip((s - flat) / radius, 0, math.pi)
    rest = numpy.maximum(s - flat - math.pi * radius, 0)
    x = numpy.minimum(s, flat) + radius * numpy.sin(angle) - rest
    return numpy.stack([x, radius * (1 - numpy.cos(angle))], axis=1), angle


class StuartLoop(harness.CaseTest):
    def pose(self, n, spacing):
        places, angles = fold(n, spacing)
        lines = ["id,x,y,z,qw,qx,qy,qz"]
        for row in range(ROWS):
            for column, ((x, z), angle) in enumerate(zip(places, angles)):  # turned about -y
                y = (row - (ROWS - 1) / 2) * spacing
                lines.append(f"{row * n + column},{x:.9g},{y:.9g},{z:.9g},{math.cos(angle / 2):.9g},0,{-math.sin(angle / 2):.9g},0")
        (self.work / "pose.csv").write_text("\n".join(lines) + "\n")

    def outline(self, n):
        """(x, z) of the middle row at rest, in c; the strip of n columns lies on its table at z = 0."""
        spacing = LENGTH / n
        radius = spacing / 2
        self.pose(n, spacing)
        stiffness = {"bending": 4 * WEIGHT * BENDING_LENGTH**3 / (math.pi * radius**4), "normal": STRETCH / radius**2, "tangential": STRETCH / radius**2}
        bonds = "\n".join(f"{kind}_stiffness_{way}wise_N_m3 = {value!r}" for kind, value in stiffness.items() for way in ("length", "cross"))
        viscosity = DAMPING * 0.785 * spacing / (3 * math.pi)  # Stokes' drag of a particle over its mass: DAMPING
        case = self.case(STRIP.format(end=END, floor=-radius, width=ROWS * spacing, radius=radius, bonds=bonds, viscosity=viscosity))
        run = self.run_case(case, out=f"{n} columns")
        pictures = sorted((run.folder / "rags").glob("particles_*.vtp"))
        before, after = (harness.particles(file)[0][n : 2 * n, ::2] / BENDING_LENGTH for file in (pictures[-10], pictures[-1]))
        print(f"  {n} columns: moved in the last tenth by {numpy.abs(after - before).max():.1e} c")
        self.assertLess(numpy.abs(after - before).max(), 1e-3, "at rest")
        return after

    def error(self, n):
        """Of the height of the loop of n columns."""
        exact, outline = elastica.stuart_loop(1000)[:, 1].max(), self.outline(n)
        top = outline[:, 1].argmax()
        a, b, c = outline[top - 1 : top + 2, 1]
        height = b - (c - a) ** 2 / (8 * (a - 2 * b + c))  # of the parabola through the three highest
        print(f"  {n} columns, {n * BENDING_LENGTH / LENGTH:g} to c: c over height {1 / height:.4f}, exact {1 / exact:.4f}, deviation {100 * (height / exact - 1):+.2f} %")
        return height / exact - 1

    def test_height_of_the_loop(self):
        self.assertLess(abs(1.103 * elastica.stuart_loop(1000)[:, 1].max() - 1), 1e-3, "the number of the paper")
        coarse, fine = self.error(60), self.error(120)
        self.assertLess(abs(fine), 0.003)
        self.assertGreater(math.log2(coarse / fine), 1.7, "second order")


if __name__ == "__main__":
    harness.main()
