"""Drag of the plate over the Cauchy number, as SVG: curve.py OUT.svg RUN_DIR... with runs of case.toml and tunnel.toml at several speeds; needs numpy, matplotlib. Lines: the elastica and the
published equation; dots: measured, and runs."""
import pathlib
import sys
import tomllib

import matplotlib
import numpy

matplotlib.use("svg")
import matplotlib.pyplot as plt

here = pathlib.Path(__file__).parent
sys.path[:0] = [str(here.parents[1] / "tests" / "cases"), str(here.parents[1] / "share" / "python")]
import elastica
from snag.tables import read_columns


def of_run(folder):
    """C and R at the end of a run; C_D is that of the case where the stream is prescribed, and that of rigid plates in the tunnel where it is computed."""
    case = tomllib.loads((folder / "case.resolved.toml").read_text())
    names, _, values = read_columns(folder / "monitors" / "holds.csv")
    flow, plate = case["flow"], case["rag"][0]
    two_way = case["coupling"]["mode"] == "two_way"
    speed = (flow["initial_velocity_m_s"] if two_way else flow["velocity_m_s"])[0]
    area = plate["length_m"] * plate["width_m"]
    coefficient = 1.15 + 7.6 * area / 0.18**2 if two_way else case["coupling"]["sheet_drag"]["normal_coefficient"]
    stiffness = plate["bending_stiffness_lengthwise_N_m3"] * numpy.pi * plate["radius_m"] ** 4 / 4
    pressure = coefficient * flow["density_kg_m3"] * speed**2 / 2
    return two_way, pressure * plate["length_m"] ** 3 / (8 * stiffness), -values[-1, names.index("force_x")] / (pressure * area)


out, folders = sys.argv[1], [pathlib.Path(word) for word in sys.argv[2:]]
measured = tomllib.loads((here / "measured.toml").read_text())["plates"]
C = numpy.logspace(-1, 3, 41)
fig, axes = plt.subplots(figsize=(6.2, 3.8))
axes.loglog(measured["C"], measured["R"], ".", color="0.7", markersize=4, label="measured, 20 plates in a tunnel")
axes.loglog(C, [elastica.reconfiguration(c) for c in C], color="#2060b0", label="elastica")
axes.loglog(C, [elastica.published_reconfiguration(c) for c in C], "--", color="#2060b0", linewidth=1, label="equation of the paper")
for two_way, mark, label in ((False, "o", "Snag, one-way"), (True, "D", "Snag, two-way in the tunnel")):
    points = [point[1:] for point in map(of_run, folders) if point[0] == two_way]
    if points:
        axes.loglog(*zip(*points), mark, color="#c03020", markerfacecolor="none" if two_way else None, label=label)
axes.set_xlabel(r"scaled Cauchy number $C = C_D\,\rho L^3 U^2/(16 B)$")
axes.set_ylabel("drag over that of a rigid plate, R")
axes.grid(which="both", linewidth=0.3)
axes.legend(frameon=False)
fig.tight_layout()
fig.savefig(out)
