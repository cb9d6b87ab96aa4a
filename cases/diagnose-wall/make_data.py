"""The measurement of this example: spheres that settle beside a plane wall and towards one, in creeping flow.

    dz/dt = -v_s/lambda,   v_s = 2/9 (rho_p - rho) g a^2/mu,   a: radius,   h: distance of the centre from the wall

Beside the wall: lambda of Goldman, Cox and Brenner (1967), Chem. Eng. Sci. 22, 637-651, table of the force on a sphere that
translates without turning, by O'Neill's exact solution (1964), at the distances of that table. Towards it: the exact series of
Brenner (1961), Chem. Eng. Sci. 16, 242-251, eq. 2.19, summed here and integrated by Runge and Kutta's method. Noise of a camera is
added. Nothing here comes from Snag. Writes data.csv and the case files.
"""
import math
import pathlib
import random

G, RHO = 9.81, 970.0
NOISE, SAMPLES, REPLICATES = 2e-5, 12, 5
BESIDE = {3.7622: 1.1738, 2.3524: 1.3079, 1.5431: 1.5675, 1.1276: 2.1514}  # h/a: lambda
# radius m, density, kinematic viscosity m2/s, how, h/a at the start, end s
POINTS = {
    "A": (2.0e-3, 1120, 1.0e-3, "beside", 1.5431, 8.0),
    "B": (1.5e-3, 1180, 1.0e-3, "beside", 2.3524, 8.0),
    "C": (2.0e-3, 1140, 1.0e-3, "towards", 4.0, 8.0),
    "D": (2.5e-3, 1050, 5.0e-4, "towards", 3.0, 8.0),
    "E": (1.5e-3, 1140, 5.0e-4, "beside", 1.1276, 8.0),
    "F": (2.5e-3, 1120, 1.0e-3, "beside", 3.7622, 6.0),
    "G": (1.5e-3, 1180, 1.0e-3, "towards", 4.5, 8.0),
}


def brenner(ratio):
    alpha, total = math.acosh(ratio), 0.0
    for n in range(1, 2000):
        if (2 * n + 1) * alpha > 300:
            break
        top = 2 * math.sinh((2 * n + 1) * alpha) + (2 * n + 1) * math.sinh(2 * alpha)
        bottom = 4 * math.sinh((n + 0.5) * alpha) ** 2 - (2 * n + 1) ** 2 * math.sinh(alpha) ** 2
        total += n * (n + 1) / ((2 * n - 1) * (2 * n + 3)) * (top / bottom - 1)
    return 4 / 3 * math.sinh(alpha) * total


def fallen(a, density, nu, how, ratio, times):
    """Fallen distance at each time, m."""
    v_s = 2 / 9 * (density - RHO) * G * a * a / (RHO * nu)
    if how == "beside":
        return [v_s / BESIDE[ratio] * t for t in times]
    speed = lambda z: v_s / brenner(ratio - z / a)
    z = t = 0.0
    h, places = times[-1] / 960, []
    for end in times:
        while t < end - h / 2:
            k1 = speed(z)
            k2 = speed(z + h / 2 * k1)
            k3 = speed(z + h / 2 * k2)
            k4 = speed(z + h * k3)
            z, t = z + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), t + h
        places.append(z)
    return places


if __name__ == "__main__":
    here = pathlib.Path(__file__).parent
    dice = random.Random(1961)
    rows = ["point,replicate,t_s,observable,value"]
    for point, (a, density, nu, how, ratio, end) in POINTS.items():
        times = [end * (i + 1) / SAMPLES for i in range(SAMPLES)]
        places = fallen(a, density, nu, how, ratio, times)
        print(point, how, f"h/a {ratio:g} ->", f"{ratio - (places[-1] / a if how == 'towards' else 0):.3f},", f"fell {places[-1] / a:.2f} a,",
              f"Re = {2 * a * places[0] / times[0] / nu:.1e}")
        for replicate in range(1, REPLICATES + 1):
            rows += [f"{point},{replicate},{t:.4f},z,{1e3 * (dice.gauss(0, NOISE) - z):.4f}" for t, z in zip(times, places)]
        normal, position = ("[1, 0, 0]", f"[{ratio * a:.7g}, 0.0, 0.0]") if how == "beside" else ("[0, 0, 1]", "[0.0, 0.0, 0.0]")
        wall = "[0, 0, 0]" if how == "beside" else f"[0, 0, {-ratio * a:.7g}]"
        (here / f"point_{point}.toml").write_text(
            f"""[case]
name = "wall-{point}"
description = "A sphere settles {how} a plane wall, the centre {ratio:g} radii from it; the base case does not know that drag grows there."
[time]
end_s = {end}
step_s = 0.02
[gravity]
acceleration_m_s2 = [0, 0, -{G}]
[flow]
kind = "prescribed"
density_kg_m3 = {RHO}
kinematic_viscosity_m2_s = {nu}
[[wall]]
kind = "plane"
point_m = {wall}
normal = {normal}
[[particle]]
diameter_m = {2 * a}
density_kg_m3 = {density}
shear_modulus_Pa = 1e4
position_m = {position}
[coupling]
mode = "one_way"
forces = ["schiller_naumann"]
"""
        )
    (here / "data.csv").write_text("\n".join(rows) + "\n")
