# timeout: 600
# cost: 32
"""Requirement: a sphere larger than the cells meets the drag of its law, in a stream and along a wall, for its own wake is taken off what the kernel averages; and however wrong the kernel for it, a run stays
finite. Errors are those of the speed at which a sphere of the force found would fall (Galilei)."""
import math

import graded_box
import harness
import numpy

DIAMETER, SPEED, DENSITY = 1e-3, 0.1, 1000.0  # m, m/s, kg/m3
OFF_CENTRE = numpy.array([0.137, 0.211, 0.173])  # of a cell
CASE = """
[case]
name = "sphere"
[mesh]
file = "{mesh}"
[time]
end_s = {end:.12g}
step_s = {step:.12g}
[flow]
density_kg_m3 = {density}
dynamic_viscosity_Pa_s = {viscosity:.12g}
initial_velocity_m_s = {stream}
[turbulence]
model = "laminar"
{boundaries}
[[particle]]
diameter_m = {diameter}
density_kg_m3 = 1e9
position_m = {position}
velocity_m_s = {velocity}
[coupling]
mode = "two_way"
kernel = "{kernel}"
{width}
forces = {forces}
[output]
report = false
"""
WALL = """
[[boundary]]
patch = "y0"
kind = "wall"
[[boundary]]
patches = ["x0", "x1", "y1", "z0", "z1"]
kind = "symmetry"
[[wall]]
kind = "patches"
patches = ["y0"]
"""


def free_speed(force, viscosity):
    """Of a sphere on which this force acts, by the law of Schiller and Naumann, m/s."""
    lower, upper = 0.0, 100 * SPEED
    for _ in range(100):
        middle = (lower + upper) / 2
        drag = 3 * math.pi * viscosity * DIAMETER * middle * (1 + 0.15 * (DENSITY * middle * DIAMETER / viscosity) ** 0.687)
        lower, upper = (middle, upper) if drag < force else (lower, middle)
    return middle


def faxen(distance):
    """Drag along a wall over that in the open."""
    s = 0.5 * DIAMETER / distance
    return 1 / (1 - 9 / 16 * s + s**3 / 8 - 45 / 256 * s**4 - s**5 / 16)


class SphereDrag(harness.CaseTest):
    def error(self, Re, per_cell, kernel="gaussian", width=1, wall=None, far=55, steps=300, diameters=30, forces=("schiller_naumann", "self_disturbance")):
        """Of the speed, 1. Sphere of `per_cell` cells, kernel of `width` diameters; held in a stream for the time in which it goes by `diameters`, or moved along a wall at the distance of `wall` diameters for the time of
        diffusion over it; sides `far` diameters away."""
        size, viscosity = DIAMETER / per_cell, DENSITY * SPEED * DIAMETER / Re
        fine = math.ceil(max((3 if per_cell < 4 else 1.5) * width, 1.5, 2 / per_cell) * per_cell) * size
        reach, below = far * DIAMETER, (wall or far) * DIAMETER
        around = graded_box.axis(-reach, reach, (-fine, fine), size, 1.3)
        upwards = numpy.unique(graded_box.axis(-below, reach, (-below, fine), size, 1.3)) if wall else around
        name = f"sphere-{Re}-{per_cell}-{kernel}-{width}-{wall}-{far}-{steps}-{len(forces)}"
        mesh = self.shared / f"{name}.msh"
        graded_box.write(mesh, (around, upwards, around))
        end = 20 * below**2 * DENSITY / viscosity if wall else diameters * DIAMETER / SPEED
        position = OFF_CENTRE * size * ([1, 0, 1] if wall else [1, 1, 1])
        text = CASE.format(
            mesh=mesh,
            end=end,
            step=end / steps,
            density=DENSITY,
            viscosity=viscosity,
            stream=[0, 0, 0] if wall else [SPEED, 0, 0],
            boundaries=WALL if wall else graded_box.free_stream(SPEED),
            diameter=DIAMETER,
            position=list(map(float, position)),
            velocity=[-SPEED if wall else 0, 0, 0],
            kernel=kernel,
            width=f"kernel_width_m = {width * DIAMETER}" if kernel != "cell" else "",
            forces=list(forces),
        ).replace("'", '"')
        force = self.run_once(self.case(text, name), 1).monitor("coupling").column("force_on_rags_x [N]")
        self.assertTrue(numpy.isfinite(force).all() and (force > 0).all())
        return SPEED / free_speed(abs(force[-1]) / (faxen(below) if wall else 1), viscosity) - 1

    def check(self, bound, *arguments, **keys):
        error = self.error(*arguments, **keys)
        print(f"  {arguments} {keys}: {100 * error:+.2f} %", flush=True)
        with self.subTest(f"{arguments} {keys}"):
            self.assertLess(abs(error), bound)


class SphereDragShort(SphereDrag):
    def test_along_a_wall(self):
        self.check(0.05, 0.005, 2, wall=1, far=20, steps=60, forces=("schiller_naumann", "self_disturbance", "wall"))

    def test_in_a_stream(self):
        for kernel in ("gaussian", "satellite", "diffusion"):
            self.check(0.02, 10, 1, width=2, kernel=kernel, far=20, steps=60, diameters=15)

    def test_the_cell_kernel_stays_finite(self):
        """A sphere of four cells whose force goes into one of them."""
        error = self.error(1, 4, kernel="cell", far=15, steps=40, diameters=10)
        print(f"  cell kernel, sphere of four cells: {100 * error:+.0f} %")


if __name__ == "__main__":
    harness.main()
