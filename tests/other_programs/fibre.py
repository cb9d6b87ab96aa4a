"""Flexible fibres that move in a plane of water, by a program that shares nothing with Snag but the format of the data.

The fibre is a chain of N rigid links of the length l with springs at their joints, in minimal coordinates: its centre and the angle of each
link. Nothing stretches, so that no step is bound by the stiffness along the fibre. With r_k = r_c + sum_j C_kj e_j at two Gauss points a link,

    sum_k J_k^T M_k J_k q'' = sum_k J_k^T (F_k + M_k sum_j C_kj theta_j'^2 e_j) + bending + couples,    J_k = dr_k/dq
    bending: E I/l (theta_{j+1} - theta_j - kappa l) between neighbours,  I = pi D^4/64

Per length of the fibre, D its diameter, A = pi/4 D^2, w = u - v, u = (V + A_0 sin(omega t) + S z) e_x, s = 1.2 across the fibre and 0.8 along it:

    F = pi/8 rho nu (C_d Re) w f + (rho_p - rho) A g + C_A s rho A (Du/Dt - dv/dt) + C_W rho A (Du/Dt - dv/dt) + C_P rho A (du/dt along the fibre)
        + C_H 3/2 D rho sqrt(pi nu) int dw/dtau/sqrt(t - tau) dtau + C_L 1.615 D rho sqrt(nu/S) f_L w x curl u + rho_p A b
    couple: C_T pi rho nu D^2 (-S/2 - theta')

C_d: a sphere of the diameter D stands for each length D, by Clift and Gauvin (1971) or by Brown and Lawler (2003). f: the factors of size,
exponent, wall (Faxen's series along the wall), shelter 1 - C_S cos^2 (angle between slip and fibre), and folding (1 + (|w|/w_0)^4)^(V/4) of
unresolved parts, w_0 = 0.5 m/s. The slip at the start does not count in the history. b: accelerations that no library holds; so are a curved
rest shape (kappa) and a couple that aligns the fibre. Runge and Kutta's fourth order in time; the history by its exact kernel.

Apart from the sets, the share `fibre_drag` of the drag is that of a cylinder by its axis: across it C_d of Sucker and Brauer (1975) with the slip
across, 1.18 + 6.8 Re^-0.89 + 1.96 Re^-0.5, along it the root of the squares of a creeping slender body, 2 pi mu/(ln(2 L/D) - 1/2) a length (Cox
1970), and of Taylor's (1952) layer, 2.7 mu Re^(1/2), Re with the slip across.

In a shear without weight or inertia a stiff chain turns as Jeffery's (1922) ellipsoid of the aspect ratio r with r^2 = 1 + zeta L^2/(6 kappa),
zeta the drag and kappa the couple per length (zeta w, kappa (-S/2 - theta')), in the period 2 pi/S (r + 1/r).

The camera gives the centroid of the picture in whole twentieths of a millimetre, and the long axis of its second moments in whole 0.002 rad.
"""
import numpy
import sets
import sphere

RHO, G = 1000.0, 9.81
END, STEP = 0.4, 8e-4
N_LINKS, N_BEADS = 6, 12  # of this program; of the base case
GAUSS = 0.5 / numpy.sqrt(3)

NAME = "fibre"
OBSERVABLES = [
    {"id": "x", "unit": "mm", "kind": "gaussian", "factor": 1e3, "noise": 2e-4, "bias": 1e-4, "smallest": 0.05},
    {"id": "z", "unit": "mm", "kind": "gaussian", "factor": 1e3, "noise": 2e-4, "bias": 1e-4, "smallest": 0.05},
    {"id": "orientation", "unit": "rad", "kind": "angle", "factor": 1.0, "noise": 0.02, "bias": 0.0, "smallest": 0.002},
]
INPUTS = {"flow.amplitude": 0.05, "fibre.density_kg_m3": 0.005, "fibre.youngs_modulus_Pa": 0.05, "flow.kinematic_viscosity_m2_s": 0.02,
          "drag_law_uncertainty": 0.05}
EXPECTED = {"added_mass": 0.5, "pressure_gradient": 1.0, "history": 1.0, "lift": 1.0, "wall": 1.0, "drag_magnitude": 0.3, "drag_exponent": 0.2,
            "torque": 1.0, "shielding": 0.5, "reconfiguration": -0.67, "entrained_water": 1.0}
