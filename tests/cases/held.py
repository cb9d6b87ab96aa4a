# timeout: 120
"""Requirement: a hold clamps the chosen particles of a rag, also after a resume, its reaction is in equilibrium with its
weight, a strip bends as a cantilever, and a choice that is wrong is refused with its line."""
import harness
import numpy
from harness import particles
from small_cases import SMALL_SHEETS, TWO_SHEETS
from tutorials import documented_columns

GRAVITY = 9.81  # m/s2
MASS = 0.785 * 0.002**2  # of a particle of the strip, kg
N, ROWS, SPACING, BENDING = 12, 3, 0.002, 1.64e-5  # columns, rows, m, N m2 of a row

# A strip of 12 columns and 3 rows, radius 1 mm.
STRIP = """
[case]
name = "strip"
[time]
end_s = {end}
step_ms = 1
[gravity]
acceleration_m_s2 = [0, 0, -9.81]
[[rag]]
length_mm = 24
width_mm = 6
radius_mm = 1
properties = "custom"
normal_stiffness_lengthwise_N_m3 = 1e11
tangential_stiffness_lengthwise_N_m3 = 1e11
bending_stiffness_lengthwise_N_m3 = 1.044e10
normal_stiffness_crosswise_N_m3 = 1e11
tangential_stiffness_crosswise_N_m3 = 1e11
bending_stiffness_crosswise_N_m3 = 1.044e10
{more}
[output]
report = false
"""
# A viscous fluid at rest brings the strip to rest; its buoyancy is 1e-6 of the weight.
FLUID = """
[flow]
kind = "prescribed"
density_kg_m3 = 1e-3
dynamic_viscosity_Pa_s = 0.25
velocity_m_s = [0, 0, 0]
[coupling]
mode = "one_way"
forces = ["free_stream_drag", "gravity"]
"""
HELD_EDGE = '[[hold]]\nedge = "first_column"\n'
RELEASED = HELD_EDGE + "rag = \"rag 1\"\nrelease_time_ms = 6.8\n" + '[[hold]]\nrag = "rag 2"\nrows = [2, 3]\ncolumns = [0, 4]\n'

# A sphere that a hold moves to and fro in still water, which answers with its added mass alone.
SWINGING = """
[case]
name = "swinging"
[time]
end_s = 0.1
step_s = 0.001
[flow]
kind = "prescribed"
density_kg_m3 = 1000
[coupling]
mode = "one_way"
forces = ["added_mass"]
[[particle]]
diameter_mm = 10
density_kg_m3 = 2000
[[hold]]
particles = [0]
amplitude_m = [0.01, 0, 0]
frequency_Hz = 10
[output]
report = false
"""


