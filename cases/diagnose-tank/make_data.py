"""The measurement of this example: a nylon sphere of 15 mm that settles in a tank of silicone oil and comes to the floor.

ten Cate, Nieuwstad, Derksen and van den Akker (2002), Particle imaging velocimetry experiments and lattice-Boltzmann simulations on a
single sphere settling under gravity, Phys. Fluids 14, 4012-4025. Tank 100 x 100 x 160 mm, density of the sphere 1120 kg/m3, released from
rest with its lowest point 120 mm above the floor (p. 4013). Oils: table I. Largest velocity over that in infinite oil: table II, column
experiment, times the velocity by Abraham's drag law that the table uses.

Points of the figures as others read them off the printed curves: the path of E1 (fig. 5a) from SedFoam, tutorialsDyM/Py/DATA/
tenCate2002displacementRe1.5.csv, the velocity of E4 (fig. 5b) from GeoTaichi, examples/cfdem/SemiResolved/SphereFallingOil/experiment.csv.
The velocity of E1 in the first of these is 4 to 6 % above table II and is left out. Writes data.csv and the case files.
"""
import pathlib

G, D, DENSITY, START, TANK = 9.81, 0.015, 1120.0, 0.1275, (0.1, 0.1, 0.16)
# density and viscosity (Pa s) of the oil, end s
POINTS = {"E1": (970, 0.373, 4.2), "E2": (965, 0.212, 2.0), "E3": (962, 0.113, 1.5), "E4": (960, 0.058, 1.2)}
# Time within the plateau, s, and velocity, m/s: 0.947 0.03829, 0.953 0.05992, 0.959 0.09062; that of E4 is in its curve.
LARGEST = {"E1": (1.9, 0.0363), "E2": (1.5, 0.0571), "E3": (1.15, 0.0869)}
# E1: t s, height of the lowest point over the diameter
PATH = """0.0844 8.022 0.2328 7.794 0.3601 7.544 0.4664 7.253 0.5939 6.941 0.7424 6.650 0.9121 6.339 1.0609 5.923 1.1989 5.632 1.5598 4.842
1.7191 4.488 1.8466 4.155 2.0060 3.760 2.1546 3.427 2.3138 3.074 2.4414 2.741 2.5688 2.429 2.9399 1.785 3.1312 1.307 3.3223 0.870
3.5025 0.559 3.6616 0.289 3.8308 0.145"""
# E4: t s, velocity mm/s
VELOCITY = """0.0702 37.32 0.0902 47.20 0.1002 50.49 0.1203 57.62 0.1403 62.01 0.1504 64.76 0.1671 67.50 0.1804 75.18 0.2005 79.02 0.2072 82.32
0.2272 83.41 0.2439 86.71 0.2640 91.10 0.2706 93.84 0.2907 96.59 0.3107 100.98 0.3241 99.88 0.4745 111.40 0.5313 113.05 0.5446 115.79
0.6081 118.54 0.6616 120.18 0.8053 121.28 0.8554 122.38 0.9021 122.93 0.9489 122.93 0.9857 122.93 1.0959 122.93 1.1227 121.83 1.1394 120.73"""

here = pathlib.Path(__file__).parent
pairs = lambda text: [tuple(map(float, p)) for p in zip(text.split()[::2], text.split()[1::2])]
rows = ["point,replicate,t_s,observable,value"]
rows += [f"E1,1,{t:.4f},z,{1e3 * D * (h + 0.5):.3f}" for t, h in pairs(PATH)]
rows += [f"{point},1,{t:.4f},vz,{-1e3 * v:.2f}" for point, (t, v) in LARGEST.items()]
rows += [f"E4,1,{t:.4f},vz,{-v:.2f}" for t, v in pairs(VELOCITY)]
(here / "data.csv").write_text("\n".join(rows) + "\n")
for point, (rho, mu, end) in POINTS.items():
    (here / f"point_{point}.toml").write_text(
        f"""[case]
name = "tank-{point}"
description = "A sphere settles in a tank and comes to the floor; drag and weight only: no added mass, no history, no drag by walls."
[time]
end_s = {end}
step_s = 0.002
[gravity]
acceleration_m_s2 = [0, 0, -{G}]
[flow]
kind = "prescribed"
density_kg_m3 = {rho}
dynamic_viscosity_Pa_s = {mu}
[[wall]]
kind = "plane"                                     # floor
point_m = [0, 0, 0]
normal = [0, 0, 1]
[[wall]]
kind = "plane"                                     # sides
point_m = [{-TANK[0] / 2}, 0, 0]
normal = [1, 0, 0]
[[wall]]
kind = "plane"
point_m = [{TANK[0] / 2}, 0, 0]
normal = [-1, 0, 0]
[[wall]]
kind = "plane"
point_m = [0, {-TANK[1] / 2}, 0]
normal = [0, 1, 0]
[[wall]]
kind = "plane"
point_m = [0, {TANK[1] / 2}, 0]
normal = [0, -1, 0]
[[particle]]
diameter_m = {D}
density_kg_m3 = {DENSITY}
shear_modulus_Pa = 1e5
position_m = [0.0, 0.0, {START}]
[coupling]
mode = "one_way"
forces = ["schiller_naumann"]
"""
    )
