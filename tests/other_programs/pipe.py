"""Spheres that water carries through a straight pipe, by a program that shares nothing with Snag but the format of the data.

The sphere is let go at rest, off the axis, in water that the base case takes for uniform. With U the mean speed along x, R the radius of the
pipe and e = r/R,

    u = U e_x + C_P U ((1 + e_4) (1 - e)^(1/4) - 1)/e_4 e_x + C_S U e (1 - e^8)^(1/4) e_phi,      e_4 = 13/32

    (m + C_A m_f) dv/dt = K w + (m - m_f) g + C_A m_f Du/Dt + C_G m_f Du/Dt,    w = u - v,   K as of sphere.py

so that the profile is nearer to the power law of 1/4, at the same flow rate and with C_P U more on the axis (a library of parabolas lacks
this form), and the swirl is a solid rotation that stops at the wall. Du/Dt by differences along the stream. Runge and Kutta's fourth order.

The camera sees the mean of three instants over 2 ms and writes whole fiftieths of a millimetre.
"""
import numpy
import sets
import sphere

RHO, G, RADIUS = 1000.0, 9.81, 0.1
END, STEP, N_SAMPLES = 0.4, 1e-3, 16
AXIS_EXCESS = 13 / 32  # of the power law of 1/4: 45/32 of the mean speed on the axis

NAME = "pipe"
NOISE = 2e-4
OBSERVABLES = [{"id": id, "unit": "mm", "kind": "gaussian", "factor": 1e3, "noise": NOISE, "bias": 0.0, "smallest": 0.02} for id in "xyz"]
INPUTS = {"flow.amplitude": 0.02, "particle.density_kg_m3": 0.002, "flow.kinematic_viscosity_m2_s": 0.02, "drag_law_uncertainty": 0.05}
EXPECTED = {"swirl": 0.1, "flow_profile": 0.2, "added_mass": 0.5, "pressure_gradient": 1.0, "drag_magnitude": 0.3, "drag_exponent": 0.2}
SAME_CAUSE, FORMS = {}, {}
N_TRAINING, TIMES = 4, END * numpy.arange(1, N_SAMPLES + 1) / N_SAMPLES


def points(random):
    """Four operating points of training and three withheld ones, as numbers of `simulate`."""
    d, density, nu, law = random.uniform(3e-3, 8e-3), random.uniform(1050, 1500), 10 ** random.uniform(-6, -5), random.integers(2)
    all = []
    for i in range(N_TRAINING + 3):
        angle, r = random.uniform(0, 2 * numpy.pi), random.uniform(0.02, 0.06)
        all.append({"diameter": d, "density": density, "viscosity": nu, "law": law, "velocity": random.uniform(0.6, 1.5),
                    "start_y": r * numpy.cos(angle), "start_z": r * numpy.sin(angle)})
    return all


def groups():
    return ["first day", "first day", "second day", "second day", "first day", "second day", "second day"]


def simulate(p, duration=END):
    """Times, s, and what the camera sees then, m: [run, observable, time]. p("name", default) is an array, one entry a run."""
    d, law, U = p("diameter"), p("law"), p("velocity") * p("flow.amplitude", 1)
    density, nu = p("density") * p("particle.density_kg_m3", 1), p("viscosity") * p("flow.kinematic_viscosity_m2_s", 1)
    mass, displaced, h = density * numpy.pi / 6 * d**3, RHO * numpy.pi / 6 * d**3, STEP
    theta = {name: p(name, 0) for name in EXPECTED}
    factor, slope = p("drag_law_uncertainty", 1), p("drag_law_uncertainty.slope", 0)

    def water(x):
        e = numpy.minimum(numpy.hypot(x[1], x[2]) / RADIUS, 1)
        along = U * (1 + theta["flow_profile"] * ((1 + AXIS_EXCESS) * (1 - e) ** 0.25 - 1) / AXIS_EXCESS)
        about = theta["swirl"] * U / RADIUS * (1 - e**8) ** 0.25
        return numpy.stack([along, -about * x[2], about * x[1]])

    def acceleration(x, v):
        u = water(x)
        rate = (water(x + 1e-5 * u) - water(x - 1e-5 * u)) / 2e-5
        w = u - v
        Re = numpy.sqrt((w * w).sum(0)) * d / nu
        drag = numpy.pi / 8 * RHO * d * nu * sphere.drag_times_reynolds(law, Re) * factor * (numpy.maximum(Re, 1) / 100) ** slope
        drag = drag * (1 + theta["drag_magnitude"]) * ((Re + 1) / 100) ** theta["drag_exponent"]
        force = drag * w + (theta["added_mass"] + theta["pressure_gradient"]) * displaced * rate
        force[2] -= (mass - displaced) * G
        return force / (mass + theta["added_mass"] * displaced)

    n = int(numpy.ceil(duration / h - 1e-9)) + 1
    x = numpy.stack([p("start_x", 0), p("start_y"), p("start_z")])
    v = numpy.zeros_like(x)
    positions = [x]
    for _ in range(n):
        a1 = acceleration(x, v)
        v2 = v + h / 2 * a1
        a2 = acceleration(x + h / 2 * v, v2)
        v3 = v + h / 2 * a2
        a3 = acceleration(x + h / 2 * v2, v3)
        v4 = v + h * a3
        a4 = acceleration(x + h * v3, v4)
        x, v = x + h / 6 * (v + 2 * v2 + 2 * v3 + v4), v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
        positions.append(x)
    positions = numpy.array(positions)
    seen = positions.copy()
    seen[1:-1] = (positions[:-2] + positions[1:-1] + positions[2:]) / 3
    return h * numpy.arange(n + 1), seen.transpose(2, 1, 0)


def case_text(point):
    p = point
    return sets.head_of_case(END, RHO, {**p, "shear": 0, "amplitude": 0, "omega": 0}) + f"""[pipe_flow]
radius_m = {RADIUS}
[[particle]]
diameter_m = {p["diameter"]}
density_kg_m3 = {p["density"]}
shear_modulus_Pa = 100
position_m = [0, {p["start_y"]}, {p["start_z"]}]
[coupling]
mode = "one_way"
forces = ["schiller_naumann"]
"""
