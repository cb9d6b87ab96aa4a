# labels: long
# timeout: 7200
# cost: 1500
"""Requirement: a sphere in a stream at Re 300 sheds vortices; its mean drag and their frequency are the published ones within 3 %: C_D 0.656, St 0.137 (Johnson and Patel (1999), J. Fluid Mech. 378, 19-70).
Half of the flow, with prisms on the axis in 36 sectors of the whole."""
import harness
import numpy
import sphere_flow


class SphereFlowLong(harness.CaseTest):
    def test_vortex_shedding(self):
        mesh = self.work / "half.msh"
        sphere_flow.write_sector(mesh, sphere_flow.growing_radii(72, 0.0055), 72, 18, numpy.pi)
        case = self.case(sphere_flow.CASE.format(mesh=mesh, viscosity=1 / 300))
        settings = ("--set=time.step_s=0.1", "--set=time.end_s=110", "--set=flow.initial_velocity_m_s=[1, 0, 0.2]")
        run = self.run_case(case, 2, *settings, timeout=7000)
        time = run.monitor("patches").column("time")
        drag, lift = (sphere_flow.coefficient(run, direction, numpy.pi) for direction in "xz")
        swing = lift - lift[time > 60].mean()
        rises = numpy.flatnonzero((time[:-1] > 60) & (swing[:-1] < 0) & (swing[1:] >= 0))
        crossings = time[rises] - swing[rises] * (time[rises + 1] - time[rises]) / (swing[rises + 1] - swing[rises])
        periods = (time > crossings[0]) & (time <= crossings[-1])
        C_D, strouhal = drag[periods].mean(), (len(crossings) - 1) / (crossings[-1] - crossings[0])
        print(f"  C_D {C_D:.4f}, St {strouhal:.4f}, C_L {abs(lift[periods].mean()):.4f} +- {numpy.ptp(lift[periods]) / 2:.4f}, {len(crossings) - 1} periods", flush=True)
        self.assertGreater(len(crossings), 4)
        self.assertLess(abs(C_D / 0.656 - 1), 0.03)
        self.assertLess(abs(strouhal / 0.137 - 1), 0.03)


if __name__ == "__main__":
    harness.main()
