# labels: long
# timeout: 1800
# cost: 90
"""Requirement: a flexible sheet that sinks broadside in a viscous liquid, two-way, bends as creeping flow bends it: the water around its ends resists more than the water around its middle, and the ends trail. A law of
drag for each particle alone does not bend it. Speed and deflection are those of a thin plate in creeping flow within 10 and 20 %.

Pressure jump p of a flat plate that moves across itself with the speed U, Stokes' equations (a layer of point forces), weight w per area:

  integral p(x')/|x - x'| dA' = 8 pi mu U,   integral p dA = w L W,   B W eta'''' = integral (p - w) dy,   eta'' = eta''' = 0 at the ends

The left side is that of the charge of a plate: a square of the side a has 8 pi mu U 0.3668 a, a disc of the radius a 16 mu a U. Released at rest, the plate has after the time t the speed U (1 - e^T erfc(T^(1/2))), T = nu t/a^2, a = w L W/(6 pi mu U):
mu a (v + a integral (dv/dt') (pi nu (t - t'))^(-1/2) dt') = mu a U, the friction of Boussinesq and Basset, in which only the radius a of the sphere of equal drag counts. For filaments the same bending is the weakly flexible limit of Xu and Nadim (1994), Phys. Fluids 6, 2889-2893, and Li, Manikantan, Saintillan and Spagnolie (2013), The sedimentation of flexible filaments, J. Fluid Mech. 735, 705-736."""
import math

import graded_box
import harness
import numpy

LENGTH, WIDTH, SPACING = 0.1, 0.04, 0.0025  # of the sheet and its particles, m
DENSITY, VISCOSITY, WEIGHT, BENDING = 1000.0, 10.0, 76.0, 5.2e-3  # kg/m3, Pa s, N/m2 in the liquid, N m
SIZE, END = 0.005, 0.8  # of the cells and the kernel, m; s
CASE = """
[case]
name = "sedimenting-sheet"
{mesh}
[time]
end_s = {end}
step_ms = 2                     # not longer than the square of the kernel over the viscosity: else the load at the edges takes many steps to settle
[gravity]
acceleration_m_s2 = [0, 0, -9.81]
[flow]
density_kg_m3 = 1000
dynamic_viscosity_Pa_s = 10
{water}
[output]
report = false
[[rag]]
length_m = 0.1
width_m = 0.04
radius_mm = 1.25
lengthwise = [1, 0, 0]
crosswise = [0, 1, 0]
mass_per_area_kg_m2 = {mass}
thickness_mm = 0.1
bond_law = "timoshenko_beam"
properties = "custom"
bending_stiffness_lengthwise_N_m3 = {bending}
bending_stiffness_crosswise_N_m3 = {crosswise}
normal_stiffness_lengthwise_N_m3 = {stretching}
normal_stiffness_crosswise_N_m3 = {stretching}
tangential_stiffness_lengthwise_N_m3 = {stretching}
tangential_stiffness_crosswise_N_m3 = {stretching}
[rag.timoshenko_beam]
shear_factor = 0
[contact]
self_contact = false
[coupling.sheet_drag]
form = "viscous"
"""
ONE_WAY = """
[coupling]
mode = "one_way"
forces = ["sheet_drag", "gravity"]
"""
TWO_WAY = """
normal_coefficient = 1e6
[coupling]
mode = "two_way"
kernel_width_m = 0.005
forces = ["sheet_drag", "gravity"]
[[boundary]]
patches = ["x0", "x1", "y0", "y1"]
kind = "wall"
[[boundary]]
patches = ["z0", "z1"]
kind = "pressure_outlet"
"""
LIQUID = """momentum_tolerance = 1e-5
pressure_tolerance = 1e-4
[turbulence]
model = "laminar"
"""


def load(length, width, nx=40, ny=20):
    """Middles and widths of strips across half of a plate from x = 0 on, and the force on each per length, over viscosity and speed."""
    edges = [side / 2 * numpy.sin(numpy.linspace(0, math.pi / 2, n + 1)) for side, n in ((length, nx), (width, ny))]
    x, y = (a.ravel() for a in numpy.meshgrid(*[(e[1:] + e[:-1]) / 2 for e in edges], indexing="ij"))
    low, high = ([a.ravel() for a in numpy.meshgrid(*[e[part] for e in edges], indexing="ij")] for part in (slice(None, -1), slice(1, None)))

    def corner(x, y):
        """Of the integral of 1/r over a rectangle."""
        return x * numpy.arcsinh(y / abs(x)) + y * numpy.arcsinh(x / abs(y))

    matrix = 0
    for sign_x in (1, -1):
        for sign_y in (1, -1):  # the four quarters have the same load
            x_low, x_high = numpy.sort([sign_x * low[0], sign_x * high[0]], axis=0)[:, None, :] - x[:, None]
            y_low, y_high = numpy.sort([sign_y * low[1], sign_y * high[1]], axis=0)[:, None, :] - y[:, None]
            matrix = matrix + corner(x_high, y_high) - corner(x_low, y_high) - corner(x_high, y_low) + corner(x_low, y_low)
    p = numpy.linalg.solve(matrix, numpy.full(len(x), 8 * math.pi)).reshape(nx, ny)
    return (edges[0][1:] + edges[0][:-1]) / 2, numpy.diff(edges[0]), 2 * p @ numpy.diff(edges[1])


