"""Small rags that move in water, by a program that shares nothing with Snag but the format of the data.

The sheet is a grid of N x N nodes, each in the middle of a square of its own of the side a. Membrane: springs along edges and diagonals, whose
rest length is kept by projection. Energy of bending: the sum of (second difference)^2 along and across, times the stiffness per width, D_l and D_w.
This is the quadratic energy of a sheet that does not stretch (Bergou et al. 2006). Both have one constant matrix, so that the step is implicit in them and
solved by alternating projections (Bouaziz et al. 2014) with the matrix inverted once. Time: the second backward difference formula, the load of
the water extrapolated from two steps before,

    x = (4 x_1 - x_2)/3 + 2/3 h v,   v = (4 v_1 - v_2)/3 + 2/3 h (F_elastic(x) + 2 F_1 - F_2)/m

Load per area of the cloth, d the diameter of the spheres that the base case takes for it, t its thickness, w = u - v,
u = (V + A_0 sin(omega t) + S z) e_x:

    F = (1 - C_S) (pi/8 rho nu (C_d Re) w f)/d + C_S (1/2 rho 1.17 |w_n| w_n + rho 1.328 (|w_t| L/nu)^(-1/2) |w_t| w_t) + (sigma - rho t) g
        + (C_A c + C_W) rho t (Du/Dt - dv/dt) + C_P rho t (du/dt along the cloth) + C_H 3/2 rho sqrt(pi nu) int dw/dtau/sqrt(t - tau) dtau + sigma b

C_d by Clift and Gauvin (1971) or by Brown and Lawler (2003); c: 1.2 inside, less along the edges, 1 on average; n from differences of the nodes
beside, w_n along it, w_t along the sheet (friction of both sides, Blasius 1908). f: size, exponent, shelter 1 - C_sh s, s the share of four
neighbours that are there, and folding (1 + (|w|/w_0)^4)^(V/4), w_0 = 0.5 m/s. b: accelerations that no library holds.

A strip that is held at one end by heavy nodes hangs through by q L^4/(8 D). The camera looks from above at a slant (along the cloth a sheet without
thickness has no picture): its up is UP. Centre in whole tenths of a millimetre, long axis of the picture's second moments in whole 0.005 rad.
"""
import numpy
import sets
import sphere

RHO, G = 1000.0, 9.81
END, STEP, N, SIDE = 0.2, 1e-3, 8, 0.056
PASSES = 5  # projections a step
DIAMETER, THICKNESS, MASS_PER_AREA = 4e-3, 0.77e-3, 0.785  # spheres of the base case; thickness and mass of its cloth
# Bending stiffness per width, N m: S_nb pi r^4/4 with S_nb = 3.15e6 and 4.05e5 N/m3 of the cloth at r = 2 mm (Jensen 2018, Tables 3.3 and 3.4).
STIFFNESS_ALONG, STIFFNESS_ACROSS = (s * numpy.pi / 4 * (DIAMETER / 2) ** 4 for s in (3.15e6, 4.05e5))

UP = (0.0, 0.6, 0.8)
NAME = "rag"
OBSERVABLES = [
    {"id": "x", "unit": "mm", "kind": "gaussian", "factor": 1e3, "noise": 4e-4, "bias": 2e-4, "smallest": 0.1},
    {"id": "z", "unit": "mm", "kind": "gaussian", "factor": 1e3, "noise": 4e-4, "bias": 2e-4, "smallest": 0.1},
    {"id": "orientation", "unit": "rad", "kind": "angle", "factor": 1.0, "noise": 0.03, "bias": 0.0, "smallest": 0.005},
]
INPUTS = {"flow.amplitude": 0.05, "rag.mass_per_area_kg_m2": 0.02, "flow.kinematic_viscosity_m2_s": 0.02, "drag_law_uncertainty": 0.05}
EXPECTED = {"added_mass": 0.5, "pressure_gradient": 1.0, "history": 1.0, "drag_magnitude": 0.3, "drag_exponent": 0.2, "shielding": 0.5,
            "reconfiguration": -0.67, "sheet_drag": 0.8, "entrained_water": 1.0}
