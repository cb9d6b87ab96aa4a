"""The measurement of this example: spheres at their terminal velocity over the range of the standard drag curve; nothing is missing.

    24/Re (1 + 0.1315 Re^(0.82 - 0.05 w))      0.01 < Re <= 20,   w = log10 Re,  Re = v d/nu
    24/Re (1 + 0.1935 Re^0.6305)                 20 < Re <= 260
    log10 C_d = 1.6435 - 1.1242 w + 0.1558 w^2   260 < Re <= 1500

The standard drag curve recommended by Clift, Grace and Weber (1978), Bubbles, Drops and Particles, table 5.2, p. 112: a fit to the
measurements of many authors. The velocity at which this drag balances weight and buoyancy is found by bisection; the sphere has it from
the start. Noise of a camera is added. Nothing here comes from Snag. Writes data.csv and the case files.
"""
import math
import pathlib
import random

G, RHO, END, SAMPLES, REPLICATES, NOISE = 9.81, 1000.0, 0.5, 10, 5, 5e-4
# diameter m, density, kinematic viscosity m2/s
POINTS = {
    "A": (0.5e-3, 2500, 1.0e-5),
    "B": (1.0e-3, 2500, 5.0e-6),
    "C": (2.0e-3, 2500, 2.0e-6),
    "D": (3.0e-3, 1400, 1.0e-6),
    "E": (1.0e-3, 7800, 1.0e-5),
    "F": (2.0e-3, 1400, 3.0e-6),
    "G": (1.5e-3, 2500, 1.0e-6),
}


def drag_coefficient(re):
    w = math.log10(re)
    if re <= 20:
        return 24 / re * (1 + 0.1315 * re ** (0.82 - 0.05 * w))
    if re <= 260:
        return 24 / re * (1 + 0.1935 * re**0.6305)
    return 10 ** (1.6435 - 1.1242 * w + 0.1558 * w * w)


def terminal_velocity(d, density, nu):
    excess = lambda v: drag_coefficient(v * d / nu) * v * v - 4 / 3 * (density / RHO - 1) * G * d
    low, high = 0.01 * nu / d, 1500 * nu / d
    assert excess(low) < 0 < excess(high), "beyond the range of the formula"
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if excess(middle) < 0 else (low, middle)
    return 0.5 * (low + high)


if __name__ == "__main__":
    here = pathlib.Path(__file__).parent
    dice = random.Random(1978)
    rows = ["point,replicate,t_s,observable,value"]
    for point, (d, density, nu) in POINTS.items():
        v = terminal_velocity(d, density, nu)
        print(f"{point}: {1e3 * v:.3f} mm/s, Re = {v * d / nu:.3f}")
        for replicate in range(1, REPLICATES + 1):
            for i in range(SAMPLES):
                t = END * (i + 1) / SAMPLES
                rows.append(f"{point},{replicate},{t:.3f},z,{1e3 * (dice.gauss(0, NOISE) - v * t):.4f}")
        (here / f"point_{point}.toml").write_text(
            f"""[case]
name = "drag-{point}"
description = "A sphere settles at its terminal velocity; nothing is missing."
[time]
end_s = {END}
step_s = 0.0025
[gravity]
acceleration_m_s2 = [0, 0, -{G}]
[flow]
kind = "prescribed"
density_kg_m3 = {RHO}
kinematic_viscosity_m2_s = {nu}
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
