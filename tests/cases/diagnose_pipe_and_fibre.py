# timeout: 900
# cost: 80
"""Requirement: swirl and profile of the water in a pipe, and drag of fibres by their axis, are found where they are what the data of other
programs (tests/other_programs) hold, and are not named where something else is.

The programs write the effects in other forms than Snag: a swirl that stops at the wall, the profile of a power law, other laws of a cylinder.
"""
import json
import sys
import types

import harness
import numpy

sys.path.insert(0, str(harness.SOURCE_DIR / "tests" / "other_programs"))
import card  # noqa: E402
import fibre  # noqa: E402
import pipe  # noqa: E402
import sets  # noqa: E402
import sphere  # noqa: E402


def with_effects(program, **expected):
    """The program with these effects to draw from."""
    return types.SimpleNamespace(**{**vars(program), "EXPECTED": expected})


def alone(program, duration, **numbers):
    """One run with these numbers: times and [observable, time]."""
    times, values = program.simulate(lambda name, default=None: numpy.array([float(numbers.get(name, default))]), duration)
    return times, values[0]


class ExactLimits(harness.CaseTest):
    TRACER = {"diameter": 1e-3, "density": 1000, "viscosity": 1e-5, "law": sphere.STOKES, "velocity": 1, "start_y": 0.03, "start_z": 0.02,
              "pressure_gradient": 1}

    def test_tracer_turns_with_the_swirl(self):
        times, seen = alone(pipe, 0.4, swirl=0.5, **self.TRACER)
        angle = numpy.unwrap(numpy.arctan2(seen[2], seen[1]))
        self.assertAlmostEqual((angle[300] - angle[100]) / (times[300] - times[100]) / (0.5 / pipe.RADIUS), 1, delta=1e-3)

    def test_profile_keeps_the_flow_rate_and_has_its_excess_on_the_axis(self):
        e = (numpy.arange(1000) + 0.5) / 1000
        speed = []
        for start in [0.0, *(e[50::100] * pipe.RADIUS)]:
            times, seen = alone(pipe, 0.1, flow_profile=0.3, **{**self.TRACER, "start_y": start, "start_z": 0})
            speed.append((seen[0, 90] - seen[0, 50]) / (times[90] - times[50]))
        self.assertAlmostEqual(speed[0], 1.3, delta=1e-3)
        law = 1 + 0.3 * (45 / 32 * (1 - e) ** 0.25 - 1) * 32 / 13
        self.assertAlmostEqual((law * e).mean() / e.mean(), 1, delta=1e-4)
        numpy.testing.assert_allclose(speed[1:], law[50::100], rtol=1e-3)

    def test_fibre_falls_along_and_across_as_its_laws_say(self):
        """Along it in creeping flow, across it at Re of some ten."""
        length, nu, density = 0.024, 2e-5, 1100
        D = length / fibre.N_BEADS
        weight = (density - fibre.RHO) * numpy.pi / 4 * D**2 * fibre.G
        for angle, of_speed in (
            (numpy.pi / 2, lambda U: fibre.RHO * nu * 2 * numpy.pi / (numpy.log(2 * fibre.N_BEADS) - 0.5) * U),
            (0, lambda U: 0.5 * fibre.RHO * D * U**2 * (1.18 + 6.8 * (U * D / nu) ** -0.89 + 1.96 * (U * D / nu) ** -0.5)),
        ):
            times, seen = alone(fibre, 3.2 if angle else 0.8, law=sphere.STOKES, length=length, modulus=1e5, density=density, viscosity=nu,
                                velocity=0, amplitude=0, omega=0, shear=0, angle=angle, distance=1, along=0, fibre_drag=1)
            U = -(seen[1, -1] - seen[1, -11]) / (times[-1] - times[-11])
            self.assertAlmostEqual(of_speed(U) / weight, 1, delta=0.01)


class OtherProgram(harness.CaseTest):
    def names(self, program, kind, numbers, seed):
        """Verdicts on so many sets: what is true and what is named, with whether the strength is right."""
        found = []
        for number in numbers:
            row, truth, verdict = card.run_set(program, kind, number, seed, self.work)
            print(row["truth"], round(truth["strength"], 2), "->", row["said"], row["wording"],
                  {name: (round(e["mean"], 3), round(e["sd"], 3)) for name, e in verdict["parameters"].items() if name in verdict["effects"]},
                  json.dumps({name: round(value, 3) for name, value in truth["theta"].items()}), round(row["detectability"], 1), row["seconds"], flush=True)
            found.append((row, truth, verdict))
        return found

    def test_water_of_a_pipe(self):
        swirl, profile = with_effects(pipe, swirl=0.1), with_effects(pipe, flow_profile=0.2)
        others = with_effects(pipe, added_mass=0.5, pressure_gradient=1.0, drag_magnitude=0.3, drag_exponent=0.2)
        right = self.names(swirl, "single", range(N_PIPE), SEED) + self.names(profile, "single", range(N_PIPE), SEED + 2)
        wrong = self.names(others, "single", range(N_PIPE), SEED + 1) + self.names(others, "null", range(N_PIPE), SEED + 1)
        self.assertGreaterEqual(sum(row["right"] for row, _, _ in right), 2 * N_PIPE - 1)
        for row, _, _ in wrong:
            self.assertFalse({"swirl", "flow_profile"} & set(row["said"].split("+")), row)

    def scattered(self, number, scatter):
        """Verdict on spheres that start at another place in each of ten repeats."""
        random, n = numpy.random.default_rng([SEED, number]), 10
        draw = sets.Draw(pipe, "null", random)
        draw.replicates, folder = n, self.work / f"scattered{number}"
        draw.measure()
        draw.write(folder)
        rows = ["point,replicate,t_s,observable,value"]
        for replicate in range(1, n + 1):
            starts = [{key: point.get(key, 0) + scatter * random.standard_normal() for key in ("start_x", "start_y", "start_z")} for point in draw.points]
            values = sets.Runs(pipe, [{**point, **start} for point, start in zip(draw.points, starts)])([({}, draw.deviations)])[0]
            for i, of_point in enumerate(values + pipe.NOISE * random.standard_normal(values.shape)):
                for o, observable in enumerate(pipe.OBSERVABLES):
                    rows += [f'{"ABCDEFGH"[i]},{replicate},{t:.6g},{observable["id"]},{1e3 * value:.8g}' for t, value in zip(pipe.TIMES, of_point[o])]
        (folder / "data.csv").write_text("\n".join(rows) + "\n")
        return card.diagnosed(folder)[0]

    def test_scatter_of_the_start(self):
        """It is named. Its size is not asserted: noise that is correlated in time explains a part of the scatter."""
        for number, scatter in ((0, 2e-3), (1, 5e-3)):
            verdict = self.scattered(number, scatter)
            found = verdict["parameters"].get("start_place")
            print(scatter, verdict["verdict"], verdict["effects"], found, flush=True)
            self.assertEqual(verdict["effects"], ["start_place"])

    def test_drag_of_fibres(self):
        """That it is not named where something else is: diagnose_fibres.py."""
        cylinders = with_effects(fibre, fibre_drag=0.8)
        right = self.names(cylinders, "single", range(N_FIBRE), SEED)
        self.assertGreaterEqual(sum(row["right"] for row, _, _ in right), N_FIBRE)


SEED, N_PIPE, N_FIBRE = 40, 2, 1

if __name__ == "__main__":
    harness.main()
