"""Growth and shapes of a flag, as SVG: flutter.py OUT.svg RUN_DIR... with runs of flag.toml at several speeds; needs numpy, vtk, matplotlib. Left: growth of the oscillation against the linear theory (its first
0.5 s, or until the centre of the flag moves by 1 % of the length); right: shapes over the last period of the fastest run."""
import pathlib
import sys
import tomllib

import matplotlib
import numpy

matplotlib.use("svg")
import matplotlib.pyplot as plt
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

here = pathlib.Path(__file__).parent
sys.path[:0] = [str(here.parents[1] / "tests" / "cases"), str(here.parents[1] / "share" / "python")]
import flag_theory
from snag.tables import read_columns

theory = flag_theory.Flag()
MASS = 1  # over that of the fluid


def of_run(folder):
    """Speed, m/s, stiffness beta, and observed sigma U/L, 1/s."""
    case = tomllib.loads((folder / "case.resolved.toml").read_text())
    names, _, values = read_columns(folder / "monitors" / "rags.csv")
    time, y = values[:, names.index("time")], values[:, names.index("y")] - case["rag"][0]["centre_m"][1]
    flag, speed = case["rag"][0], case["flow"]["initial_velocity_m_s"][0]
    length = flag["length_m"]
    beta = flag["bending_stiffness_lengthwise_N_m3"] * numpy.pi * flag["radius_m"] ** 4 / 4 / (case["flow"]["density_kg_m3"] * speed**2 * length**3)
    large = numpy.flatnonzero(abs(y) > 0.01 * length)
    part = (time > 3 * length / speed) & (time < (time[large[0]] if len(large) else 0.5))
    return speed, beta, flag_theory.observed_mode(time[part] * speed / length, y[part], theory.flutter_mode(MASS, beta).imag) * speed / length


def shape(file):
    """x, y along the first row."""
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(file))
    reader.Update()
    places = vtk_to_numpy(reader.GetOutput().GetPoints().GetData())
    return places[: len(places) // 2, :2]


out, folders = sys.argv[1], [pathlib.Path(word) for word in sys.argv[2:]]
runs = sorted((of_run(folder), folder) for folder in folders)
fig, (growth, shapes) = plt.subplots(1, 2, figsize=(8.6, 3.3))
(speed, beta, _), fastest = runs[-1]
speeds = numpy.linspace(2.2, 4.2, 41)
sigma = [theory.flutter_mode(MASS, beta * (speed / u) ** 2) * u / 0.1 for u in speeds]
growth.axhline(0, color="0.6", linewidth=0.8)
growth.plot(speeds, numpy.real(sigma), color="#2060b0", label="theory")
growth.plot([run[0][0] for run in runs], [run[0][2].real for run in runs], "o", color="#c03020", label="Snag, two-way")
growth.set_xlabel("speed of the stream, m/s")
growth.set_ylabel("growth, 1/s")
growth.grid(linewidth=0.3)
growth.legend(frameon=False)
files = sorted((fastest / "rags").glob("particles_*.vtp"))
interval = tomllib.loads((fastest / "case.resolved.toml").read_text())["output"]["rags_interval_s"]
for file in files[-round(2 * numpy.pi / runs[-1][0][2].imag / interval) :]:
    places = shape(file)
    shapes.plot(1e3 * (places[:, 0] - places[0, 0]), 1e3 * (places[:, 1] - places[0, 1]), color="#c03020", linewidth=1)
shapes.set_aspect("equal")
shapes.set_ylim(-35, 35)
shapes.set_xlabel(f"mm; one period at {speed:g} m/s")
shapes.set_ylabel("mm")
shapes.grid(linewidth=0.3)
fig.tight_layout()
fig.savefig(out)
for (u, beta, found), _ in runs:
    print(f"{u:g} m/s, stiffness {beta:.4f}: growth {found.real:+.2f}/s, {found.imag / (2 * numpy.pi):.2f} Hz; theory {theory.flutter_mode(MASS, beta).real * u / 0.1:+.2f}/s, {theory.flutter_mode(MASS, beta).imag * u / 0.1 / (2 * numpy.pi):.2f} Hz")