def thin_plate():
    """Of the sheet in creeping flow: its speed, m/s, after a time in s, and places along half of it with their rise above its middle, m."""
    x, dx, line = load(LENGTH, WIDTH)
    steady = WEIGHT * LENGTH * WIDTH / (2 * line @ dx) / VISCOSITY
    radius = WEIGHT * LENGTH * WIDTH / (6 * math.pi * VISCOSITY * steady)

    def speed(time):
        T = VISCOSITY / DENSITY * time / radius**2
        return steady * (1 - math.exp(T) * math.erfc(math.sqrt(T)))

    places = numpy.linspace(0, LENGTH / 2, 401)
    moment = numpy.maximum(x - places[:, None], 0) @ ((VISCOSITY * steady * line - WEIGHT * WIDTH) * dx)
    slope = numpy.concatenate([[0], numpy.cumsum(moment[1:] + moment[:-1])]) * places[1] / 2 / (BENDING * WIDTH)
    return speed, places, numpy.concatenate([[0], numpy.cumsum(slope[1:] + slope[:-1])]) * places[1] / 2


class SedimentingSheet(harness.CaseTest):
    def sinking(self, mesh, water, coupling, end):
        """The run, and (x, z) along the sheet at its end, the mean of its rows."""
        radius = SPACING / 2
        bending = 4 * BENDING / (math.pi * radius**4)
        text = CASE.format(mesh=mesh, water=water, end=end, mass=WEIGHT / 9.81 + DENSITY * 1e-4, bending=bending, crosswise=10 * bending, stretching=bending * radius**2 / LENGTH**2 * 100) + coupling
        run = self.run_case(self.case(text), out=f"{len(mesh)}", timeout=1500)
        places, _ = harness.particles(sorted((run.folder / "rags").glob("particles_*.vtp"))[-1])
        return run, places.reshape(round(WIDTH / SPACING), -1, 3).mean(axis=0)[:, ::2]

    def two_way(self):
        mesh = self.shared / "box.msh"
        axes = [graded_box.axis(-1, 1, (-half, half), SIZE, 1.5) for half in (LENGTH / 2 + 2 * SIZE, WIDTH / 2 + 2 * SIZE)]
        graded_box.write(mesh, (*axes, graded_box.axis(-1, 1, (-0.05, 0.02), SIZE, 1.5)))
        return self.sinking(f'[mesh]\nfile = "{mesh}"', LIQUID, TWO_WAY, END)

    def one_way(self):
        return self.sinking("", 'kind = "prescribed"', ONE_WAY, END)

    def deflection(self, places):
        """Of the ends against the middle."""
        z, middle = places[:, 1], len(places) // 2
        print(f"  ends {1e3 * (z[0] - z[middle]):.3f} and {1e3 * (z[-1] - z[middle]):.3f} mm above the middle")
        self.assertLess(abs(z[0] - z[-1]), 2e-5, "symmetric")
        return (z[0] + z[-1]) / 2 - z[middle]

    def test_ends_trail(self):
        x, dx, line = load(LENGTH, LENGTH)
        self.assertLess(abs(2 * line @ dx / (8 * math.pi * 0.3668 * LENGTH) - 1), 1e-3, "charge of a square")
        speed, places, rise = thin_plate()
        late = speed(END)
        deflection = numpy.interp((LENGTH - SPACING) / 2, places, rise) - numpy.interp(SPACING / 2, places, rise)

        run, sheet = self.two_way()
        found, bent = -run.monitor("rags").column("vz")[-1], self.deflection(sheet)
        alone = self.deflection(self.one_way()[1])
        print(f"  after {END} s: speed {found:.5f} m/s, theory {late:.5f} ({100 * (found / late - 1):+.1f} %); deflection {1e3 * bent:.3f} mm, theory {1e3 * deflection:.3f} ({100 * (bent / deflection - 1):+.1f} %), "
              f"one-way {1e3 * alone:.3f} mm")
        self.assertLess(abs(found / late - 1), 0.1)
        self.assertLess(abs(bent / deflection - 1), 0.2)
        self.assertLess(abs(alone), 0.01 * deflection)


if __name__ == "__main__":
    harness.main()