SAME_CAUSE = {"entrained_water": "added_mass"}
FORMS = {}
LOCAL = ["drag_magnitude", "pressure_gradient", "entrained_water", "shielding"]
WRONG_INPUTS = {
    "rag.mass_per_area_kg_m2": (5, 15, ["input:rag.mass_per_area_kg_m2"]),
    "flow.amplitude": (4, 7, ["operating_point", "input:flow.amplitude"]),
}
# Strengths: m/s2; stratified 1/s2; pitching: m/s2 at the ends, up and down.
OUTSIDE = {"stratified": (20, 80), "periodic": (1, 5), "gust": (1, 6), "pitching": (2, 10)}
N_TRAINING, TIMES = 3, END * numpy.arange(1, 9) / 8


def points(random):
    """Three operating points of training and three withheld ones, as numbers of `simulate`."""
    nu, law, along = 10 ** random.uniform(-6, -5), random.integers(2), random.integers(2)
    all = []
    for i in (1, 2, 3, 3, 1, 2):
        speed = 0.3 * random.uniform(0.7, 1.5)
        all.append({
            "viscosity": nu, "law": law, "along": along, "velocity": random.uniform(0.1, 0.5) * speed,
            "amplitude": (i in (1, 3)) * random.uniform(0.5, 1.5) * speed, "omega": random.uniform(8, 25),
            "shear": (i in (2, 3)) * random.uniform(10, 30) * speed, "angle": random.uniform(-0.6, 0.6),
        })
    return all


def groups():
    return ["first day", "second day", "second day", "second day", "first day", "first day"]


def unknown_force(random, name):
    low, high = OUTSIDE[name]
    angle, begin = random.uniform(0, 2 * numpy.pi), random.uniform(0.2, 0.5) * END
    return {"other_" + name: low * (high / low) ** random.uniform(), "other_omega": random.uniform(15, 40), "other_phase": random.uniform(0, 6),
            "other_x": numpy.cos(angle), "other_z": numpy.sin(angle), "other_begin": begin, "other_end": begin + random.uniform(0.1, 0.25) * END}


def gate(random):
    """Where an effect acts that does not act everywhere: after a time, or beyond a place."""
    if random.uniform() < 0.5:
        return {"gate_time": random.uniform(0.2, 0.5) * END}
    return {"gate_place": random.uniform(0.0, 0.02)}


def node(i, j):
    return i * N + j


EDGES = [(node(i, j), node(i + di, j + dj)) for i in range(N) for j in range(N) for di, dj in ((1, 0), (0, 1), (1, 1), (1, -1))
         if i + di < N and 0 <= j + dj < N]


def second_differences(along):
    rows = []
    for i in range(N):
        for j in range(1, N - 1):
            row = numpy.zeros(N * N)
            for k, value in ((j - 1, 1), (j, -2), (j + 1, 1)):
                row[node(k, i) if along else node(i, k)] = value
            rows.append(row)
    return numpy.array(rows)


