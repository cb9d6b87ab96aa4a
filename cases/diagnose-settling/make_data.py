"""The measurement of this example: beads of glass and steel that settle from rest in water, after Mordant and Pinton.

    v(t) = V_s (1 - exp(-3 t/tau_95))

N. Mordant and J.-F. Pinton (2000), Velocity measurement of a settling sphere, Eur. Phys. J. B 18, 343-352: the final velocity V_s and the
time tau_95 at which 95 % of it are reached, for the three beads below; they measured by ultrasound and describe the motion by this
exponential. The data are this curve of theirs with its published numbers, not their signal; no noise is added.
Numbers of the beads: Uhlmann (2005), J. Comput. Phys. 209, 448-476 (ratios of density, Reynolds numbers), and the settling-sphere cases of
the Basilisk sandbox (V_s, tau_95). The viscosity is V_s d/Re. Writes data.csv and the case files.
"""
import math
import pathlib

G, RHO = 9.81, 1000.0
# diameter m, ratio of densities, V_s m/s, Re, tau_95 s
POINTS = {
    "A": (0.5e-3, 2.56, 0.0741, 41, 0.055),   # glass
    "B": (0.8e-3, 7.71, 0.316, 280, 0.108),   # steel
    "C": (1.5e-3, 2.56, 0.218, 360, 0.142),   # glass
}
SHARES = (0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0, 1.3, 1.7)  # of tau_95

here = pathlib.Path(__file__).parent
rows = ["point,replicate,t_s,observable,value"]
for point, (d, ratio, v_s, re, tau) in POINTS.items():
    nu = v_s * d / re
    print(f"{point}: nu = {nu:.3e} m2/s")
    for share in SHARES:
        t = share * tau
        rows.append(f"{point},1,{t:.5f},vz,{v_s * (1 - math.exp(-3 * share)):.5f}")
    (here / f"point_{point}.toml").write_text(
        f"""[case]
name = "settling-{point}"
description = "A bead settles from rest in water; z points down. Drag and weight only: no added mass, no history."
[time]
end_s = {2 * tau:.4g}
step_s = {tau / 200:.4g}
[gravity]
acceleration_m_s2 = [0, 0, {G}]
[flow]
kind = "prescribed"
density_kg_m3 = {RHO}
kinematic_viscosity_m2_s = {nu:.4g}
[[particle]]
diameter_m = {d}
density_kg_m3 = {ratio * RHO:.5g}
[coupling]
mode = "one_way"
forces = ["schiller_naumann"]
"""
    )
(here / "data.csv").write_text("\n".join(rows) + "\n")
