"""Spheres that move in water, by a program that shares nothing with Snag but the format of the data.

From rest in an unsteady shear along x, u = V + A sin(omega t) + S z, beside a wall y = 0:

    (m + C_A m_f) dv/dt = K w + (m - m_f) g + C_A m_f Du/Dt + C_P m_f (du/dt along the sphere)
                          + C_H 3/2 d^2 rho sqrt(pi nu) (int dw/dtau/sqrt(t - tau) dtau + first w_0/sqrt(t))
                          + C_L 1.615 d^2 rho sqrt(nu/S) f w x curl u + m b,    w = u - v

    K = pi/8 rho d nu (C_d Re) (1 + C_M) ((Re + 1)/100)^C_E (1 + C_W (lambda - 1)),     Re = |w| d/nu

C_d by Clift and Gauvin (1971) or by Brown and Lawler (2003), C_d = 24/Re (1 + 0.150 Re^0.681) + 0.407/(1 + 8710/Re); lambda by Faxen's
series beside the wall (Happel and Brenner, section 7-4), added mass beside it by Lamb (1932, section 99), C_A (1 + 3/16 (a/h)^3); f by Mei
(1992), of a sphere that does not spin; the slip at the start counts in the history or does not (`first`). b: accelerations that no library
holds. Runge and Kutta's fourth order in time; the history by its exact kernel over steps of constant dw/dt, the step that is being made
implicit, as an added mass (4/3 sqrt(h) times the coefficient).

The camera sees the mean of three instants over 2 ms and writes whole fiftieths of a millimetre.

All numbers are arrays, one entry a run: `simulate` makes all runs of a set at once.
"""
import numpy
import sets

RHO, G = 1000.0, 9.81
END, STEP, N_SAMPLES = 0.7, 1e-3, 20
CLIFT_GAUVIN, BROWN_LAWLER = 0, 1
SCHILLER_NAUMANN, STOKES = 2, 3  # in no set: Snag's own law serves to compare the programs, Stokes' for exact limits

NAME = "sphere"
NOISE = 2e-4
OBSERVABLES = [{"id": id, "unit": "mm", "kind": "gaussian", "factor": 1e3, "noise": NOISE, "bias": 0.0, "smallest": 0.02} for id in "xyz"]
INPUTS = {"flow.amplitude": 0.05, "particle.density_kg_m3": 0.002, "flow.kinematic_viscosity_m2_s": 0.02, "drag_law_uncertainty": 0.05}
EXPECTED = {"added_mass": 0.5, "pressure_gradient": 1.0, "history": 1.0, "lift": 1.0, "wall": 1.0, "drag_magnitude": 0.3, "drag_exponent": 0.2}
SAME_CAUSE = {}
# Numbers of a point, 0 or 1, that choose between two forms of the law of an effect, of which a diagnosis leaves open what lies between.
FORMS = {"first": "history"}
LOCAL = ["drag_magnitude", "wall", "lift", "pressure_gradient", "added_mass"]
# How far off a wrong input is, in stated standard uncertainties, and how it may be named.
WRONG_INPUTS = {
    "particle.density_kg_m3": (8, 25, ["input:particle.density_kg_m3"]),
    "flow.kinematic_viscosity_m2_s": (6, 15, ["input:flow.kinematic_viscosity_m2_s"]),
    "flow.amplitude": (4, 7, ["operating_point", "input:flow.amplitude"]),
}
# Accelerations that no library holds: strength, m/s2 (stratified: 1/s2).
OUTSIDE = {"stratified": (5, 30), "periodic": (0.3, 2), "gust": (0.5, 4), "drift": (0.02, 0.3)}
N_TRAINING, TIMES = 4, END * numpy.arange(1, N_SAMPLES + 1) / N_SAMPLES


