# cost: 80
"""Requirement: spheres computed by another program, with its own integrator and drag law and inputs off at each point, are diagnosed as what was put into them.

The program is in this file and shares nothing with Snag but the format of the data. Equation of motion, from rest in an unsteady shear
over a wall:

    (m + C_A m_f) dv/dt = 1/2 rho A (1 + f) C_d |w| w lambda + (m - m_f) g + (C_A + C_P) m_f Du/Dt
                          + C_H 6 a^2 rho sqrt(pi nu) int dw/dtau/sqrt(t - tau) dtau + C_L (lift of the shear) + m b,   w = u - v

C_d by Clift and Gauvin (1971), lambda by Faxen's series beside the wall, the lift of Saffman (1965) with Mei's (1992) factor, the slip at
the start no part of the history; Runge and Kutta's fourth order in time, the history by the exact kernel over steps of constant dw/dt.
"""
# timeout: 900
import json

import harness
import numpy

RHO, G = 1000.0, numpy.array([0.0, 0.0, -9.81])
POINTS, N_SAMPLES, REPLICATES, NOISE, END, STEP = "ABCD", 20, 5, 2e-4, 0.7, 5e-4
U_OF_INPUTS = {"flow.amplitude": 0.05, "drag_law_uncertainty": 0.05, "particle.density_kg_m3": 0.002, "flow.kinematic_viscosity_m2_s": 0.02}

# Truth, what has to be said, strengths, acceleration of a force that no library holds.
SETS = [
    ("none", "none", {}, None),
    ("added_mass", "added_mass", {"added_mass": 0.5}, None),
    ("history", "history", {"history": 1.0}, None),
    ("lift", "lift", {"lift": 1.0}, None),
    ("wall", "wall", {"wall": 1.0}, None),
    ("pair", "added_mass+pressure_gradient", {"added_mass": 0.5, "pressure_gradient": 1.0}, None),
    ("stratified", "outside", {}, lambda t, x: numpy.array([0.0, 0.0, -25 * x[2]])),
    ("three", "added_mass+history+pressure_gradient", {"added_mass": 0.5, "history": 1.0, "pressure_gradient": 1.0}, None),
    ("four", "added_mass+history+pressure_gradient+wall", {"added_mass": 0.5, "history": 1.0, "pressure_gradient": 1.0, "wall": 1.0}, None),
    (
        "five",
        "added_mass+drag_magnitude+history+pressure_gradient+wall",
        {"added_mass": 0.5, "drag_magnitude": 0.4, "history": 1.0, "pressure_gradient": 1.0, "wall": 1.0},
        None,
    ),
    (  # here a wrong density stands for two of them until it is exchanged for one
        "five_others",
        "added_mass+drag_magnitude+history+pressure_gradient+wall",
        {"added_mass": 0.5, "drag_magnitude": 0.4, "history": 1.0, "pressure_gradient": 1.0, "wall": 1.0},
        None,
    ),
]


class Water:
    def __init__(self, velocity, amplitude, omega, shear, nu):
        self.velocity, self.amplitude, self.omega, self.shear, self.nu = velocity, amplitude, omega, shear, nu

    def at(self, t, x):
        return numpy.array([self.velocity + self.amplitude * numpy.sin(self.omega * t) + self.shear * x[2], 0.0, 0.0])

    def acceleration(self, t):
        return numpy.array([self.amplitude * self.omega * numpy.cos(self.omega * t), 0.0, 0.0])

    def scaled(self, factor, nu_factor):
        return Water(self.velocity * factor, self.amplitude * factor, self.omega, self.shear * factor, self.nu * nu_factor)


def drag_coefficient(Re):
    return 24 / Re * (1 + 0.15 * Re**0.687) + 0.42 / (1 + 42500 * Re**-1.16)


def lift_factor(Re, a):
    root = 0.3314 * numpy.sqrt(a)
    return (1 - root) * numpy.exp(-Re / 10) + root if Re <= 40 else 0.0524 * numpy.sqrt(a * Re)


def path(water, d, density, height, strengths, other_force):
    """Positions at all steps, in m."""
    mass, displaced = density * numpy.pi / 6 * d**3, RHO * numpy.pi / 6 * d**3
    moved = mass + strengths.get("added_mass", 0.0) * displaced
    per_history = strengths.get("history", 0.0) * 1.5 * d * d * RHO * numpy.sqrt(numpy.pi * water.nu)

    def acceleration(t, x, v, history):
        w = water.at(t, x) - v
        speed = numpy.linalg.norm(w)
        Re = max(speed * d / water.nu, 1e-9)
        drag = RHO / 8 * numpy.pi * d * d * (1 + strengths.get("drag_magnitude", 0.0)) * drag_coefficient(Re) * Re * water.nu / d
        k = d / 2 / x[1]
        beside = 1 / (1 - 9 / 16 * k + k**3 / 8 - 45 / 256 * k**4 - k**5 / 16)
        force = drag * w * (1 + strengths.get("wall", 0.0) * (beside - 1)) + (mass - displaced) * G + history
        force += (strengths.get("added_mass", 0.0) + strengths.get("pressure_gradient", 0.0)) * displaced * water.acceleration(t)
        if strengths.get("lift") and water.shear and speed > 0:
            factor = lift_factor(Re, min(0.5 * water.shear * d / speed, 0.4))
            size = 1.615 * RHO * d * d * numpy.sqrt(water.nu / water.shear) * factor
            force += strengths["lift"] * size * numpy.cross(w, [0.0, water.shear, 0.0])
        if other_force:
            force += mass * other_force(t, x)
        return force / moved

    x, v = numpy.array([0.0, height, 0.0]), numpy.zeros(3)
    n = round(END / STEP)
    positions, slips = [x], numpy.zeros((n + 1, 3))
    slips[0] = water.at(0.0, x) - v
    times = STEP * numpy.arange(n + 1)
    for i in range(n):
        t, h, history = times[i], STEP, numpy.zeros(3)
        if per_history and i > 0:
            kernel = 2 * (numpy.sqrt(t - times[:i]) - numpy.sqrt(numpy.maximum(t - times[1 : i + 1], 0)))
            history = per_history * kernel @ (numpy.diff(slips[: i + 1], axis=0) / h)
        stages, dx, dv = [], numpy.zeros(3), numpy.zeros(3)
        for share in (0, 0.5, 0.5, 1):
            dx, dv = v + share * h * dv, acceleration(t + share * h, x + share * h * dx, v + share * h * dv, history)
            stages.append((dx, dv))
        x, v = (y + h / 6 * (stages[0][j] + 2 * stages[1][j] + 2 * stages[2][j] + stages[3][j]) for j, y in enumerate((x, v)))
        slips[i + 1] = water.at(t + h, x) - v
        positions.append(x)
    return times, numpy.array(positions)


