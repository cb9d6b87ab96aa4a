"""Discs that are cut along radii, as SVG: discs.py OUT.svg RUN_DIR... with runs of the cases that tests/cases/cut_disc.py writes, in a prescribed stream or (reconfiguration_long.py) in the tunnel; needs numpy,
matplotlib, vtk. Left: drag of the sectors over that of rigid ones, in the tunnel with the hub and over the last third; runs, elastica (lines) and measured points. Right: the discs of the runs at their end, seen
obliquely; the stream comes from above."""
import math
import pathlib
import sys
import tomllib

import matplotlib
import numpy
from vtk import vtkXMLPolyDataReader
from vtk.util.numpy_support import vtk_to_numpy

matplotlib.use("svg")
import matplotlib.pyplot as plt
from matplotlib.collections import PolyCollection

here = pathlib.Path(__file__).parent
sys.path[:0] = [str(here.parents[1] / "tests" / "cases"), str(here.parents[1] / "share" / "python")]
import elastica
from snag.tables import read_columns

MEASURED = tomllib.loads((here / "measured.toml").read_text())
COLOURS = {"D1": "#2060b0", "D3": "#c03020", "D4": "#207040"}
HUB = 0.009  # m


class Run:
    def __init__(self, folder):
        case = tomllib.loads((folder / "case.resolved.toml").read_text())
        disc, flow = case["disc"][0], case["flow"]
        self.two_way = case["coupling"]["mode"] == "two_way"
        self.radius, particle = disc["diameter_m"] / 2, disc["radius_m"]
        velocity = numpy.abs(flow["initial_velocity_m_s" if self.two_way else "velocity_m_s"])
        stream = velocity.argmax()
        coefficient = MEASURED["disc_D4" if self.radius > 0.04 else "disc_D1"]["C_D"] if self.two_way else case["coupling"]["sheet_drag"]["normal_coefficient"]
        pressure = coefficient * flow["density_kg_m3"] * velocity[stream] ** 2 / 2
        stiffness = disc["bending_stiffness_lengthwise_N_m3"] * math.pi * particle**4 / 4
        self.C = self.radius / HUB * pressure * (self.radius - HUB) ** 3 / stiffness
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(sorted((folder / "rags").glob("rags_*.vtp"))[-1]))
        reader.Update()
        sheet = reader.GetOutput()
        places = vtk_to_numpy(sheet.GetPoints().GetData()) - [disc["centre_m"]]
        self.places = numpy.roll(places, 2 - stream, axis=1)  # the stream along the last axis
        self.corners = vtk_to_numpy(sheet.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        hub = math.pi * HUB**2
        if self.two_way:
            names, _, values = read_columns(folder / "monitors" / "holds.csv")
            force = -values[:, names.index(f"force_{'xyz'[stream]}")]
            self.R = force[-len(force) // 3 :].mean() / (pressure * math.pi * self.radius**2)
            return
        names, _, values = read_columns(folder / "monitors" / "coupling.csv")
        self.R = (values[-1, names.index("force_on_rags_z")] / pressure - hub) / (4 * particle**2 * len(self.places) - hub)

    def name(self):
        return "D4" if self.radius > 0.04 else "D3" if self.C > 200 else "D1"


def draw(axes, run, tilt=math.radians(20)):
    """Triangles from the far to the near ones, the lighter the more they face the viewer, who looks down by `tilt`."""
    x, y, z = run.places.T * 1e3
    seen = numpy.stack([x, -z * math.cos(tilt) + y * math.sin(tilt)], axis=1)
    depth = (y * math.cos(tilt) + z * math.sin(tilt))[run.corners].mean(axis=1)
    a, b, c = (run.places[run.corners[:, i]] for i in range(3))
    normal = numpy.cross(b - a, c - a)
    facing = numpy.abs(normal @ [0.3, math.cos(tilt) * 0.95, math.sin(tilt) * 0.95]) / numpy.linalg.norm(normal, axis=1)
    order = numpy.argsort(-depth)
    shade = 0.35 + 0.6 * facing[order]
    axes.add_collection(PolyCollection(seen[run.corners[order]], facecolors=numpy.repeat(shade[:, None], 3, axis=1), edgecolors="face", linewidths=0.2, rasterized=True))
    axes.set_xlim(-52, 52), axes.set_ylim(-46, 22), axes.set_aspect("equal"), axes.axis("off")
    axes.text(-50, 16, f"{run.name()}, C = {run.C:.0f}", fontsize=9)


out, runs = sys.argv[1], sorted((Run(pathlib.Path(word)) for word in sys.argv[2:]), key=lambda run: run.C)
fig = plt.figure(figsize=(9, 4.2))
axes = fig.add_axes((0.075, 0.13, 0.5, 0.84))
for name, colour in COLOURS.items():
    points = MEASURED[f"disc_{name}"]
    axes.loglog(points["C"], points["R"], ".", color=colour, alpha=0.4, label=f"{name} measured, in a tunnel")
C = numpy.logspace(0, 3, 61)
for radius, style in ((0.037, "-"), (0.050, "--")):
    axes.loglog(C, [elastica.reconfiguration(c, taper=radius / HUB) for c in C], style, color="0.3", linewidth=1, label=f"elastica, R/R$_i$ = {radius / HUB:.1f}")
for run in runs:
    axes.loglog(run.C, run.R, "D" if run.two_way else "s", color=COLOURS[run.name()], markersize=7, markerfacecolor="none", label=f"{run.name()}, Snag{', two-way in the tunnel' if run.two_way else ''}")
    points = MEASURED[f"disc_{run.name()}"]
    exact = numpy.exp(numpy.interp(numpy.log(run.C), numpy.log(points["C"]), numpy.log(points["R"]))) if run.two_way else elastica.reconfiguration(run.C, taper=run.radius / HUB)
    print(f"{run.name()}: C {run.C:.1f}, R {run.R:.4f}, {'measured' if run.two_way else 'elastica'} {exact:.4f}, deviation {100 * (run.R / exact - 1):+.1f} %")
axes.set_xlabel("scaled Cauchy number C"), axes.set_ylabel("drag over that of a rigid disc, R")
axes.grid(which="both", linewidth=0.3)
handles, labels = axes.get_legend_handles_labels()
unique = dict(zip(labels, handles))
axes.legend(unique.values(), unique.keys(), frameon=False, fontsize=8)
for k, run in enumerate(runs[-3:]):
    draw(fig.add_axes((0.6, 0.67 - 0.325 * k, 0.4, 0.32)), run)
fig.savefig(out, dpi=150)
