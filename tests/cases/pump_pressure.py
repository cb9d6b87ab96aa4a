# timeout: 600
# cost: 24
"""Requirement: a pump between a given pressure at its inlet, total (static: pump_pressure_long.py), and a target of the flow at its outlet, comes to that flow."""
import numpy

import harness

TARGET = 0.0268  # m3/s
DENSITY, RAMP, END = 998.2, 0.01, 0.02
INLET_AREA = numpy.pi / 4 * 0.1**2


class PumpBetweenPressures(harness.CaseTest):
    def run_with_inlet(self, keys, name):
        """cases/pump-curve with its inlet and outlet changed, from rest to some time after the impeller is at full speed."""
        folder = harness.SOURCE_DIR / "cases"
        text = (folder / "pump-curve" / "case.toml").read_text()
        for old, new in (
            ("../meshes", str(folder / "meshes")),
            ('kind = "flow_rate_inlet"\nflow_rate_L_s = 26.8\nramp_ms = 20', f'kind = "pressure_inlet"\n{keys}'),
            ('kind = "pressure_outlet"', 'kind = "pressure_outlet"\ntarget_flow_rate_L_s = 26.8'),
        ):
            self.assertIn(old, text)
            text = text.replace(old, new)
        times = ("--set", f"rotating_zone.ramp_s={RAMP}", "--set", f"time.end_s={END}", "--set", "time.step_ms=0.2", "--set", "flow.n_outer_correctors=2")
        return self.run_case(self.case(text, name), 1, *times, "--set", "output.report=false", out=name)

    def comes_to_its_flow(self, run):
        pump = run.monitor("pump")
        flow = pump.column("flow_in")
        print(f"  flow at the end {1000 * flow[-1]:.3f} L/s, largest {1000 * flow.max():.3f} L/s, head {pump.column('head')[-1]:.3f} m")
        numpy.testing.assert_allclose(pump.column("flow_out"), flow, rtol=1e-6)
        self.assertLess(flow[0], 0.1 * TARGET, "it starts from rest")
        numpy.testing.assert_allclose(flow[-10:], TARGET, rtol=0.01)
        self.assertLess(flow.max(), 1.03 * TARGET, "it does not shoot over the target")

    def test_total_pressure(self):
        self.between_total_pressure()

    def between_total_pressure(self):
        total = self.run_with_inlet("pressure_Pa = 5000", "total")
        self.comes_to_its_flow(total)
        # The dynamic head of the mean speed is least: an uneven profile has more, and so has the mesh, whose inlet is a polygon in the circle.
        pressure, flow = total.monitor("patches").column("inlet_pressure")[-1], total.monitor("pump").column("flow_in")[-1]
        head = 0.5 * DENSITY * (flow / INLET_AREA) ** 2
        print(f"  dynamic head at the inlet {5000 - pressure:.0f} Pa, of the mean speed {head:.0f} Pa")
        self.assertGreater(5000 - pressure, head)
        self.assertLess(5000 - pressure, 1.2 * head)
        return total


if __name__ == "__main__":
    harness.main()
