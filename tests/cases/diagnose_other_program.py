# timeout: 900
# cost: 60
"""Requirement: the programs of tests/other_programs are right themselves, and sets of theirs are diagnosed as what was put into them.

The programs share nothing with Snag but the format of the data; diagnose_other_program_long.py makes their whole card.
"""
import json
import sys

import harness
import numpy

sys.path.insert(0, str(harness.SOURCE_DIR / "tests" / "other_programs"))
import card  # noqa: E402
import fibre  # noqa: E402
import rag  # noqa: E402
import sets  # noqa: E402
import sphere  # noqa: E402


def alone(program, duration, **numbers):
    """One run with these numbers: times and [observable, time]."""
    times, values = program.simulate(lambda name, default=None: numpy.array([float(numbers.get(name, default))]), duration)
    return times, values[0]


class ExactLimits(harness.CaseTest):
    """What each program gives where the answer is known."""

    SPHERE = {"diameter": 5e-3, "density": 1001, "viscosity": 1e-4, "height": 1.0, "velocity": 0, "amplitude": 0, "omega": 0, "shear": 0, "first": 0, "along": 0}

    def test_sphere_falls_as_stokes_says(self):
        times, seen = alone(sphere, 0.3, law=sphere.STOKES, **self.SPHERE)
        speed = -(seen[2, -2] - seen[2, -12]) / (times[-2] - times[-12])
        self.assertAlmostEqual(speed / ((1001 - 1000) * 9.81 * 5e-3**2 / (18 * 1e-4 * 1000)), 1, delta=1e-6)

    def test_sphere_with_added_mass_starts_more_slowly(self):
        heavy = {**self.SPHERE, "density": 1500, "viscosity": 1e-9}
        for mass in (0, 0.5):
            times, seen = alone(sphere, 0.01, law=sphere.STOKES, added_mass=mass, **heavy)
            self.assertAlmostEqual(seen[2, 5] / (-0.5 * 9.81 * 0.5 / (1.5 + mass) * times[5] ** 2), 1, delta=0.03)

    def test_fibre_turns_as_jefferys_ellipsoid(self):
        """A stiff chain without weight; a quarter of a turn is a quarter of the period 2 pi/S (r + 1/r)."""
        length, turn, S, nu = 0.024, 4, 2, 6e-5
        zeta, kappa = 3 * numpy.pi, turn * numpy.pi * (length / fibre.N_BEADS) ** 2  # over mu
        r = numpy.sqrt(1 + zeta * length**2 / (6 * kappa))
        times, seen = alone(fibre, 4.2, law=sphere.STOKES, length=length, modulus=1e5, density=1000, viscosity=nu, velocity=0, amplitude=0, omega=0,
                            shear=S, angle=0, distance=1, along=0, gravity=0, torque=turn)
        quarter = numpy.interp(-numpy.pi / 2, seen[2, ::-1], times[::-1])
        self.assertAlmostEqual(quarter / (numpy.pi / 2 / S * (r + 1 / r)), 1, delta=0.01)

    def test_rag_held_at_one_end_hangs_through_as_a_beam(self):
        """Two rows are held, the beam begins half a cell behind the first of them: q s^2 (6 L^2 - 4 L s + s^2)/(24 D)."""
        times, seen = alone(rag, 1.2, law=sphere.STOKES, viscosity=6e-6, velocity=0, amplitude=0, omega=0, shear=0, angle=0, along=0, held_rows=2)
        a, q = rag.SIDE / rag.N, (rag.MASS_PER_AREA - rag.RHO * rag.THICKNESS) * rag.G
        L, s = (rag.N - 1) * a, (numpy.arange(2, rag.N) - 0.5) * a
        through = (q * s**2 * (6 * L**2 - 4 * L * s + s**2) / (24 * rag.STIFFNESS_ALONG)).sum() / rag.N
        self.assertAlmostEqual(-seen[1, -1] / through, 1, delta=0.03)


class SameBaseCase(harness.CaseTest):
    """With Snag's own law of drag and no effect on, each program gives what Snag gives, far within the noise of the sets: a null is none."""

    def compare(self, program):
        points = [{**point, "law": sphere.SCHILLER_NAUMANN} for point in program.points(numpy.random.default_rng(3))][: program.N_TRAINING]
        own = sets.Runs(program, points)([({}, {})])[0]
        for i, point in enumerate(points):
            case = self.work / f"{program.NAME}{i}.toml"
            case.write_text(program.case_text(point))
            rags = self.run_case(case, 1, "--set", "output.report=false", out=f"{program.NAME}{i}").monitor("rags")
            for o, observable in enumerate(program.OBSERVABLES):
                if observable["kind"] == "gaussian":
                    snag = numpy.interp(program.TIMES, rags.column("time"), rags.column(observable["id"]))
                    self.assertLess(abs(own[i, o] - snag).max(), 0.5 * observable["noise"], (program.NAME, i, observable["id"]))

    def test_sphere(self):
        self.compare(sphere)

    def test_fibre(self):
        self.compare(fibre)

    def test_rag(self):
        self.compare(rag)


class OtherProgram(harness.CaseTest):
    def test_spheres(self):
        """A pair of effects and a force of no library."""
        for kind, number in (("pair", 0), ("outside", 0)):
            with self.subTest(kind):
                row, truth, verdict = card.run_set(sphere, kind, number, 1, self.work)
                print(row, verdict["parameters"], flush=True)
                self.assertTrue(row["right"], verdict["probability"])
                for effect, strength in truth["theta"].items():
                    found = verdict["parameters"][effect]
                    self.assertLess(abs(found["mean"] - strength), 4 * found["sd"], effect)


if __name__ == "__main__":
    harness.main()