def simulate(p, duration=END):
    """Times, s, and what the camera sees then: [run, observable, time]. p("name", default) is an array, one entry a run."""
    law, flow, h, a = p("law"), p("flow.amplitude", 1), STEP, SIDE / N
    sigma, nu = MASS_PER_AREA * p("rag.mass_per_area_kg_m2", 1), p("viscosity") * p("flow.kinematic_viscosity_m2_s", 1)
    V, A, omega, S = p("velocity") * flow, p("amplitude") * flow, p("omega"), p("shear") * flow
    n_runs, nodes = len(law), N * N
    theta = {name: p(name, 0) for name in EXPECTED}
    factor, slope, along = p("drag_law_uncertainty", 1), p("drag_law_uncertainty.slope", 0), p("along")
    gate_time, gate_place = p("gate_time", -1), p("gate_place", -1e9)
    other = {name: p("other_" + name, 0) for name in OUTSIDE}
    other_omega, other_phase, bx, bz = p("other_omega", 1), p("other_phase", 0), p("other_x", 0), p("other_z", 0)
    begin, end, gravity, held = p("other_begin", 0), p("other_end", 0), p("gravity", G), p("held_rows", 0)
    col = lambda one: one[:, None]  # noqa: E731
    on_edge = numpy.zeros((N, N))
    on_edge[[0, -1]] += 1
    on_edge[:, [0, -1]] += 1
    neighbours = 1 - 0.25 * on_edge.ravel()  # share of four that are there
    of_place = 1.2 - 0.2 * (on_edge.ravel() > 0) * nodes / (on_edge > 0).sum()  # c
    # Elastic matrix, one for all runs; mass of a node with the water that it carries, one a run.
    stretch = numpy.zeros((len(EDGES), nodes))
    for e, (i, j) in enumerate(EDGES):
        stretch[e, i], stretch[e, j] = 1, -1
    grid = numpy.array([(i, j) for i in range(N) for j in range(N)]) * a
    rest = numpy.linalg.norm(stretch @ grid, axis=1)
    stiffness = 300.0 * numpy.where(rest > 1.2 * a, 0.3, 1.0)  # N/m: far stiffer than the load, no more than converges
    bend = sum(D * second_differences(way).T @ second_differences(way) / a**2 for D, way in ((STIFFNESS_ALONG, True), (STIFFNESS_ACROSS, False)))
    elastic = stretch.T @ (stiffness[:, None] * stretch) + bend
    displaced = RHO * THICKNESS
    per_history = theta["history"] * 1.5 * RHO * numpy.sqrt(numpy.pi * nu)
    own_step = per_history * 4 / 3 * numpy.sqrt(h)
    remembers = numpy.flatnonzero(per_history)
    carried_everywhere = (col(theta["added_mass"]) * of_place + col(theta["entrained_water"])) * displaced
    gated = (gate_time >= 0) | (gate_place > -1e8)  # then the water that is carried is a load, not a part of the matrix
    carried = numpy.where(col(gated), 0.0, carried_everywhere)
    mass = (col(sigma + own_step) + carried) * a**2
    mass = numpy.where(numpy.arange(nodes) < col(held) * N, 1e6, mass)
    beta = 2 / 3 * h
    inverse = numpy.linalg.inv(elastic[None] + mass[:, :, None] * numpy.eye(nodes) / beta**2)
    project = numpy.ascontiguousarray(stretch.T * stiffness)
    weight = numpy.where(mass > 1e5, 0, col((sigma - displaced) * gravity) * a**2)

    def load(t, x, v, history, dvdt):
        """Force on each node, N: [run, node, axis]."""
        ux, dudt = col(V + A * numpy.sin(omega * t)) + col(S) * x[:, :, 2], col(A * omega * numpy.cos(omega * t))
        w = -v
        w[:, :, 0] += ux
        square = (w * w).sum(2)
        speed = numpy.sqrt(square)
        Re = speed * DIAMETER / col(nu)
        on = (t >= col(gate_time)) & (x[:, :, 0] >= col(gate_place))
        drag = numpy.pi / 8 * RHO * col(nu) / DIAMETER * sphere.drag_times_reynolds(col(law), Re) * col(factor)
        drag = drag * (numpy.maximum(Re, 1) / 100) ** col(slope)
        drag = drag * (1 + on * col(theta["drag_magnitude"])) * ((Re + 1) / 100) ** (on * col(theta["drag_exponent"]))
        drag = drag * (1 - on * col(theta["shielding"]) * neighbours) * (1 + (speed / 0.5) ** 4) ** (on * col(theta["reconfiguration"]) / 4)
        sheet = on * col(theta["sheet_drag"])
        F = ((1 - sheet) * drag)[:, :, None] * w
        if theta["sheet_drag"].any():
            square_grid = x.reshape(n_runs, N, N, 3)
            normal = numpy.cross(numpy.gradient(square_grid, axis=1), numpy.gradient(square_grid, axis=2)).reshape(n_runs, nodes, 3)
            normal /= numpy.linalg.norm(normal, axis=2, keepdims=True)
            through = (w * normal).sum(2)
            w_t = w - through[:, :, None] * normal
            along_sheet = numpy.linalg.norm(w_t, axis=2)
            friction = RHO * 1.328 * numpy.sqrt(col(nu) / SIDE * along_sheet)
            F += (sheet * 0.5 * RHO * 1.17 * abs(through) * through)[:, :, None] * normal + (sheet * friction)[:, :, None] * w_t
        along_cloth = dudt + col(S) * v[:, :, 2]
        F[:, :, 0] += on * col(theta["pressure_gradient"]) * displaced * numpy.where(col(along) == 1, along_cloth, dudt)
        F[:, :, 0] += col(own_step) * along_cloth + carried * dudt
        if gated.any():
            taken = numpy.where(col(gated), on * carried_everywhere, 0.0)
            F -= taken[:, :, None] * dvdt
            F[:, :, 0] += taken * dudt
        F += history
        b = col(other["periodic"] * numpy.sin(other_omega * t + other_phase) + other["gust"] * ((t > begin) & (t < end)))
        F[:, :, 0] += col(sigma) * b * col(bx)
        arm = (x[:, :, 0] - col(x[:, :, 0].mean(1))) / (SIDE / 2)
        F[:, :, 2] += col(sigma) * (b * col(bz) - col(other["stratified"]) * x[:, :, 2] + col(other["pitching"] * numpy.sin(other_omega * t + other_phase)) * arm)
        F *= a**2
        F[:, :, 2] -= weight
        return F

    angle, middle = p("angle"), (N - 1) / 2 * a
    x = numpy.zeros((n_runs, nodes, 3))
    x[:, :, 0], x[:, :, 2] = (col(f) * (grid[:, 0] - middle) for f in (numpy.cos(angle), numpy.sin(angle)))
    x[:, :, 1] = grid[:, 1] - middle
    n = int(numpy.ceil(duration / h - 1e-9))
    nothing = numpy.zeros_like(x)
    v, force, dvdt = nothing.copy(), load(0.0, x, nothing, nothing, nothing), nothing
    x_before, v_before, force_before = x + h * h / 2 * force / mass[:, :, None], -h * force / mass[:, :, None], force
    kernel = numpy.diff(4 / 3 * numpy.sqrt(h) * numpy.diff(numpy.arange(n + 2) ** 1.5))[::-1]
    changes, slip = numpy.zeros((n, len(remembers) * nodes * 3)), None
    places = [x]
    per_mass = 1 / mass[:, :, None]
    for i in range(n):
        history = nothing
        if len(remembers):
            now = -v[remembers]
            now[:, :, 0] += col(V + A * numpy.sin(omega * h * i))[remembers] + col(S)[remembers] * x[remembers][:, :, 2]
            if i > 0:
                changes[i - 1] = (now - slip).ravel()
                history = nothing.copy()
                history[remembers] = per_history[remembers][:, None, None] * (kernel[len(kernel) - i :] @ changes[:i] / h).reshape(now.shape)
            slip = now
        force = load(h * i, x, v, history, dvdt)
        ahead = 2 * force - force_before if i else force
        force_before = force
        v_known = (4 * v - v_before) / 3 + beta * ahead * per_mass
        free = (4 * x - x_before) / 3 + beta * v_known
        pulled = free * mass[:, :, None] / beta**2
        new = x + h * v
        for _ in range(PASSES):
            edges = stretch @ new
            edges *= (rest / numpy.sqrt((edges * edges).sum(2)))[:, :, None]
            new = inverse @ (pulled + project @ edges)
        v_new = (new - (4 * x - x_before) / 3) / beta
        dvdt = (v_new - (4 * v - v_before) / 3) / beta
        x_before, v_before, x, v = x, v, new, v_new
        places.append(x)
    x = numpy.array(places)  # [time, run, node, axis]
    centre = x.mean(2)
    picture = x - centre[:, :, None]
    across, up = picture[..., 0], picture @ numpy.array(UP)
    axis = 0.5 * numpy.unwrap(numpy.arctan2(2 * (across * up).mean(2), (across**2 - up**2).mean(2)), axis=0)
    return h * numpy.arange(n + 1), numpy.stack([centre[..., 0], centre[..., 2], axis]).transpose(2, 0, 1)


def case_text(point):
    p = point
    return sets.head_of_case(END, RHO, p) + f"""[[rag]]
length_m = {SIDE}
width_m = {SIDE}
radius_m = {DIAMETER / 2}
shear_modulus_Pa = 1e4
centre_m = [0, 0, 0]
lengthwise = [{numpy.cos(p["angle"])}, 0, {numpy.sin(p["angle"])}]
crosswise = [0, 1, 0]
[virtual_camera]
right = [1, 0, 0]
up = {list(UP)}
[coupling]
mode = "one_way"
forces = ["schiller_naumann"]
"""
