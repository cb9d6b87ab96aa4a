# timeout: 200
# cost: 20
"""Requirement: water that is drawn out by a given rate, or leaves by a convective outlet from rest, leaves as it comes on tetrahedra, too; the
pressure at an inlet has the acceleration of the water; entering water without turbulence is no error in any model; a run that diverges between given
pressures says so."""
import harness
import numpy

BOX = """
[mesh]
geometry = "box"
set = ["lower_m=[0,0,0]", "upper_m=[0.3,0.1,0.1]", "size_m={size}", "cells=\\"{cells}\\""]
[time]
end_s = {end}
step_s = {step}
[flow]
kinematic_viscosity_m2_s = 1e-6
{flow}
[turbulence]
model = "{model}"
{turbulence}
[[boundary]]
patch = "x0"
{inlet}
[[boundary]]
patch = "x1"
{outlet}
[[boundary]]
patches = ["y0", "y1", "z0", "z1"]
kind = "{sides}"
[output]
fields_interval_s = {end}
single_precision = false
report = false
"""


class Openings(harness.CaseTest):
    def box(self, name, ranks=1, code=0, **values):
        usual = dict(size=0.025, cells="tetrahedra", end=1, step=0.01, flow="", model="laminar", turbulence="", sides="symmetry",
                     inlet='kind = "velocity_inlet"\nnormal_speed_m_s = 0.2', outlet='kind = "pressure_outlet"')
        return self.run_case(self.case(BOX.format(**{**usual, **values}), name), ranks, out=name, code=code)

    def velocity(self, run):
        grid = harness.read_vtk(max((run.folder / "fields").glob("water*.pvtu")))
        return harness.arrays(grid.GetCellData())["velocity [m/s]"]

    def test_water_drawn_out(self):
        """By a rate, and the exact stream between two given velocities, whose error must not grow from round-off."""
        tank = 'kind = "pressure_inlet"'
        drawn = 'kind = "flow_rate_inlet"\nflow_rate_L_s = -2'
        found = self.velocity(self.box("rate", 2, inlet=tank, outlet=drawn, sides="wall", end=2))
        self.assertLess(numpy.linalg.norm(found, axis=1).max(), 2.1 * 0.2)  # at most that of a developed flow
        out = 'kind = "velocity_inlet"\nnormal_speed_m_s = -0.2'
        found = self.velocity(self.box("stream", outlet=out, end=4, flow="initial_velocity_m_s = [0.2, 0, 0]"))
        self.assertLess(numpy.abs(found - [0.2, 0, 0]).max(), 1e-9)

    def test_convective_outlet_from_rest(self):
        inlet = 'kind = "velocity_inlet"\nnormal_speed_m_s = 0.2\nramp_s = 1'
        found = self.velocity(self.box("ramp", inlet=inlet, outlet='kind = "convective_outlet"', sides="wall", end=1.5))
        self.assertLess(numpy.linalg.norm(found, axis=1).max(), 2.1 * 0.2)

    def test_pressure_of_an_inlet_that_speeds_up(self):
        """Without friction the difference of the pressures accelerates the water: rho L dU/dt = 1000 * 0.3 * 0.1 = 30 Pa."""
        for name, inlet in (("velocity", 'kind = "velocity_inlet"\nnormal_speed_m_s = 0.2'),
                            ("rate", 'kind = "flow_rate_inlet"\nflow_rate_L_s = 2')):
            run = self.box(name, cells="hexahedra", inlet=inlet + "\nramp_s = 2", end=0.1, flow="density_kg_m3 = 1000")
            self.assertLess(numpy.abs(run.monitor("patches").column("x0_pressure") - 30).max(), 1e-6, name)

    def test_no_turbulence_enters(self):
        inlet = 'kind = "velocity_inlet"\nnormal_speed_m_s = 0.2\nturbulence_intensity = 0'
        start = "initial_k_m2_s2 = 1e-4\ninitial_epsilon_m2_s3 = 1e-4"
        for model in ("k_epsilon", "realizable_k_epsilon", "k_omega_sst"):
            self.box(model, inlet=inlet, sides="wall", model=model, turbulence=start, end=0.2)

    def test_divergence_between_given_pressures(self):
        """The scale of the speeds is that of the pressures that are given, however fast the water becomes."""
        run = self.box("divergence", code=4, cells="hexahedra", end=20, step=0.4, sides="wall", inlet='kind = "pressure_inlet"\npressure_Pa = 500',
                       flow='convection = "central"\nn_outer_correctors = 1\ninitial_velocity_m_s = [0.1, 0.1, 0]')
        self.assertIn("the case has a speed of 1 m/s", " ".join(run.messages))


if __name__ == "__main__":
    harness.main()
