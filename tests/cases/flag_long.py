# labels: long
# timeout: 3600
# cost: 600
"""Requirement: the flutter of a flag, two-way, begins at the speed and with the frequency of the linear theory, within 5 % (12 % where the mass is that of the water; frequency 10 %), for flags heavier and lighter than the water about them and for two kernels."""
import elastica
import flag
import harness
import numpy


class FlagLong(flag.Flag):
    def onset(self, mu, stiffnesses, *resolution):
        """Speed and frequency of a given flag where its growth begins: between two stiffnesses of different signs the deviation from the theory is interpolated."""
        found = [self.mode(mu, beta, *resolution) for beta in stiffnesses]
        deviations = [mode - self.theory.flutter_mode(mu, beta) for mode, beta in zip(found, stiffnesses)]

        def mode(beta):
            part = numpy.log(beta / stiffnesses[0]) / numpy.log(stiffnesses[1] / stiffnesses[0])
            return self.theory.flutter_mode(mu, beta) + (1 - part) * deviations[0] + part * deviations[1]

        with self.subTest(mu=mu, resolution=resolution):
            self.assertLess(found[0].real, 0)
            self.assertGreater(found[1].real, 0)
            at, sigma = self.theory.onset(mu)
            beta = elastica.bisection(lambda beta: mode(beta).real > 0, *reversed(stiffnesses), 12)
            speed = (at / beta) ** 0.5
            frequency = speed * mode(beta).imag / sigma.imag
            print(f"  mass {mu:g}: onset U L (m/B)^(1/2) {(mu / beta) ** 0.5:.2f}, theory {(mu / at) ** 0.5:.2f} ({100 * (speed - 1):+.1f} %), frequency {100 * (frequency - 1):+.1f} %", flush=True)
            self.assertLess(abs(speed - 1), 0.12 if mu == 1 else 0.05)
            self.assertLess(abs(frequency - 1), 0.1)

    def test_onset(self):
        for resolution in ((0.025, 0.025, 0.0125), (0.0125, 0.015, 0.00625)):
            self.onset(2, (0.12, 0.05), *resolution, 6, 16)
        for resolution in ((0.025, 0.025, 0.0125), (0.0125, 0.015, 0.00625)):
            self.onset(1, (0.05, 0.025), *resolution, 6, 16)
        for delta in (0.0125, 0.02):
            self.onset(0.1, (0.00115, 0.0008), 0.0125, delta, 0.00625, 3, 9)


if __name__ == "__main__":
    harness.main()
