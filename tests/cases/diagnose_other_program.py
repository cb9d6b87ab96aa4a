# timeout: 900
# cost: 20
"""Requirement: the programs of tests/other_programs are right themselves, and their sets hold what their sealed truth says.

The programs share nothing with Snag but the format of the data. diagnose_spheres.py and diagnose_fibres.py hold some of their sets against the
targets, diagnose_other_program_long.py makes the whole card.
"""
import hashlib
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
            at = lambda name: numpy.interp(program.TIMES, rags.column("time"), rags.column(name))  # noqa: E731
            for o, observable in enumerate(program.OBSERVABLES):
                seen, snag = own[i, o], at(observable["id"]) if observable["kind"] != "angle" else None
                if snag is None:  # of what is straight, from its extent; of a square sheet seen at a slant, long axis of its picture
                    seen, snag = abs(numpy.arcsin(numpy.sin(own[i, o]))), numpy.arctan2(at("z_max") - at("z_min"), at("x_max") - at("x_min"))
                    if program is rag:
                        c, s, (_, y, z) = numpy.cos(snag), numpy.sin(snag), rag.UP
                        snag = 0.5 * numpy.arctan2(2 * z * c * s, c**2 - y**2 - (z * s) ** 2)
                self.assertLess(abs(seen - snag).max(), 0.5 * observable["noise"], (program.NAME, i, observable["id"]))

    def test_sphere(self):
        self.compare(sphere)

    def test_fibre(self):
        self.compare(fibre)

    def test_rag(self):
        self.compare(rag)


class Scoring(harness.CaseTest):
    """The card reads verdicts and counts as it says."""

    def test_interval_of_a_share(self):
        """Clopper and Pearson: of none of n the upper bound is 1 - 0.025^(1/n); what is hit and what is missed are mirrored."""
        low, high = card.clopper_pearson(0, 40)
        self.assertEqual(low, 0)
        self.assertAlmostEqual(high, 1 - 0.025 ** (1 / 40), places=9)
        for hits in (3, 17, 40):
            of_hits, of_misses = card.clopper_pearson(hits, 40), card.clopper_pearson(40 - hits, 40)
            numpy.testing.assert_allclose(of_hits, (1 - of_misses[1], 1 - of_misses[0]), atol=1e-9)

    def test_signal_over_noise(self):
        """A free direction of any strength takes its part of the signal; an uncertain one takes it as far as its uncertainty allows."""
        signal, variance = numpy.array([3.0, 4.0]), numpy.ones(2)
        first = numpy.array([1.0, 0.0])
        self.assertAlmostEqual(sets.signal_over_noise(signal, variance, [1e6 * first]), 4, places=6)
        self.assertAlmostEqual(sets.signal_over_noise(signal, variance, [3 * first]), numpy.sqrt(9 / (1 + 9) + 16), places=9)

    def verdict(self, kind, effects=(), tie=(), probability={"none": 1.0}, wording="attributed"):
        return {"verdict": kind, "effects": list(effects), "tie": list(tie), "probability": probability, "wording": wording, "runs": 1}

    def score(self, right, verdict, kind="single"):
        truth = {"program": "rag", "number": 0, "seed": 1, "kind": kind, "truth": right[0], "subset": "", "strength": 1, "replicates": 3, "detectability": 9,
                 "clear_of_library": None, "clear_of_forms": None, "gap_over_floor": 1, "right": right, "same_cause": rag.SAME_CAUSE}
        return card.scored(truth, verdict, 1.0, "")

    def test_two_names_of_one_cause_are_one(self):
        both = {"added_mass": 0.3, "entrained_water": 0.6, "none": 0.1}
        for verdict in (self.verdict("effects", ["entrained_water"], probability=both), self.verdict("tie", tie=["added_mass", "entrained_water"], probability=both)):
            row = self.score(["added_mass"], verdict)
            self.assertEqual((row["said"], row["right"], row["first_right"]), ("added_mass", 1, 1))
            self.assertAlmostEqual(row["p_truth"], 0.9)
        for verdict in (self.verdict("tie", tie=["added_mass", "lift"]), self.verdict("effects", ["lift"])):
            self.assertEqual(self.score(["added_mass"], verdict)["right"], 0)

    def test_blame(self):
        self.assertEqual(self.score(["clock"], self.verdict("effects", ["clock"]), "blunder")["blames_physics"], 0)
        self.assertEqual(self.score(["clock"], self.verdict("effects", ["frame_rate"]), "blunder")["blames_physics"], 0)
        self.assertEqual(self.score(["clock"], self.verdict("effects", ["clock", "lift"]), "blunder")["blames_physics"], 1)

    def test_local_cause_called_outside_is_not_right_but_names_nothing_wrong(self):
        row = self.score(["lift"], self.verdict("outside"), "local")
        self.assertEqual((row["right"], row["true_enough"]), (0, 1))
        self.assertEqual(self.score(["lift"], self.verdict("outside"))["true_enough"], 0)

    def test_calibration_error(self):
        rows = [{"p_first": 0.8, "first_right": k < 6} for k in range(10)] + [{"p_first": 0.95, "first_right": 1}] * 10
        self.assertAlmostEqual(card.calibration_error(rows), (0.2 * 10 + 0.05 * 10) / 20)


class WrittenData(harness.CaseTest):
    """A set holds what its sealed truth says of it."""

    def made(self, kind):
        """Truth, and the samples in stated standard uncertainties: [point, repeat, observable, time]."""
        name, fingerprint = sets.make_set(sphere, kind, 0, 1, self.work)
        self.assertIn(f"{name} sha256 {fingerprint}", (self.work / "sealed.log").read_text())
        text = (self.work / "sealed" / f"{name}.json").read_text()
        self.assertEqual(hashlib.sha256(text.encode()).hexdigest(), fingerprint)
        truth, folder = json.loads(text), self.work / "sets" / name
        self.assertNotIn(kind, "".join(file.read_text() for file in folder.iterdir()))
        rows = [line.split(",") for line in (folder / "data.csv").read_text().splitlines()[1:]]
        shape = (len(sphere.groups()), truth["replicates"], len(sphere.OBSERVABLES), len(sphere.TIMES))
        return truth, numpy.array([float(row[4]) for row in rows]).reshape(shape) / (1e3 * sphere.NOISE)

    def noise(self, kind):
        truth, values = self.made(kind)
        return truth, (values - values.mean(1, keepdims=True)) * numpy.sqrt(truth["replicates"] / (truth["replicates"] - 1))

    def test_noise_is_larger_than_stated(self):
        truth, noise = self.noise("null_noise")
        self.assertGreaterEqual(truth["noise_factor"], 2)
        self.assertAlmostEqual(noise.std() / truth["noise_factor"], 1, delta=0.05)

    def test_noise_is_correlated(self):
        truth, noise = self.noise("null_correlated")
        self.assertAlmostEqual((noise[..., 1:] * noise[..., :-1]).mean(), truth["correlation"], delta=0.1)

    def test_outliers_are_as_many_as_said(self):
        truth, values = self.made("outliers")
        self.assertGreaterEqual(truth["replicates"], 3)
        out = abs(values - numpy.median(values, axis=1, keepdims=True)) > 12
        self.assertAlmostEqual(out.mean(), truth["outlier_share"], delta=0.008)


if __name__ == "__main__":
    harness.main()
