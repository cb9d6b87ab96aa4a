"""The measurement of this example: stiff fibres that turn in a shear flow, Jeffery's orbits.

    tan(phi) = r_e tan(G t/(r_e + 1/r_e) + c),   period 2 pi/G (r_e + 1/r_e),   phi: from the direction of the gradient towards the flow

Jeffery (1922), Proc. R. Soc. A 102, 161-179, for ellipsoids; Bretherton (1962), J. Fluid Mech. 14, 284-304: any body of revolution turns so,
with an effective aspect ratio r_e. For cylinders r_e = 1.24 r/(ln r)^(1/2), r: length over diameter, by Cox (1971), J. Fluid Mech. 45,
625-657, whose factor is fitted to the periods that Anczurowski and Mason (1968) measured on rods. Noise of a camera is added. Nothing here
comes from Snag. Writes data.csv and the case files.
"""
import math
import pathlib
import random

D, RHO, NU, SAMPLES, REPLICATES, NOISE = 1e-3, 1000.0, 1e-5, 12, 3, 0.02
# r, G 1/s, phi at the start in degrees, share of the period
POINTS = {
    "A": (12, 2.0, 75, 0.32),
    "B": (10, 2.0, 80, 0.34),
    "C": (12, 1.5, 70, 0.34),
    "D": (10, 1.5, 0, 0.25),
    "E": (10, 1.5, 75, 0.34),
    "F": (15, 2.5, 80, 0.30),
    "G": (12, 2.0, 80, 0.32),
}

if __name__ == "__main__":
    here = pathlib.Path(__file__).parent
    dice = random.Random(1922)
    rows = ["point,replicate,t_s,observable,value"]
    for point, (r, shear, start, share) in POINTS.items():
        r_e = 1.24 * r / math.sqrt(math.log(r))
        period = 2 * math.pi / shear * (r_e + 1 / r_e)
        chain = math.sqrt(1 + (r * r - 1) / 2)
        print(f"{point}: r = {r}, r_e = {r_e:.2f}, of a chain of spheres with torque {chain:.2f}, period {period:.1f} s")
        phi, step = math.radians(start), float(f"{share * period / 400:.4g}")
        end = 400 * step
        c = math.atan2(math.sin(phi), r_e * math.cos(phi))
        for replicate in range(1, REPLICATES + 1):
            for i in range(SAMPLES):
                t = end * (i + 1) / SAMPLES
                x = 2 * math.pi * t / period + c
                angle = math.pi / 2 - math.atan2(r_e * math.sin(x), math.cos(x)) + dice.gauss(0, NOISE)
                rows.append(f"{point},{replicate},{t:.4f},orientation,{math.remainder(angle, math.pi):.4f}")
        (here / f"point_{point}.toml").write_text(
            f"""[case]
name = "jeffery-{point}"
description = "A stiff fibre of aspect ratio {r} turns in a shear of {shear} 1/s; the base case has drag on its spheres, but no torque."
[time]
end_s = {400 * step:.7g}
step_s = {step:.5g}
[flow]
kind = "prescribed"
density_kg_m3 = {RHO}
kinematic_viscosity_m2_s = {NU}
gradient_per_s = [[0.0, {shear}, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]
[[fibre]]
length_m = {r * D}
n_points = {r}
density_kg_m3 = {RHO}
youngs_modulus_Pa = {4 * r**4 * NU * RHO * shear:.4g}  # several times that at which shear bends it
shear_modulus_Pa = 1e3
lengthwise = [{math.sin(phi):.7g}, {math.cos(phi):.7g}, 0.0]
[virtual_camera]
right = [1.0, 0.0, 0.0]
up = [0.0, 1.0, 0.0]
[coupling]
mode = "one_way"
forces = ["free_stream_drag"]
"""
        )
    (here / "data.csv").write_text("\n".join(rows) + "\n")