SAME_CAUSE = {"entrained_water": "added_mass"}
FORMS = {}
LOCAL = ["drag_magnitude", "wall", "pressure_gradient", "added_mass", "shielding"]
WRONG_INPUTS = {
    "fibre.density_kg_m3": (4, 12, ["input:fibre.density_kg_m3"]),
    "flow.kinematic_viscosity_m2_s": (8, 20, ["input:flow.kinematic_viscosity_m2_s"]),
    "flow.amplitude": (4, 7, ["operating_point", "input:flow.amplitude"]),
}
# Strengths: m/s2; stratified 1/s2; curved: angle between the ends, rad; aligned: 1/s2.
OUTSIDE = {"stratified": (5, 30), "periodic": (0.3, 3), "gust": (0.5, 4), "curved": (0.3, 1.5), "aligned": (20, 200)}
N_TRAINING, TIMES = 4, END * numpy.arange(1, 13) / 12


def points(random):
    """Four operating points of training and three withheld ones, as numbers of `simulate`."""
    length, modulus, density = random.uniform(0.02, 0.03), random.uniform(3e4, 1.5e5), random.uniform(1100, 1400)
    nu, law, along = random.uniform(1e-5, 4e-5), random.integers(2), random.integers(2)
    all = []
    for i in (1, 2, 3, 0, 3, 1, 2):
        oscillates, sheared, near = i in (1, 3), i in (2, 3), i in (0, 2)
        speed = 0.3 * random.uniform(0.7, 1.5)
        all.append({
            "length": length, "modulus": modulus, "density": density, "viscosity": nu, "law": law, "along": along,
            "velocity": random.uniform(0.1, 0.5) * speed, "amplitude": oscillates * random.uniform(0.5, 1.5) * speed,
            "omega": random.uniform(8, 25), "shear": sheared * random.uniform(10, 30) * speed, "angle": random.uniform(-0.6, 0.6),
            "distance": random.uniform(0.8, 1.6) * length / N_BEADS if near else 0.05,
        })
    return all


def groups():
    return ["first day", "first day", "second day", "second day", "first day", "second day", "second day"]


def unknown_force(random, name):
    low, high = OUTSIDE[name]
    angle, begin = random.uniform(0, 2 * numpy.pi), random.uniform(0.2, 0.5) * END
    return {"other_" + name: low * (high / low) ** random.uniform(), "other_omega": random.uniform(15, 40), "other_phase": random.uniform(0, 6),
            "other_x": numpy.cos(angle), "other_z": numpy.sin(angle), "other_begin": begin, "other_end": begin + random.uniform(0.1, 0.25) * END}


def gate(random):
    """Where an effect acts that does not act everywhere: after a time, or below a height."""
    if random.uniform() < 0.5:
        return {"gate_time": random.uniform(0.2, 0.6) * END}
    return {"gate_depth": -random.uniform(0.002, 0.015)}


def lever_arms():
    """C over l: Gauss points (two a link) by links, about the centre."""
    arms = numpy.zeros((2 * N_LINKS, N_LINKS))
    for i in range(N_LINKS):
        for side in (0, 1):
            arms[2 * i + side, :i] = 1
            arms[2 * i + side, i] = 0.5 + (2 * side - 1) * GAUSS
    return arms - arms.mean(0)


