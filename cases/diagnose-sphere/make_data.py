"""The measurement of this example: spheres that fall from rest, with the added mass that the base case leaves out.

    (m + C_m m_f) dv/dt = (m - m_f) g - 1/2 rho C_d(Re) A |v| v,    C_m = 1/2,    m_f: mass of the displaced fluid

integrated by Runge and Kutta's method, not by Snag; noise of a camera is added. Writes data.csv and the case files.
"""
import math
import pathlib
import random

RHO, NU, G, C_M = 1000.0, 1e-5, 9.81, 0.5
POINTS = {"A": (6e-3, 1200), "B": (4e-3, 1500), "C": (8e-3, 1100), "D": (5e-3, 1350), "E": (7e-3, 1250), "F": (4.5e-3, 1400), "G": (6.5e-3, 1150)}
NOISE, END, SAMPLES, REPLICATES = 2e-4, 0.4, 20, 5


def acceleration(v, d, density):
    m, m_f = density * math.pi / 6 * d**3, RHO * math.pi / 6 * d**3
    re = abs(v) * d / NU
    drag = math.pi / 8 * RHO * NU * d * 24 * (1 + 0.15 * re**0.687) * v
    return (-(m - m_f) * G - drag) / (m + C_M * m_f)


def fall(d, density, times):
    z = v = t = 0.0
    h, places = 1e-4, []
    for end in times:
        while t < end - h / 2:
            k1 = acceleration(v, d, density)
            k2 = acceleration(v + h / 2 * k1, d, density)
            k3 = acceleration(v + h / 2 * k2, d, density)
            k4 = acceleration(v + h * k3, d, density)
            z += h * v + h * h / 6 * (k1 + k2 + k3)
            v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
            t += h
        places.append(z)
    return places


here = pathlib.Path(__file__).parent
dice = random.Random(5)
rows = ["point,replicate,t_s,observable,value"]
times = [END * (i + 1) / SAMPLES for i in range(SAMPLES)]
for point, (d, density) in POINTS.items():
    places = fall(d, density, times)
    for replicate in range(1, REPLICATES + 1):
        rows += [f"{point},{replicate},{t:.3f},z,{1e3 * (z + dice.gauss(0, NOISE)):.4f}" for t, z in zip(times, places)]
    (here / f"point_{point}.toml").write_text(
        f"""[case]
name = "falling-sphere-{point}"
description = "A sphere falls from rest in still fluid; drag and weight only."
[time]
end_s = {END}
step_s = 1e-3
[gravity]
acceleration_m_s2 = [0, 0, -{G}]
[flow]
kind = "prescribed"
density_kg_m3 = {RHO}
kinematic_viscosity_m2_s = {NU}
[[particle]]
diameter_m = {d}
density_kg_m3 = {density}
[coupling]
mode = "one_way"
forces = ["schiller_naumann"]
"""
    )
(here / "data.csv").write_text("\n".join(rows) + "\n")
