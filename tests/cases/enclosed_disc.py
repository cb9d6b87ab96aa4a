# cost: 15
# timeout: 1200
"""Requirement: the torque of a disc that turns in its housing is the measured one within 3 % in laminar flow, with separate layers on disc and wall: the friction of the
side rooms of a pump's impeller. Daily and Nece (1960), J. Basic Eng. 82, 217-232: T = 1/2 C_M rho Omega^2 a^5 of one side, C_M = 1.85 G^0.1 Re^-0.5, G = s/a, Re = Omega a^2/nu."""
import numpy

import graded_box
import harness

RADIUS, RIM, AXIS, OMEGA, DENSITY = 0.1, 0.1006, 0.01, 50.0, 1000.0  # m: of the disc, the housing, and the cylinder that is cut out around the axis; rad/s, kg/m3
CASE = """
[mesh]
file = "{mesh}"
[time]
step_s = {step}
end_s = {end}
[flow]
density_kg_m3 = {density}
kinematic_viscosity_m2_s = {viscosity}
n_outer_correctors = 2
momentum_tolerance = 1e-5
pressure_tolerance = 1e-4
{turbulence}
[[boundary]]
patch = "disc"
kind = "moving_wall"
rotation_speed_rad_s = {omega}
[[boundary]]
patches = ["bottom", "inner"]
kind = "symmetry"
[[boundary]]
patches = ["top", "outer"]
kind = "wall"
[output]
report = false
fields_interval_s = 1000
"""


class Disc(harness.CaseTest):
    def coefficient(self, reynolds, gap, sectors=24, turbulence="[turbulence]\nmodel = \"laminar\"", first=None, at_rim=None, n=(40, 32), step=0.4, turns=20):
        """C_M of one side at the end."""
        viscosity = OMEGA * RADIUS**2 / reynolds
        layer = (viscosity / OMEGA) ** 0.5
        first = first or 0.3 * layer
        heights = graded_box.towards((0, gap * RADIUS), n[1], first)
        within = graded_box.towards((AXIS, RADIUS), n[0], at_rim or 3 * first)
        radii = numpy.concatenate([within, graded_box.towards((RADIUS, RIM), 4, 0.2 * (RIM - RADIUS))[1:]])
        mesh = self.work / "ring.msh"
        graded_box.write_ring(mesh, sectors, radii, heights, disc=RADIUS)
        text = CASE.format(mesh=mesh, step=step / OMEGA, end=round(2 * numpy.pi * turns / step) * step / OMEGA, density=DENSITY, viscosity=viscosity, turbulence=turbulence, omega=OMEGA)
        run = self.run_case(self.case(text), 1, timeout=1000)
        torque = run.monitor("patches").column("disc_torque_z")
        C = -2 * torque / (DENSITY * OMEGA**2 * RADIUS**5)
        print(f"  Re {reynolds:g}, G {gap}: C_M {C[-1]:.5f}, two turns before {C[-1 - round(4 * numpy.pi / step)]:.5f}", flush=True)
        return C[-1]

    def deviation(self, measured, reynolds, gap, **keys):
        C = self.coefficient(reynolds, gap, **keys)
        print(f"  measured {measured:.5f}: {100 * (C / measured - 1):+.1f} %", flush=True)
        return abs(C / measured - 1)

    def laminar(self, reynolds, gap=0.1):
        return self.deviation(1.85 * gap**0.1 * reynolds**-0.5, reynolds, gap)


class EnclosedDisc(Disc):
    def test_laminar(self):
        self.assertLess(self.laminar(1e4), 0.03)


if __name__ == "__main__":
    harness.main()