class Held(harness.CaseTest):
    def strip(self, more, end=0.002):
        return self.case(STRIP.format(more=more, end=end))

    def reaction(self, run, what):
        monitor = run.monitor("holds")
        return numpy.array([monitor.column(f"{what}_{axis}") for axis in "xyz"]).T

    def test_a_strip_at_rest_is_a_cantilever(self):
        run = self.run_case(self.strip(HELD_EDGE + FLUID, 0.2))
        weight = (MASS - 1e-3 * 0.77e-3 * SPACING**2) * GRAVITY  # less buoyancy: density times thickness times square of the spacing
        force, moment = self.reaction(run, "force")[-1], self.reaction(run, "moment")[-1]
        self.assertLess(abs(force[2] / (N * ROWS * weight) - 1), 1e-6)
        self.assertLess(numpy.abs(force[:2]).max(), 1e-6 * weight)
        arms = SPACING * numpy.arange(N)
        # The weights lie at the particles; w L^2/2 in the limit of many. They act downwards along +x: the hold turns the strip about -y.
        self.assertLess(abs(-moment[1] / (ROWS * weight * arms.sum()) - 1), 1e-3)
        tip = run.monitor("rags").column("z_min")[-1]
        length = arms[-1]
        deflection = (weight * arms**2 * (3 * length - arms)).sum() / (6 * BENDING)
        print(f"  tip {-tip:.4e} m, Euler-Bernoulli {deflection:.4e} m, moment over sum of w x: {-moment[1] / (ROWS * weight * arms.sum()):.6f}")
        self.assertLess(abs(-tip / deflection - 1), 0.01)

    def test_without_water_a_wholly_held_rag_weighs_on_its_hold(self):
        run = self.run_case(self.strip("velocity_m_s = [1, 2, 3]\ncopies = 2\ncopy_step_m = [0, 0.02, 0]\n[[hold]]\nrows = [0, 2]\n"))
        self.assertEqual(list(run.monitor("holds").column("rag")), [0, 1] * 2)
        self.assertEqual({f"{name} [{unit}]" for name, unit in documented_columns()["holds"].items()}, set(run.monitor("holds").columns))
        for force, moment in zip(self.reaction(run, "force"), self.reaction(run, "moment")):
            self.assertLess(numpy.abs(force - [0, 0, N * ROWS * MASS * GRAVITY]).max(), 1e-12)
            self.assertLess(numpy.abs(moment).max(), 1e-12)

    def test_resume_and_release(self):
        case = self.case(SMALL_SHEETS + RELEASED + "[checkpoint]\ninterval_s = 3.2e-3\n")
        whole = self.run_case(case, out="whole")
        held = whole.monitor("holds")
        of_first = held.column("hold") == 0
        expected = numpy.where(held.column("time")[of_first] < 7e-3, 10, 0)
        self.assertEqual(list(held.column("particles")[of_first]), list(expected))
        self.assertEqual(set(held.column("particles")[~of_first]), {10})
        (start, rag), (end, _) = (particles(sorted((whole.folder / "rags").glob("particles_*.vtp"))[k]) for k in (0, -1))
        of_second = (numpy.arange(100).reshape(10, 10)[2:4, 0:5]).ravel()
        moved = numpy.abs(end - start)[rag == 1]
        self.assertEqual(moved[of_second].max(), 0)
        self.assertGreater(numpy.delete(moved, of_second, axis=0).max(), 1e-3, "the rest of the sheet moves")
        resumed = self.crashed_and_resumed(whole, case, lambda run: sorted((run.folder / "rags").glob("*_000020.vtp")), 0.0064)
        self.assert_equal_to_the_bit(whole, resumed, lambda run: sorted((run.folder / "rags").glob("*_000020.vtp")))

    def test_a_moved_particle_carries_its_added_mass(self):
        """The impulse of each step: of the hold (m + m_a) dv, of the water - m_a dv."""
        run = self.run_case(self.case(SWINGING))
        volume, swing = numpy.pi * 0.01**3 / 6, 2 * numpy.pi * 10
        step, time = 0.001, run.monitor("holds").column("time")
        acceleration = -0.01 * swing**2 * numpy.sin(swing * (time - step / 2))
        for force, mass in ((self.reaction(run, "force")[:, 0], 2500), (run.monitor("coupling").column("force_on_rags_x"), -500)):
            share = force[1:] @ acceleration[1:] / (acceleration[1:] @ acceleration[1:]) / (mass * volume)
            print(f"  force over mass times acceleration {share:.5f}")
            self.assertLess(abs(share - 1), 2e-3)

    def test_check_says_what_is_held(self):
        run = harness.snag(["check", self.strip(HELD_EDGE)])
        self.assertEqual(run.code, 0, run.tail())
        self.assertIn("hold 0: 3 particles of rag 1 clamped, mean position (-0.011, 0, 0) m", run.stdout)

    def test_wrong_choices_are_refused_with_their_line(self):
        for more, message in (("[[hold]]\nrag = \"rag 1\"\n", "selects no particles: must have one of edge, columns, rows"),
                              ("[[hold]]\ncolumns = [3, 12]\n", "columns = [3, 12] of rag 1: must be the first and the last of whole numbers from 0 to 11"),
                              ("[[hold]]\nrows = [0.5, 1]\n", "rows = [0.5, 1] of rag 1: must be"),
                              ("[[hold]]\nedge = \"last_row\"\nrows = [1, 1]\n", "must have one kind of choice"),
                              ("[[hold]]\nrag = \"sail\"\nedge = \"last_row\"\n", "must name a piece of the case; known: rag 1"),
                              (HELD_EDGE + "[[hold]]\nedge = \"last_row\"\n", "column 0, row 2 of rag 1, which")):
            case = self.strip(more)
            line = case.read_text()[:case.read_text().rindex("[[hold]]")].count("\n") + 1
            run = harness.snag(["check", case])
            self.assertEqual(run.code, 2, run.tail())
            self.assertIn(message, run.stderr)
            self.assertIn(f".toml:{line}", run.stderr)


if __name__ == "__main__":
    harness.main()
