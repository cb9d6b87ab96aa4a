# labels: long
# timeout: 1800
# processors: 2
"""Requirement: pump.py, twice as long, on three ranks to the end; and large steps do not diverge."""
import harness
import pump


class LongPump(pump.Pump):
    n_steps, n_between_fields, n_before_checkpoint, n_steps_on_three = 60, 20, 50, 60

    def test_large_steps_with_one_corrector(self):
        """Steps of 2.88 degrees, of more than a cell of the interface, at part load: a guessed flux with divergence runs away within 110 of them."""
        run = self.run_case(self.file, 2, "--set", "time.step_s=4e-4", "--set", "time.end_s=0.056", "--set", "boundary.0.flow_rate_L_s=7.44", "--set", "flow.pressure_tolerance=1e-4",
                            "--set", "flow.pressure_tolerance_intermediate=1e-2", "--set", "flow.momentum_tolerance=1e-5", out="large")
        courant = run.monitor("residuals").column("courant_max")
        self.assertLess(courant[len(courant) // 2:].max(), 40, "after the sudden start; 18 to 28 at the tip of the vane")
        head = run.monitor("pump").column("head")[-20:]
        print(f"  head {head.min():.2f} to {head.max():.2f} m")
        self.assertTrue(4 < head.min() and head.max() < 8, "of the pump 6 m with a pulsation of 1.3 m")


del pump.Pump

if __name__ == "__main__":
    harness.main()
