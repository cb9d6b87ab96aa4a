# labels: long
# timeout: 600
"""Requirement: pump_pressure.py with a static pressure at the inlet; where the level of the pressure lies makes no difference to what the impeller does."""
import harness
import numpy
import pump_pressure


class PumpBetweenStaticPressures(pump_pressure.PumpBetweenPressures):
    def test_total_pressure(self):
        total, static = self.between_total_pressure(), self.run_with_inlet("pressure_Pa = 0\ntotal = false", "static")
        self.comes_to_its_flow(static)
        numpy.testing.assert_array_equal(static.monitor("patches").column("inlet_pressure"), 0)
        for column, tolerance in (("head", 0.02), ("torque", 0.01)):
            of_total, of_static = (run.monitor("pump").column(column)[-10:].mean() for run in (total, static))
            self.assertLess(abs(of_total - of_static), tolerance * abs(of_static), column)


del pump_pressure.PumpBetweenPressures

if __name__ == "__main__":
    harness.main()