def simulate(p, duration=END):
    """Times, s, and what the camera sees then: [run, observable, time]. p("name", default) is an array, one entry a run."""
    L, law, flow = p("length"), p("law"), p("flow.amplitude", 1)
    D, l, h = L / N_BEADS, L / N_LINKS, STEP
    density, nu = p("density") * p("fibre.density_kg_m3", 1), p("viscosity") * p("flow.kinematic_viscosity_m2_s", 1)
    stiffness = p("modulus") * p("fibre.youngs_modulus_Pa", 1) * numpy.pi / 64 * D**4 / l
    V, A, omega, S = p("velocity") * flow, p("amplitude") * flow, p("omega"), p("shear") * flow
    n_runs, half = len(L), l / 2  # each Gauss point stands for half a link
    mass, displaced = density * numpy.pi / 4 * D**2 * half, RHO * numpy.pi / 4 * D**2 * half
    weight = (mass - displaced) * p("gravity", G)
    theta = {name: p(name, 0) for name in EXPECTED}
    cylinder = p("fibre_drag", 0)
    factor, slope = p("drag_law_uncertainty", 1), p("drag_law_uncertainty.slope", 0)
    gate_time, gate_depth, distance, along = p("gate_time", -1), p("gate_depth", 1e9), p("distance"), p("along")
    other = {name: p("other_" + name, 0) for name in OUTSIDE}
    other_omega, other_phase, bx, bz = p("other_omega", 1), p("other_phase", 0), p("other_x", 0), p("other_z", 0)
    begin, end = p("other_begin", 0), p("other_end", 0)
    C = lever_arms()[None] * l[:, None, None]
    k = numpy.minimum(D / 2 / distance, 0.95)
    beside = 1 / (1 - 9 / 16 * k + k**3 / 8 - 45 / 256 * k**4 - k**5 / 16)
    per_history = theta["history"] * 1.5 * D * RHO * numpy.sqrt(numpy.pi * nu) * half
    remembers = numpy.flatnonzero(per_history)
    own_step = per_history * 4 / 3 * numpy.sqrt(h)
    per_lift = theta["lift"] * 1.615 * RHO * D * numpy.sqrt(nu / numpy.where(S > 0, S, 1)) * S * half
    per_turn = theta["torque"] * numpy.pi * RHO * nu * D**2 * l
    rest_angle = other["curved"] / N_LINKS
    inertia = density * numpy.pi / 4 * D**2 * l * L**2 / 12
    col = lambda a: a[:, None]  # noqa: E731
    J = numpy.zeros((n_runs, 2 * N_LINKS, 2, 2 + N_LINKS))
    J[:, :, 0, 0] = J[:, :, 1, 1] = 1
    flat = J.reshape(n_runs, 4 * N_LINKS, 2 + N_LINKS)

    def acceleration(t, q, v, history, only_slip=False):
        e = numpy.stack([numpy.cos(q[:, 2:]), numpy.sin(q[:, 2:])])
        J[:, :, 0, 2:], J[:, :, 1, 2:] = C * -e[1][:, None], C * e[0][:, None]
        z = col(q[:, 1]) + (C @ e[1][:, :, None])[:, :, 0]
        velocity = (flat @ v[:, :, None]).reshape(n_runs, 2 * N_LINKS, 2)
        ux, dudt = col(V + A * numpy.sin(omega * t)) + col(S) * z, col(A * omega * numpy.cos(omega * t))
        wx, wz = ux - velocity[:, :, 0], -velocity[:, :, 1]
        if only_slip:
            return numpy.stack([wx, wz])
        tangent = numpy.repeat(e, 2, axis=2)  # of the Gauss points
        speed = numpy.sqrt(wx * wx + wz * wz)
        Re = speed * col(D / nu)
        on = col(t >= gate_time) & (z <= col(gate_depth))
        drag = numpy.pi / 8 * RHO * col(nu * half) * sphere.drag_times_reynolds(col(law), Re) * col(factor)
        drag = drag * (numpy.maximum(Re, 1) / 100) ** col(slope)
        drag = drag * (1 + on * col(theta["drag_magnitude"])) * ((Re + 1) / 100) ** (on * col(theta["drag_exponent"]))
        drag = drag * (1 + on * col(theta["wall"] * (beside - 1)))
        cosine = (wx * tangent[0] + wz * tangent[1]) ** 2 / numpy.maximum(speed, 1e-12) ** 2
        drag = drag * (1 - on * col(theta["shielding"]) * cosine) * (1 + (speed / 0.5) ** 4) ** (on * col(theta["reconfiguration"]) / 4)
        slip_t = wx * tangent[0] + wz * tangent[1]
        slip_n = [wx - slip_t * tangent[0], wz - slip_t * tangent[1]]
        Re_n = numpy.maximum(numpy.hypot(*slip_n) * col(D / nu), 1e-9)
        spheres = 1 - col(cylinder)
        K_n = 0.5 * (1.18 * Re_n + 6.8 * Re_n**0.11 + 1.96 * Re_n**0.5)
        K_t = numpy.hypot(2 * numpy.pi / col(numpy.log(2 * L / D) - 0.5), 2.7 * numpy.sqrt(Re_n))
        per_length = col(cylinder * RHO * nu * half * factor) * (numpy.maximum(Re, 1) / 100) ** col(slope)
        across_x, across_z = per_length * K_n * slip_n[0], per_length * K_n * slip_n[1]
        along_x, along_z = per_length * K_t * slip_t * tangent[0], per_length * K_t * slip_t * tangent[1]
        along_fibre = dudt + col(S) * velocity[:, :, 1]
        Fx, Fz = spheres * drag * wx + across_x + along_x + history[0], spheres * drag * wz + across_z + along_z + history[1] - col(weight)
        Fx = Fx + on * col(theta["pressure_gradient"] * displaced) * numpy.where(col(along) == 1, along_fibre, dudt) + col(own_step) * along_fibre
        a = numpy.minimum(0.5 * col(S * D) / numpy.maximum(speed, 1e-12), 0.4)
        lift = on * col(per_lift) * sphere.lift_factor(Re, a)
        Fx, Fz = Fx - lift * wz, Fz + lift * wx
        b = other["periodic"] * numpy.sin(other_omega * t + other_phase) + other["gust"] * ((t > begin) & (t < end))
        Fx = Fx + col(mass * b * bx)
        Fz = Fz + col(mass) * (col(b * bz) - col(other["stratified"]) * z)
        # Mass that is accelerated: m I + across n n^T + along t t^T, and the same water brings Du/Dt.
        both = col(theta["entrained_water"] * displaced)
        added = col(theta["added_mass"] * displaced)
        water_t, water_n = on * (both + 0.8 * added), on * (both + 1.2 * added)
        m_t, m_n = col(mass + own_step) + water_t, col(mass + own_step) + water_n
        tx, tz = tangent
        Mxx, Mxz, Mzz = m_t * tx * tx + m_n * tz * tz, (m_t - m_n) * tx * tz, m_t * tz * tz + m_n * tx * tx
        Fx = Fx + (water_t * tx * tx + water_n * tz * tz) * dudt
        Fz = Fz + (water_t - water_n) * tx * tz * dudt
        square = v[:, 2:] ** 2 * e  # of the turning links
        turning_x, turning_z = ((C @ one[:, :, None])[:, :, 0] for one in square)
        Fx = Fx + Mxx * turning_x + Mxz * turning_z
        Fz = Fz + Mxz * turning_x + Mzz * turning_z
        MJ = numpy.empty_like(J)
        MJ[:, :, 0] = Mxx[:, :, None] * J[:, :, 0] + Mxz[:, :, None] * J[:, :, 1]
        MJ[:, :, 1] = Mxz[:, :, None] * J[:, :, 0] + Mzz[:, :, None] * J[:, :, 1]
        transposed = flat.transpose(0, 2, 1)
        matrix = transposed @ MJ.reshape(flat.shape)
        force = (transposed @ numpy.stack([Fx, Fz], axis=2).reshape(n_runs, -1, 1))[:, :, 0]
        bend = col(stiffness) * (numpy.diff(q[:, 2:], axis=1) - col(rest_angle))
        force[:, 2:-1] += bend
        force[:, 3:] -= bend
        force[:, 2:] += col(per_turn) * (-col(S) / 2 - v[:, 2:]) + col(inertia * other["aligned"]) * numpy.sin(2 * (1.0 - q[:, 2:])) / 2
        return numpy.linalg.solve(matrix, force[:, :, None])[:, :, 0]

    n = int(numpy.ceil(duration / h - 1e-9))
    q, v = numpy.zeros((n_runs, 2 + N_LINKS)), numpy.zeros((n_runs, 2 + N_LINKS))
    q[:, 2:] = col(p("angle"))
    q[:, 2:] += col(rest_angle) * (numpy.arange(N_LINKS) - (N_LINKS - 1) / 2)  # it is put in as it lies
    kernel = numpy.diff(4 / 3 * numpy.sqrt(h) * numpy.diff(numpy.arange(n + 2) ** 1.5))[::-1]
    changes, slip = numpy.zeros((n, 2 * len(remembers) * 2 * N_LINKS)), None
    states = [q]
    for i in range(n):
        t, history = h * i, numpy.zeros((2, n_runs, 2 * N_LINKS))
        if len(remembers):
            now = acceleration(t, q, v, history, only_slip=True)[:, remembers]
            if i > 0:
                changes[i - 1] = (now - slip).ravel()
                memory = (kernel[len(kernel) - i :] @ changes[:i] / h).reshape(now.shape)
                history[:, remembers] = per_history[remembers][:, None] * memory
            slip = now
        a1 = acceleration(t, q, v, history)
        v2 = v + h / 2 * a1
        a2 = acceleration(t + h / 2, q + h / 2 * v, v2, history)
        v3 = v + h / 2 * a2
        a3 = acceleration(t + h / 2, q + h / 2 * v2, v3, history)
        v4 = v + h * a3
        a4 = acceleration(t + h, q + h * v3, v4, history)
        q = q + h / 6 * (v + 2 * v2 + 2 * v3 + v4)
        v = v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
        states.append(q)
    q = numpy.array(states)  # [time, run, coordinate]
    X = (C[None] @ numpy.cos(q[:, :, 2:, None]))[..., 0]
    Z = (C[None] @ numpy.sin(q[:, :, 2:, None]))[..., 0]
    axis = 0.5 * numpy.arctan2(2 * (X * Z).mean(2), (X * X - Z * Z).mean(2))
    axis = 0.5 * numpy.unwrap(2 * axis, axis=0)
    return h * numpy.arange(n + 1), numpy.stack([q[:, :, 0], q[:, :, 1], axis]).transpose(2, 0, 1)


def case_text(point):
    p = point
    return sets.head_of_case(END, RHO, p) + f"""[[fibre]]
length_m = {p["length"]}
n_points = {N_BEADS}
youngs_modulus_Pa = {p["modulus"]}
density_kg_m3 = {p["density"]}
shear_modulus_Pa = 1e4
centre_m = [0, {p["distance"]}, 0]
lengthwise = [{numpy.cos(p["angle"])}, 0, {numpy.sin(p["angle"])}]
[[wall]]
kind = "plane"
point_m = [0, 0, 0]
normal = [0, 1, 0]
[virtual_camera]
right = [1, 0, 0]
up = [0, 0, 1]
[coupling]
mode = "one_way"
forces = ["schiller_naumann"]
"""