def points(random):
    """Four operating points of training and three withheld ones, as numbers of `simulate`; with the group that each belongs to."""
    d, density, nu = random.uniform(4e-3, 8e-3), random.uniform(1080, 1900), 10 ** random.uniform(-5.6, -4.5)
    law, first, along = random.integers(2), random.integers(2), random.integers(2)
    all = []
    for i in (0, 1, 2, 3, 1, 2, 0):
        oscillates, sheared, near = i in (0, 2), i in (1, 2), i in (1, 3)
        all.append({
            "diameter": d, "density": density, "viscosity": nu, "law": law, "first": first, "along": along,
            "velocity": random.uniform(0, 0.05), "amplitude": oscillates * random.uniform(0.05, 0.2), "omega": random.uniform(6, 25),
            "shear": sheared * random.uniform(1, 4), "height": random.uniform(0.7, 1.2) * d if near else 12 * d,
        })
    return all


def groups():
    return ["first day", "first day", "second day", "second day", "first day", "second day", "second day"]


def unknown_force(random, name):
    """Numbers that describe a force of no library, the same at all points."""
    low, high = OUTSIDE[name]
    angle = random.uniform(0, 2 * numpy.pi)
    begin = random.uniform(0.2, 0.5) * END
    return {"other_" + name: low * (high / low) ** random.uniform(), "other_omega": random.uniform(12, 40), "other_phase": random.uniform(0, 6),
            "other_x": numpy.cos(angle), "other_z": numpy.sin(angle), "other_begin": begin, "other_end": begin + random.uniform(0.1, 0.25) * END}


def gate(random):
    """Where an effect acts that does not act everywhere: after a time, or below a height."""
    if random.uniform() < 0.5:
        return {"gate_time": random.uniform(0.2, 0.6) * END}
    return {"gate_depth": -random.uniform(0.01, 0.05)}


def drag_times_reynolds(law, Re):
    """C_d Re of the laws."""
    Re = numpy.maximum(Re, 1e-9)
    root, other = Re**0.687, Re**0.681
    clift = 24 * (1 + 0.15 * root) + 0.42 * Re / (1 + 42500 * Re**-1.16)
    brown = 24 * (1 + 0.150 * other) + 0.407 * Re / (1 + 8710 / Re)
    naumann = numpy.where(Re < 1000, 24 * (1 + 0.15 * root), 0.44 * Re)
    return numpy.select([law == CLIFT_GAUVIN, law == BROWN_LAWLER, law == SCHILLER_NAUMANN], [clift, brown, naumann], 24.0)


def lift_factor(Re, a):
    root = 0.3314 * numpy.sqrt(a)
    return numpy.where(Re <= 40, (1 - root) * numpy.exp(-Re / 10) + root, 0.0524 * numpy.sqrt(a * Re))


