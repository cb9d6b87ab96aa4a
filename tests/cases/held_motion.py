# timeout: 180
# cost: 12
"""Requirement: pins, hinges and holds in a prescribed motion give the exact motion and reaction of a hanging chain, a swinging rod, and moved masses, on any
number of ranks and after a resume; particles are chosen by list or box as well as by edge."""
import harness
import numpy
from held import GRAVITY, MASS, N, ROWS, SPACING, STRIP
from small_cases import SMALL_SHEETS, TWO_SHEETS

# A chain without bending stiffness hangs from its first particle, a little aslant.
N_CHAIN, CHAIN_MASS = 50, 1380 * numpy.pi / 4 * 0.002**3  # of a particle, kg
CHAIN = """
[case]
name = "chain"
[time]
end_s = 2.5
step_ms = 5
[gravity]
acceleration_m_s2 = [0, 0, -9.81]
[[fibre]]
n_points = 50
length_mm = 100
lengthwise = [0.02, 0, -1]
properties = "custom"
normal_stiffness_lengthwise_N_m3 = 1e9
tangential_stiffness_lengthwise_N_m3 = 1e8
[[hold]]
edge = "first_column"
kind = "pin"
[output]
report = false
"""
MOVED = """[[hold]]
rag = "rag 1"
edge = "first_column"
kind = "pin"
velocity_m_s = [0.5, 0, 0]
ramp_ms = 3
[[hold]]
rag = "rag 2"
rows = [2, 3]
kind = "hinge"
hinge_axis = [1, 0, 1]
amplitude_mm = [0, 1, 0.5]
frequency_Hz = 100
axis = [0, 1, 0]
origin_mm = [-8, 10, 55]
rotation_speed_rad_s = 30
release_time_ms = 5
"""


