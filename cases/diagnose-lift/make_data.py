"""The measurement of this example: spheres that settle in a vertical shear flow and drift across it.

    m dv/dt = (rho_p - rho) V g + 6 pi mu a f w + F_lift,   w = u(x) - v,   u_z = G x,   f = 1 + 0.15 Re^0.687 (Re < 1 here)
    F_lift = 6.46 rho nu^(1/2) a^2 |G|^(1/2) |w| J(eps)/2.255 across the flow,   eps = (|G| nu)^(1/2)/|w|
    J(eps) = 0.6765 (1 + tanh(2.5 log10 eps + 0.191)) (0.667 + tanh(6 (eps - 0.32)))     0.1 < eps < 20

Saffman (1965), J. Fluid Mech. 22, 385-400 (corrigendum 31, 624); J for finite eps: McLaughlin (1991), J. Fluid Mech. 224, 261-274,
in the formula of Mei (1992), Int. J. Multiphase Flow 18, 145-147. A sphere that lags behind the flow in z drifts towards the fluid that
passes it faster. Inertia of the fluid (added mass, history) is left out. Runge and Kutta's method; noise of a camera is added. Nothing here
comes from Snag, whose lift has another form: Mei's other formula, and the lift by spin of a sphere that does not turn.
Writes data.csv and the case files.
"""
import math
import pathlib
import random

GRAVITY, RHO, END, SAMPLES, REPLICATES, NOISE = 9.81, 960.0, 4.0, 10, 5, 5e-5
# diameter m, density, kinematic viscosity m2/s, shear G 1/s
POINTS = {
    "A": (2.0e-3, 1150, 1.0e-4, 8),
    "B": (2.0e-3, 1100, 8.0e-5, -12),
    "C": (1.5e-3, 1250, 1.0e-4, 10),
    "D": (2.0e-3, 1150, 1.0e-4, 0),
    "E": (2.0e-3, 1180, 1.2e-4, 14),
    "F": (1.8e-3, 1150, 8.0e-5, -8),
    "G": (1.5e-3, 1200, 8.0e-5, 10),
}


def mei(eps):
    return 0.6765 * (1 + math.tanh(2.5 * math.log10(eps) + 0.191)) * (0.667 + math.tanh(6 * (eps - 0.32)))


def rates(state, d, density, nu, shear):
    x, z, vx, vz = state
    wx, wz = -vx, shear * x - vz
    w, a = math.hypot(wx, wz), d / 2
    volume = math.pi / 6 * d**3
    drag = 6 * math.pi * RHO * nu * a * (1 + 0.15 * (w * d / nu) ** 0.687)
    fx, fz = drag * wx, drag * wz - (density - RHO) * volume * GRAVITY
    if shear and w > 0:
        eps = math.sqrt(abs(shear) * nu) / w
        assert 0.1 < eps < 20, "beyond the range of J"
        lift = 6.46 * RHO * math.sqrt(nu * abs(shear)) * a * a * mei(eps) / 2.255
        # w x omega with omega = curl u = -shear e_y
        sign = math.copysign(1, shear)
        fx, fz = fx + lift * wz * sign, fz - lift * wx * sign
    mass = density * volume
    return vx, vz, fx / mass, fz / mass


def settle(d, density, nu, shear, times):
    state, t, h, places = [0.0, 0.0, 0.0, -start_velocity(d, density, nu)], 0.0, 2e-4, []
    for end in times:
        while t < end - h / 2:
            k1 = rates(state, d, density, nu, shear)
            k2 = rates([s + h / 2 * k for s, k in zip(state, k1)], d, density, nu, shear)
            k3 = rates([s + h / 2 * k for s, k in zip(state, k2)], d, density, nu, shear)
            k4 = rates([s + h * k for s, k in zip(state, k3)], d, density, nu, shear)
            state = [s + h / 6 * (p + 2 * q + 2 * r + o) for s, p, q, r, o in zip(state, k1, k2, k3, k4)]
            t += h
        places.append(state[:2])
    return places


def start_velocity(d, density, nu):
    """Settling velocity without shear, so that lag and eps are in range from the start."""
    v = 0.0
    for _ in range(200):
        v = (density / RHO - 1) * GRAVITY * d * d / (18 * nu) / (1 + 0.15 * (v * d / nu) ** 0.687)
    return v


if __name__ == "__main__":
    here = pathlib.Path(__file__).parent
    dice = random.Random(1965)
    rows = ["point,replicate,t_s,observable,value"]
    for point, (d, density, nu, shear) in POINTS.items():
        times = [END * (i + 1) / SAMPLES for i in range(SAMPLES)]
        places, v = settle(d, density, nu, shear, times), start_velocity(d, density, nu)
        print(f"{point}: {1e3 * v:.2f} mm/s, Re = {v * d / nu:.2f}, Re_G = {abs(shear) * d * d / nu:.2f}, eps = {math.sqrt(abs(shear) * nu) / v:.2f}, "
              f"drift {1e3 * places[-1][0]:.2f} mm")
        for replicate in range(1, REPLICATES + 1):
            for t, place in zip(times, places):
                rows += [f"{point},{replicate},{t:.3f},{name},{1e3 * (p + dice.gauss(0, NOISE)):.4f}" for name, p in zip("xz", place)]
        (here / f"point_{point}.toml").write_text(
            f"""[case]
name = "lift-{point}"
description = "A sphere settles in a vertical shear flow, u_z = {shear} x; the base case has no lift."
[time]
end_s = {END}
step_s = 0.005
[gravity]
acceleration_m_s2 = [0, 0, -{GRAVITY}]
[flow]
kind = "prescribed"
density_kg_m3 = {RHO}
kinematic_viscosity_m2_s = {nu}
gradient_per_s = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [{float(shear)}, 0.0, 0.0]]
[[particle]]
diameter_m = {d}
density_kg_m3 = {density}
velocity_m_s = [0.0, 0.0, {-v:.6g}]
[coupling]
mode = "one_way"
forces = ["schiller_naumann"]
"""
        )
    (here / "data.csv").write_text("\n".join(rows) + "\n")
