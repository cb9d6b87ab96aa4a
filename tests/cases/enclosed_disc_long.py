# labels: long
# timeout: 3000
# cost: 500
"""Requirement: the torque of a disc that turns in its housing is the measured one within 3 % in laminar and 10 % in turbulent flow, with cells at y+ 1 and with wall functions.
Daily and Nece (1960): C_M = 0.0512 G^0.1 Re^-0.2 of one side, turbulent, separate layers."""
import enclosed_disc
import harness

SST = """[turbulence]
model = "k_omega_sst"
initial_k_m2_s2 = 0.01
initial_epsilon_m2_s3 = 0.1"""


class EnclosedDiscLong(enclosed_disc.Disc):
    def turbulent(self, first, n):
        reynolds, gap = 1e6, 0.1
        return self.deviation(0.0512 * gap**0.1 * reynolds**-0.2, reynolds, gap, turbulence=SST, first=first, at_rim=5e-4, n=n, step=0.2, turns=24)

    def test_laminar(self):
        self.assertLess(self.laminar(3e4), 0.03)

    def test_laminar_thin_layers(self):
        self.assertLess(self.laminar(1e5), 0.05)

    def test_turbulent(self):
        self.assertLess(self.turbulent(5e-6, (40, 48)), 0.10)

    def test_turbulent_with_wall_functions(self):
        self.assertLess(self.turbulent(1.5e-4, (40, 24)), 0.10)


if __name__ == "__main__":
    harness.main()