class HeldInMotion(harness.CaseTest):
    def vectors(self, run, what, monitor="holds"):
        table = run.monitor(monitor)
        return numpy.array([table.column(what.format(axis)) for axis in "xyz"]).T

    def assert_momentum_balance(self, run, mass):
        """Reaction and weight are the rate of change of momentum, step by step."""
        v = self.vectors(run, "v{}", "rags")
        time = run.monitor("rags").column("time")
        rate = mass * numpy.diff(v, axis=0) / numpy.diff(time)[:, None]
        rest = rate - self.vectors(run, "force_{}")[1:] - mass * numpy.array([0, 0, -GRAVITY])
        print(f"  momentum: {numpy.abs(rest).max() / (mass * GRAVITY):.1e} of the weight")
        self.assertLess(numpy.abs(rest).max(), 1e-9 * mass * GRAVITY)

    def test_a_pinned_chain_swings_in_bessels_mode(self):
        """omega_n = j_n/2 sqrt(g/L), j_n: zeros of J_0 (Daniel Bernoulli 1738; Lamb, Hydrodynamics, section 189)."""
        run = self.run_case(self.case(CHAIN))
        zeros = numpy.array([2.404826, 5.520078, 8.653728, 11.791534])
        x, time = run.monitor("rags").column("x") - run.monitor("holds").column("x"), run.monitor("rags").column("time")

        def left(omega):
            phases = numpy.outer(time, omega * zeros / zeros[0])
            waves = numpy.hstack([numpy.cos(phases), numpy.sin(phases)])
            return numpy.linalg.lstsq(waves, x, rcond=None)[1][0]

        exact = zeros[0] / 2 * numpy.sqrt(GRAVITY / ((N_CHAIN - 0.5) * SPACING))
        ratios = numpy.linspace(0.9, 1.1, 2001)
        found = ratios[numpy.argmin([left(ratio * exact) for ratio in ratios])]
        print(f"  frequency over 1.2024 sqrt(g/L): {found:.4f}")
        self.assertLess(abs(found - 1), 0.005)
        self.assert_momentum_balance(run, N_CHAIN * CHAIN_MASS)
        self.assertEqual(numpy.abs(self.vectors(run, "moment_{}")).max(), 0, "a pin gives no moment")

    def test_a_hinged_rod_pulls_as_it_swings_through(self):
        """From horizontal: M g x_c = I omega^2/2; at the lowest point R = M g + M omega^2 x_c."""
        case = self.case(STRIP.format(end=0.09, more='[[hold]]\nedge = "first_column"\nkind = "hinge"\nhinge_axis = [0, 2, 0]\n').replace("step_ms = 1", "step_ms = 0.5"))
        run = self.run_case(case)
        force, moment = self.vectors(run, "force_{}"), self.vectors(run, "moment_{}")
        arms = SPACING * numpy.arange(N)
        mass, centre = N * ROWS * MASS, arms.mean()
        inertia = ROWS * MASS * (arms**2).sum() + N * ROWS * 0.4 * MASS * (SPACING / 2) ** 2
        omega = numpy.sqrt(2 * mass * GRAVITY * centre / inertia)
        exact = mass * GRAVITY + mass * omega**2 * centre
        print(f"  largest force over the exact one at the lowest point {force[:, 2].max() / exact:.5f} ({exact / mass / GRAVITY:.3f} times the weight)")
        self.assertLess(abs(force[:, 2].max() / exact - 1), 0.01)
        self.assertLess(numpy.abs(moment[:, 1]).max(), 1e-12, "no moment about the axis")
        self.assert_momentum_balance(run, mass)

    def test_a_shaken_rag_has_the_inertia_of_its_mass(self):
        amplitude, frequency, mass, dt = 1e-3, 20, N * ROWS * MASS, 1e-3
        run = self.run_case(self.case(STRIP.format(end=0.05, more=f"[[hold]]\nrows = [0, 2]\namplitude_m = [{amplitude}, 0, {2 * amplitude}]\nfrequency_Hz = {frequency}\n")))
        omega, time = 2 * numpy.pi * frequency, run.monitor("holds").column("time")
        velocity = lambda t: amplitude * omega * numpy.cos(omega * t)
        exact = mass * (velocity(time) - velocity(time - dt)) / dt
        force = self.vectors(run, "force_{}")
        scale = mass * amplitude * omega**2
        print(f"  force less inertia: {numpy.abs(force[:, 0] - exact).max() / scale:.1e} of the largest")
        self.assertLess(numpy.abs(force[:, 0] - exact).max(), 2e-3 * scale)
        self.assertLess(numpy.abs(force[:, 2] - 2 * exact - mass * GRAVITY).max(), 4e-3 * scale)
        self.assertLess(numpy.abs(force[:, 1]).max(), 1e-12)
        place = amplitude * numpy.sin(omega * time)
        self.assertLess(numpy.abs(run.monitor("rags").column("x") - place).max(), 1e-12)
        self.assertLess(numpy.abs(self.vectors(run, "{}") - numpy.array([place, 0 * place, 2 * place]).T).max(), 1e-12, "the point moves with the hold")
        self.assertLess(numpy.abs(self.vectors(run, "moment_{}")).max(), 1e-12)

    def test_a_turned_rag_is_pulled_to_the_axis(self):
        """A hold that turns at omega about an axis at the distance R gives M omega^2 R towards it, and after a ramp nothing along the motion."""
        omega, R, mass, ramp = 40, 0.05, N * ROWS * MASS, 0.01
        text = STRIP.format(end=0.06, more=f"[[hold]]\ncolumns = [0, 11]\nrotation_speed_rad_s = {omega}\norigin_m = [0, {-R}, 0]\nramp_s = {ramp}\n")
        run = self.run_case(self.case(text.replace("[0, 0, -9.81]", "[0, 0, 0]").replace("step_ms = 1", "step_ms = 0.1")))
        time, place, force = run.monitor("holds").column("time"), self.vectors(run, "{}"), self.vectors(run, "force_{}")
        angle = numpy.where(time < ramp, omega * time**2 / 2 / ramp, omega * (time - ramp / 2))
        exact = numpy.array([-R * numpy.sin(angle), R * (numpy.cos(angle) - 1), 0 * angle]).T
        self.assertLess(numpy.abs(place - exact).max(), 1e-12)
        self.assertLess(numpy.abs(self.vectors(run, "{}", "rags") - exact).max(), 1e-12)
        late = time > ramp + 1e-3
        arm = exact - [0, -R, 0]
        middle = omega * (time - 0.5e-4 - ramp / 2)
        towards = -numpy.array([-numpy.sin(middle), numpy.cos(middle)]).T
        pull = mass * omega**2 * R
        print(f"  pull less M omega^2 R: {numpy.abs(force[late, :2] - pull * towards[late]).max() / pull:.1e}")
        self.assertLess(numpy.abs(force[late, :2] - pull * towards[late]).max(), 1e-3 * pull)
        self.assertLess(numpy.abs(numpy.linalg.norm(arm, axis=1) - R).max(), 1e-12)
        # While it is spun up the hold gives the moment I d omega/dt about its point, which is the centre of the strip.
        x, y = numpy.meshgrid(SPACING * (numpy.arange(N) - 5.5), SPACING * (numpy.arange(ROWS) - 1))
        inertia = MASS * (x**2 + y**2).sum() + N * ROWS * 0.4 * MASS * (SPACING / 2) ** 2
        early = time < 0.9 * ramp
        moment = self.vectors(run, "moment_{}")[:, 2]
        self.assertLess(numpy.abs(moment[early] / (inertia * omega / ramp) - 1).max(), 1e-2)
        self.assertLess(numpy.abs(moment[late]).max(), 1e-3 * inertia * omega / ramp)

    def test_resume(self):
        case = self.case(SMALL_SHEETS + MOVED + "[checkpoint]\ninterval_s = 3.2e-3\n")
        whole = self.run_case(case, out="whole")
        last = lambda run: sorted((run.folder / "rags").glob("*_000020.vtp"))
        resumed = self.crashed_and_resumed(whole, case, last, 0.0064)
        self.assert_equal_to_the_bit(whole, resumed, last)

    def test_lists_and_boxes_choose_as_edges_do(self):
        lines = []
        for choice in ('edge = "first_column"', "particles = [0, 24, 12]", "box_lower_mm = [-12, -5, -1]\nbox_upper_mm = [-10, 5, 1]"):
            run = harness.snag(["check", self.case(STRIP.format(end=0.002, more=f'[[hold]]\n{choice}\nkind = "pin"\nvelocity_m_s = [1, 0, 0]\n'))])
            self.assertEqual(run.code, 0, run.tail())
            lines.append([line for line in run.stdout.splitlines() if "hold 0" in line])
        self.assertIn("hold 0: 3 particles of rag 1 pinned, mean position (-0.011, 0, 0) m, moves with (1, 0, 0) m/s", lines[0][0])
        self.assertEqual(lines[0], lines[1])
        self.assertEqual(lines[0], lines[2])

    def test_resolved_case_holds_the_same(self):
        """case.resolved.toml has every key: those that are not in use choose nothing."""
        for name, choice in (("rows", "rows = [0, 1]"), ("box", "box_lower_mm = [-12, -5, -1]\nbox_upper_mm = [-10, 5, 1]")):
            run = self.run_case(self.case(STRIP.format(end=0.002, more=f'[[hold]]\n{choice}\nkind = "pin"\n'), name), out=name)
            again = self.run_case(run.folder / "case.resolved.toml", out=name + "_again")
            self.assertEqual((again.folder / "monitors" / "holds.csv").read_text(), (run.folder / "monitors" / "holds.csv").read_text())
            self.assertEqual(again.summary["case_sha256"], run.summary["case_sha256"])

    def test_wrong_holds_are_refused(self):
        for more, message in (("particles = [36]", "particles: 36 is not a particle of rag 1, must be a whole number from 0 to 35"),
                              ("particles = [3]\nrows = [0, 1]", "has rows, particles: must have one kind of choice"),
                              ("box_lower_m = [0, 0, 0]", "box_lower and box_upper need each other"),
                              ("box_lower_m = [0, 0]\nbox_upper_m = [1, 1, 1]", "box_lower: has 2 numbers, must have three; give x, y and z"),
                              ("box_lower_m = [0, 0, 1]\nbox_upper_m = [1, 1, 0]", "is above box_upper (0 m) along axis 2"),
                              ("box_lower_m = [1, 1, 1]\nbox_upper_m = [2, 2, 2]", "selects no particle of rag 1"),
                              ('edge = "last_row"\nkind = "hinge"', "without hinge_axis"),
                              ('edge = "last_row"\nhinge_axis = [1, 0, 0]', 'hinge_axis needs kind = "hinge", it is "clamp"'),
                              ('edge = "last_row"\nfrequency_Hz = 3', "amplitude and frequency of an oscillation need each other"),
                              ('edge = "last_row"\nrotation_speed_rad_s = 3\naxis = [0, 0, 0]', "a hold that turns needs a direction")):
            run = harness.snag(["check", self.case(STRIP.format(end=0.002, more=f"[[hold]]\n{more}\n"))])
            self.assertEqual(run.code, 2, run.tail())
            self.assertIn(message, run.stderr)


if __name__ == "__main__":
    harness.main()
