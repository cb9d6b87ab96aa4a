# processors: 2
"""Requirement: [turbulence] in a case file chooses the model; its fields are written with units, start where the case says, and laminar runs have none."""
import numpy

import harness
from small_cases import CHANNEL_OUTLET_AND_WALLS

CHANNEL = """
[case]
name = "turbulent-channel"
[mesh]
file = "{mesh}"
[time]
end_s = 0.02
step_s = 5e-3
[flow]
initial_velocity_m_s = [2, 0, 0]
[turbulence]
model = "{model}"
[[boundary]]
patch = "inlet"
kind = "velocity_inlet"
velocity_m_s = [2, 0, 0]
{inlet}
""" + CHANNEL_OUTLET_AND_WALLS + """
[output]
fields_interval_s = 0.02
report = false
"""
MESH = ("channel", "length_mm=300", "height_mm=100", "width_mm=100", 'cells="tetrahedra"', "size_mm=20", "wall_ratio=1")
NAMES = {"turbulent_kinetic_energy [m2/s2]", "dissipation_rate [m2/s3]", "eddy_viscosity [m2/s]"}
OMEGA = "specific_dissipation_rate [1/s]"


def cell_fields(file):
    return harness.arrays(harness.read_vtk(file).GetCellData())


class Turbulence(harness.CaseTest):
    def channel(self, model, inlet="", name="case"):
        return self.case(CHANNEL.format(mesh=self.mesh(*MESH), model=model, inlet=inlet), name)

    def test_fields_of_k_epsilon(self):
        run = self.run_case(self.channel("k_epsilon", "turbulence_intensity = 0.1"), 2)
        files = sorted((run.folder / "fields").glob("*.pvtu"))
        first, last = cell_fields(files[0]), cell_fields(files[-1])
        for found in (first, last):
            self.assertLessEqual(NAMES, set(found))
            for name in NAMES:
                self.assertTrue(numpy.isfinite(found[name]).all() and (found[name] >= 0).all(), name)
        k, epsilon, nu_t = (last[n] for n in ("turbulent_kinetic_energy [m2/s2]", "dissipation_rate [m2/s3]", "eddy_viscosity [m2/s]"))
        numpy.testing.assert_allclose(nu_t, 0.09 * k**2 / epsilon, rtol=1e-5)
        at_inlet = 1.5 * (0.1 * 2) ** 2  # decays on the way
        self.assertTrue(0.001 < k.min() < 0.9 * at_inlet < k.max() < 1, f"k from {k.min()} to {k.max()} m2/s2")

    def test_fields_of_sst(self):
        run = self.run_case(self.channel("k_omega_sst", "turbulence_intensity = 0.1"), 2)
        found = cell_fields(sorted((run.folder / "fields").glob("*.pvtu"))[-1])
        k, epsilon, nu_t, omega = (found[n] for n in ("turbulent_kinetic_energy [m2/s2]", "dissipation_rate [m2/s3]", "eddy_viscosity [m2/s]", OMEGA))
        numpy.testing.assert_allclose(epsilon, 0.09 * k * omega, rtol=1e-5)
        self.assertTrue((nu_t <= k / omega * 1.00001).all() and (nu_t > 0).all())

    def test_laminar_has_none(self):
        run = self.run_case(self.channel("laminar"), 1)
        for file in (run.folder / "fields").glob("*.pvtu"):
            self.assertFalse((NAMES | {OMEGA}) & set(cell_fields(file)), file.name)

    def test_run_without_turbulence_is_no_success(self):
        """Weak at inlet and start, and no time to grow: the water goes as a laminar one at a Reynolds number of 2e5, behind wall functions."""
        case = self.channel("k_epsilon", "turbulence_intensity = 1e-5")
        alive = self.run_case(self.channel("k_epsilon", "turbulence_intensity = 0.1", "alive"), 2, out="alive")
        self.assertLess(alive.summary["water"]["molecular_over_eddy_viscosity"], 0.1)
        weak = [word for one in ("turbulence.initial_k_m2_s2=1e-9", "turbulence.initial_epsilon_m2_s3=1", "time.step_s=1e-5", "time.end_s=3e-5") for word in ("--set", one)]
        none = self.run_case(case, 2, *weak, code=4)
        self.assertGreater(none.summary["water"]["molecular_over_eddy_viscosity"], 1)
        self.assertIn("no turbulence at the end", "\n".join(none.messages))
        viscous = self.run_case(case, 2, "--set", "turbulence.model=laminar", out="laminar")
        self.assertIsNone(viscous.summary["water"]["molecular_over_eddy_viscosity"])

    def test_unknown_model(self):
        run = self.run_case(self.channel("k_epsilom"), 1, code=2)
        self.assertIn("k_epsilon", "\n".join(run.messages))


if __name__ == "__main__":
    harness.main()
