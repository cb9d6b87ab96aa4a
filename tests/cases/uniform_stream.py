# timeout: 120
"""Requirement: a uniform stream through tetrahedra stays uniform, with a limiter and without one, at steps of any length. With the
least-squares gradient over their four faces alone, the linear reconstruction grew from round-off to a tenth of the stream within a second."""
import harness
import numpy

CASE = """
[case]
name = "uniform-stream"
[mesh]
geometry = "box"
set = ["lower_m=[0,0,0]", "upper_m=[0.4,0.2,0.1]", "size_m=0.02", "cells=\\"tetrahedra\\""]
[time]
end_s = {end}
step_s = {step}
[flow]
initial_velocity_m_s = [0.3, 0, 0]
n_outer_correctors = 2
limiter = "{limiter}"
[[boundary]]
patch = "x0"
kind = "velocity_inlet"
velocity_m_s = [0.3, 0, 0]
[[boundary]]
patch = "x1"
kind = "pressure_outlet"
[[boundary]]
patches = ["y0", "y1", "z0", "z1"]
kind = "symmetry"
[output]
fields_interval_s = {end}
single_precision = false
report = false
"""


class UniformStream(harness.CaseTest):
    def largest_change(self, ranks, **values):
        run = self.run_case(self.case(CASE.format(**values)), ranks, out="-".join(str(v) for v in values.values()))
        fields = harness.arrays(harness.read_vtk(max((run.folder / "fields").glob("*.pvtu"))).GetCellData())
        return numpy.abs(fields["velocity [m/s]"] - [0.3, 0, 0]).max()

    def test_stays_uniform(self):
        for limiter, step, end, ranks in (("venkatakrishnan", 0.005, 1, 2), ("none", 0.005, 1, 1), ("venkatakrishnan", 0.05, 2, 1)):
            change = self.largest_change(ranks, limiter=limiter, step=step, end=end)
            print(f"  limiter {limiter}, steps of {step} s, {end} s: largest change {change:.1e} m/s")
            self.assertLess(change, 1e-10)


if __name__ == "__main__":
    harness.main()