def simulate(p, duration=END):
    """Times, s, and what the camera sees then, m: [run, observable, time]. p("name", default) is an array, one entry a run."""
    d, law, flow = p("diameter"), p("law"), p("flow.amplitude", 1)
    density, nu = p("density") * p("particle.density_kg_m3", 1), p("viscosity") * p("flow.kinematic_viscosity_m2_s", 1)
    V, A, omega, S = p("velocity") * flow, p("amplitude") * flow, p("omega"), p("shear") * flow
    mass, displaced = density * numpy.pi / 6 * d**3, RHO * numpy.pi / 6 * d**3
    n_runs, h = len(d), STEP
    theta = {name: p(name, 0) for name in EXPECTED}
    factor, slope = p("drag_law_uncertainty", 1), p("drag_law_uncertainty.slope", 0)
    gate_time, gate_depth = p("gate_time", -1), p("gate_depth", 1e9)
    other = {name: p("other_" + name, 0) for name in OUTSIDE}
    other_omega, other_phase, bx, bz = p("other_omega", 1), p("other_phase", 0), p("other_x", 0), p("other_z", 0)
    begin, end = p("other_begin", 0), p("other_end", 0)
    first, along = p("first"), p("along")
    per_history = theta["history"] * 1.5 * d * d * RHO * numpy.sqrt(numpy.pi * nu)
    remembers = numpy.flatnonzero(per_history)
    own_step = per_history * 4 / 3 * numpy.sqrt(h)
    per_lift = theta["lift"] * 1.615 * RHO * d * d * numpy.sqrt(nu / numpy.where(S > 0, S, 1)) * S

    def acceleration(t, x, v, history):
        ux = V + A * numpy.sin(omega * t) + S * x[2]
        dudt = A * omega * numpy.cos(omega * t)
        w = numpy.stack([ux - v[0], -v[1], -v[2]])
        speed = numpy.sqrt((w * w).sum(0))
        Re = speed * d / nu
        on = (t >= gate_time) & (x[2] <= gate_depth)
        k = numpy.minimum(d / 2 / x[1], 0.95)
        beside = 1 / (1 - 9 / 16 * k + k**3 / 8 - 45 / 256 * k**4 - k**5 / 16)
        drag = numpy.pi / 8 * RHO * d * nu * drag_times_reynolds(law, Re) * factor * (numpy.maximum(Re, 1) / 100) ** slope
        drag = drag * (1 + on * theta["drag_magnitude"]) * ((Re + 1) / 100) ** (on * theta["drag_exponent"])
        force = drag * (1 + on * theta["wall"] * (beside - 1)) * w + history
        force[2] -= (mass - displaced) * G
        along_sphere = dudt + S * v[2]
        added = on * theta["added_mass"] * (1 + 3 / 16 * k**3) * displaced
        force[0] += added * dudt + on * theta["pressure_gradient"] * displaced * numpy.where(along == 1, along_sphere, dudt) + own_step * along_sphere
        a = numpy.minimum(0.5 * S * d / numpy.maximum(speed, 1e-12), 0.4)
        lift = on * per_lift * lift_factor(Re, a)  # w x (0, S, 0)/S
        force[0] -= lift * w[2]
        force[2] += lift * w[0]
        b = other["periodic"] * numpy.sin(other_omega * t + other_phase) + other["gust"] * ((t > begin) & (t < end))
        force[0] += mass * b * bx
        force[1] += mass * other["drift"]
        force[2] += mass * (b * bz - other["stratified"] * x[2])
        return force / (mass + added + own_step), w

    n = int(numpy.ceil(duration / h - 1e-9)) + 1  # a step more for the last exposure
    x, v = numpy.zeros((3, n_runs)), numpy.zeros((3, n_runs))
    x[1] = p("height")
    positions = numpy.empty((n + 1, 3, n_runs))
    positions[0] = x
    kernel = 4 / 3 * numpy.sqrt(h) * numpy.diff(numpy.arange(n + 2) ** 1.5)  # means over a step of 2 sqrt(t - t_j)
    kernel = numpy.diff(kernel)[::-1]  # of what changed j steps before, the last one last
    changes = numpy.zeros((n, 3 * len(remembers)))
    slip = None
    for i in range(n):
        t, history = h * i, numpy.zeros((3, n_runs))
        if len(remembers):
            now = acceleration(t, x, v, history)[1][:, remembers]
            if i == 0:
                start = now
            else:
                changes[i - 1] = (now - slip).ravel()
            slip = now
            memory = (kernel[len(kernel) - i :] @ changes[:i] / h).reshape(3, -1) if i else 0.0
            memory = memory + first[remembers] * start * 2 * (numpy.sqrt(t + h) - numpy.sqrt(t)) / h
            history[:, remembers] = per_history[remembers] * memory
        a1, v1 = acceleration(t, x, v, history)[0], v
        v2 = v + h / 2 * a1
        a2 = acceleration(t + h / 2, x + h / 2 * v1, v2, history)[0]
        v3 = v + h / 2 * a2
        a3 = acceleration(t + h / 2, x + h / 2 * v2, v3, history)[0]
        v4 = v + h * a3
        a4 = acceleration(t + h, x + h * v3, v4, history)[0]
        x = x + h / 6 * (v1 + 2 * v2 + 2 * v3 + v4)
        v = v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
        positions[i + 1] = x
    seen = positions.copy()
    seen[1:-1] = (positions[:-2] + positions[1:-1] + positions[2:]) / 3
    return h * numpy.arange(n + 1), seen.transpose(2, 1, 0)


def case_text(point):
    p = point
    return sets.head_of_case(END, RHO, p) + f"""[[particle]]
diameter_m = {p["diameter"]}
density_kg_m3 = {p["density"]}
shear_modulus_Pa = 100  # it touches nothing: so soft a sphere needs no sub-steps
position_m = [0, {p["height"]}, 0]
[[wall]]
kind = "plane"
point_m = [0, 0, 0]
normal = [0, 1, 0]
[coupling]
mode = "one_way"
forces = ["schiller_naumann"]
"""