def case_text(water, d, density, height):
    return f"""[time]
end_s = {END}
step_s = 0.001
[gravity]
acceleration_m_s2 = [0, 0, -9.81]
[flow]
kind = "prescribed"
density_kg_m3 = {RHO}
kinematic_viscosity_m2_s = {water.nu}
velocity_m_s = [{water.velocity}, 0, 0]
gradient_per_s = [[0, 0, {water.shear}], [0, 0, 0], [0, 0, 0]]
amplitude_m_s = [{water.amplitude}, 0, 0]
angular_frequency_rad_s = [{water.omega}, 0, 0]
[[particle]]
diameter_m = {d}
density_kg_m3 = {density}
shear_modulus_Pa = 1e4  # it touches nothing: a soft sphere needs a fifth of the sub-steps
position_m = [0, {height}, 0]
[[wall]]
kind = "plane"
point_m = [0, 0, 0]
normal = [0, 1, 0]
[coupling]
mode = "one_way"
forces = ["schiller_naumann"]
"""


def write_set(folder, seed, strengths, other_force):
    """An experiment whose inputs are off at each point by what is stated of them."""
    random = numpy.random.default_rng(seed)
    folder.mkdir(parents=True)
    d, density, nu = random.uniform(4e-3, 8e-3), random.uniform(1080, 1900), 10 ** random.uniform(-5.6, -4.5)
    diagnosis = ['[experiment]\nname = "spheres of another program"\ndata = "data.csv"\n']
    diagnosis += [f'[[observable]]\nid = "{id}"\nunit = "mm"\nkind = "gaussian"\nnoise_u = {1e3 * NOISE}\n' for id in "xyz"]
    rows = ["point,replicate,t_s,observable,value"]
    for i, point in enumerate(POINTS):
        oscillates, sheared, near = i in (0, 2), i in (1, 2), i in (1, 3)
        water = Water(random.uniform(0, 0.05), oscillates * random.uniform(0.05, 0.2), random.uniform(6, 25), sheared * random.uniform(1, 4), nu)
        height = random.uniform(0.7, 1.2) * d if near else 12 * d
        off = {key: 1 + u * random.standard_normal() for key, u in U_OF_INPUTS.items()}
        true_water = water.scaled(off["flow.amplitude"], off["flow.kinematic_viscosity_m2_s"])
        times, positions = path(true_water, d, density * off["particle.density_kg_m3"], height, strengths, other_force)
        for replicate in range(1, REPLICATES + 1):
            for k in range(1, N_SAMPLES + 1):
                n = k * (len(times) - 1) // N_SAMPLES
                for id, value in zip("xyz", positions[n] + NOISE * random.standard_normal(3)):
                    rows.append(f"{point},{replicate},{times[n]:.6g},{id},{1e3 * value:.6g}")
        (folder / f"{point}.toml").write_text(case_text(water, d, density, height))
        input_u = ", ".join(f'"{key}" = {u}' for key, u in U_OF_INPUTS.items())
        diagnosis.append(f'[[point]]\nid = "{point}"\ncase = "{point}.toml"\nrole = "train"\ninput_u = {{ {input_u} }}\n')
    (folder / "DIAGNOSIS.toml").write_text("\n".join(diagnosis))
    (folder / "data.csv").write_text("\n".join(rows) + "\n")


class OtherProgram(harness.CaseTest):
    sets = ("pair", "stratified", "three")  # diagnose_other_program_long.py has all of them

    def test_spheres(self):
        for seed, (name, expected, strengths, other_force) in enumerate(SETS):
            if name not in self.sets:
                continue
            with self.subTest(name):
                folder = self.work / name
                write_set(folder, 70 + seed, strengths, other_force)
                run = harness.snag(["diagnose", folder / "DIAGNOSIS.toml", "--out", folder / "out"], 1, folder / "out")
                self.assertEqual(run.code, 0, run.tail())
                verdict = json.loads((run.folder / "verdict.json").read_text())
                said = "+".join(verdict["effects"]) if verdict["verdict"] == "effects" else verdict["verdict"]
                print(name, said, verdict["wording"], verdict["parameters"], flush=True)
                self.assertEqual(said, expected, verdict["probability"])
                for effect, strength in strengths.items():
                    found = verdict["parameters"][effect]
                    self.assertLess(abs(found["mean"] - strength), 4 * found["sd"], effect)


if __name__ == "__main__":
    harness.main()
