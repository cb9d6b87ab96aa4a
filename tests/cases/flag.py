# timeout: 300
# cost: 10
"""Requirement: a closed flag, two-way, grows or decays with the rate and the frequency of the linear theory of flutter (flag_theory.py), and the theory has lift and moment of Theodorsen (1935)."""
import math

import flag_theory
import graded_box
import harness
import numpy

LENGTH, SPEED, DENSITY = 0.1, 1.0, 1000.0  # m, m/s, kg/m3
CASE = """
[case]
name = "flag"
[mesh]
file = "{mesh}"
[time]
end_s = {end}
step_s = {step}
[flow]
density_kg_m3 = 1000
dynamic_viscosity_Pa_s = 1e-3
initial_velocity_m_s = [1, 0, 0]
[turbulence]
model = "laminar"
[output]
report = false
[[rag]]
length_mm = 100
width_m = {width}
radius_m = {radius}
centre_m = [0.05, 0, {middle}]
velocity_m_s = [0, 0.02, 0]     # of all but the first column: a small push
lengthwise = [1, 0, 0]
crosswise = [0, 0, 1]
mass_per_area_kg_m2 = {mass}
bond_law = "timoshenko_beam"
properties = "custom"
bending_stiffness_lengthwise_N_m3 = {bending}
bending_stiffness_crosswise_N_m3 = {bending}
normal_stiffness_lengthwise_N_m3 = {stretching}
normal_stiffness_crosswise_N_m3 = {stretching}
tangential_stiffness_lengthwise_N_m3 = {stretching}
tangential_stiffness_crosswise_N_m3 = {stretching}
bond_damping = 0.1
rotation_friction = 0
[rag.timoshenko_beam]
shear_factor = 0
[[hold]]
edge = "first_column"
[contact]
self_contact = false
[coupling]
mode = "two_way"
kernel_width_m = {delta}
forces = ["sheet_drag"]
[coupling.sheet_drag]
normal_coefficient = 1e6        # of the small pressure of a small motion 1e3 would let through as much as the flag moves
tangential_coefficient = 0
""" + graded_box.free_stream(1)


class Flag(harness.CaseTest):
    """A strip of two rows in one layer of cells between planes of symmetry: the flow is in two dimensions."""

    theory = flag_theory.Flag()

    def mode(self, mu, beta, size, delta, step, begin, end):
        """Growth and frequency (sigma L/U) of the flag's centre of mass between two times; `size` of cells, kernel width `delta`, `step` in units of L and L/U."""
        radius, width = size / 4 * LENGTH, size * LENGTH
        along, across = graded_box.axis(-0.3, 0.6, (-0.025, 0.15), width, 1.25), graded_box.axis(-0.3, 0.3, (-4 * width, 4 * width), width, 1.25)
        mesh = self.shared / f"{size}.msh"
        if not mesh.exists():
            graded_box.write(mesh, (along, across, numpy.array([0, width])))
        bending = 4 * beta * DENSITY * SPEED**2 * LENGTH**3 / (math.pi * radius**4)
        text = CASE.format(mesh=mesh, end=end * LENGTH / SPEED, step=step * LENGTH / SPEED, width=width, radius=radius, middle=width / 2, mass=mu * DENSITY * LENGTH, bending=bending,
                           stretching=bending * radius**2 / LENGTH**2 * 100, delta=delta * LENGTH)
        run = self.run_once(self.case(text, f"{mu}-{beta:.6g}-{size}-{delta}"), 1)
        rags = run.monitor("rags")
        time, y = rags.column("time"), rags.column("y")
        late = time > (begin - 1e-9) * LENGTH / SPEED
        theory = self.theory.flutter_mode(mu, beta)
        found = flag_theory.observed_mode(time[late] * SPEED / LENGTH, y[late], theory.imag)
        print(f"  mass {mu:g}, stiffness {beta:.3g}, cells {size:g}, kernel {delta:g}: growth {found.real:+.3f}, frequency {found.imag:.3f}; theory {theory:.3f}; "
              f"largest {abs(y).max() / LENGTH:.1e} L", flush=True)
        return found


class FlagShort(Flag):
    def test_theory_has_lift_and_moment_of_theodorsen(self):
        """Of a rigid plate that heaves by h and turns by alpha about the point a half chords behind its middle."""
        self.assertLess(abs(flag_theory.theodorsen(0.5j) - (0.5979 - 0.1507j)), 1e-4, "table of the report")
        theta, h, alpha, a, half = flag_theory.points(), 0.3, 0.2 + 0.1j, -0.3, 0.5
        arm, weight = numpy.cos(theta) / 2 - a * half, numpy.pi / flag_theory.N_POINTS * numpy.sin(theta) / 2
        for sigma in (0.4j, 3j, 0.5 + 2j):
            V = -sigma * (h + alpha * arm) - alpha
            p = flag_theory.pressure(flag_theory.coefficients(V), sigma * half, theta)
            Q = flag_theory.theodorsen(sigma * half) * (sigma * h + alpha + half * (0.5 - a) * sigma * alpha)
            lift = math.pi * half**2 * (sigma**2 * h + sigma * alpha - half * a * sigma**2 * alpha) + 2 * math.pi * half * Q
            moment = math.pi * half**2 * (half * a * sigma**2 * h - half * (0.5 - a) * sigma * alpha - half**2 * (1 / 8 + a * a) * sigma**2 * alpha) + 2 * math.pi * half**2 * (a + 0.5) * Q
            self.assertLess(abs((p * weight).sum() - lift), 1e-12)
            self.assertLess(abs(-(p * weight * arm).sum() - moment), 1e-12)

    def test_soft_flag_grows_and_stiff_flag_decays(self):
        for beta in (0.02, 0.05):
            theory, found = self.theory.flutter_mode(1, beta), self.mode(1, beta, 0.025, 0.025, 0.02, 3, 9)
            self.assertLess(abs(found - theory), 0.05 * abs(theory))


if __name__ == "__main__":
    harness.main()
