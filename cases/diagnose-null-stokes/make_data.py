"""The measurement of this example: spheres at their terminal velocity in creeping flow, where nothing is missing.

    C_d = 24/Re (1 + 3/16 Re + 9/160 Re^2 ln(Re/2)),   Re = v d/nu

Proudman and Pearson (1957), J. Fluid Mech. 2, 237-262, which is Stokes' law (1851) with the first effects of inertia. The velocity at
which this drag balances weight and buoyancy is found by bisection; the sphere has it from the start. Noise of a camera is added.
Nothing here comes from Snag. Writes data.csv and the case files.
"""
import math
import pathlib
import random

G, RHO, END, SAMPLES, REPLICATES, NOISE = 9.81, 960.0, 2.0, 10, 5, 1e-4
# diameter m, density, kinematic viscosity m2/s
POINTS = {
    "A": (1.0e-3, 2500, 1.0e-3),
    "B": (2.0e-3, 2500, 1.0e-3),
    "C": (3.0e-3, 1400, 5.0e-4),
    "D": (2.0e-3, 7800, 2.0e-3),
    "E": (1.5e-3, 2500, 5.0e-4),
    "F": (2.5e-3, 1400, 3.0e-4),
    "G": (3.0e-3, 2500, 2.0e-3),
}


def drag_coefficient(re):
    return 24 / re * (1 + 3 / 16 * re + 9 / 160 * re * re * math.log(re / 2))


def terminal_velocity(d, density, nu):
    excess = lambda v: drag_coefficient(v * d / nu) * v * v - 4 / 3 * (density / RHO - 1) * G * d
    low, high = 1e-9, 0.5 * nu / d  # Re from nothing to 1/2
    assert excess(low) < 0 < excess(high), "beyond the range of the formula"
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if excess(middle) < 0 else (low, middle)
    return 0.5 * (low + high)


if __name__ == "__main__":
    here = pathlib.Path(__file__).parent
    dice = random.Random(1851)
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
name = "stokes-{point}"
description = "A sphere settles in creeping flow at its terminal velocity; nothing is missing."
[time]
end_s = {END}
step_s = 0.01
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
