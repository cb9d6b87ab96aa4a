"""Measurement, base case and base case with the missing effects, point by point:

    /usr/bin/python3 cases/diagnose-sphere/draw.py cases/diagnose-wall OUT.png wall.strength=1.03
    /usr/bin/python3 cases/diagnose-sphere/draw.py cases/diagnose-settling OUT.png added_mass.coefficient=0.73 history.strength=0.6

Needs numpy, matplotlib and, for orientations, vtk. Runs ./snag (or the program that SNAG names) for each curve.
"""
import csv
import os
import pathlib
import subprocess
import sys
import tempfile
import tomllib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
PER_UNIT = {"m": 1, "mm": 1e-3, "m/s": 1, "mm/s": 1e-3, "rad": 1}


def angle_of_pieces(folder):
    """Direction of the first piece in the x-y plane over time: (t, angle)."""
    from vtk import vtkXMLPolyDataReader
    from vtk.util.numpy_support import vtk_to_numpy

    angles = []
    for file in sorted((folder / "rags").glob("particles_*.vtp")):
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(file))
        reader.Update()
        x = vtk_to_numpy(reader.GetOutput().GetPoints().GetData())
        chord = x[-1] - x[0]
        angles.append(np.arctan2(chord[1], chord[0]))
    return np.unwrap(angles, period=np.pi)


def curve(case, observable, settings):
    with tempfile.TemporaryDirectory() as work:
        end = tomllib.loads(case.read_text())["time"]["end_s"]
        step = tomllib.loads(case.read_text())["time"]["step_s"]
        frames = 40
        words = [w for s in [*settings, "output.report=false", f"output.rags_interval_s={round(end / frames / step) * step!r}"] for w in ("--set", s)]
        subprocess.run([os.environ.get("SNAG", ROOT / "snag"), "run", case, "--out", pathlib.Path(work) / "run", *words], check=True, capture_output=True)
        if observable == "orientation":
            values = angle_of_pieces(pathlib.Path(work) / "run")
            return np.linspace(0, end, len(values)), values
        with open(pathlib.Path(work) / "run" / "monitors" / "rags.csv") as file:
            rows = [{k.split(" ")[0]: float(v) for k, v in row.items()} for row in csv.DictReader(file)]
        return np.array([r["time"] for r in rows]), np.array([r[observable] for r in rows])


def main():
    folder, out = pathlib.Path(sys.argv[1]), sys.argv[2]
    diagnosis = tomllib.loads((folder / "DIAGNOSIS.toml").read_text())
    units = {o["id"]: o["unit"] for o in diagnosis["observable"]}
    rows = list(csv.DictReader(open(folder / diagnosis["experiment"]["data"])))
    panels = [(p, o) for p in diagnosis["point"] for o in units if any(r["point"] == p["id"] and r["observable"] == o for r in rows)]
    columns = min(4, len(panels))
    lines = -(-len(panels) // columns)
    figure, axes = plt.subplots(lines, columns, figsize=(3.4 * columns, 2.7 * lines), squeeze=False)
    for axis in axes.flat[len(panels):]:
        axis.axis("off")
    for axis, (point, observable) in zip(axes.flat, panels):
        case = folder / point["case"]
        forces = tomllib.loads(case.read_text())["coupling"]["forces"]
        names = forces + [s.split(".")[0] for s in sys.argv[3:]]
        with_effects = ["coupling.forces=[" + ", ".join(f'"{n}"' for n in dict.fromkeys(names)) + "]"] + ["coupling." + s for s in sys.argv[3:]]
        u = PER_UNIT[units[observable]]
        for settings, style, label in (([], "--", "base case"), (with_effects, "-", "with " + ", ".join(s.split(".")[0] for s in sys.argv[3:]))):
            if style == "-" and not sys.argv[3:]:
                continue
            t, values = curve(case, observable, settings)
            axis.plot(t, values / u, style, color="0.5" if style == "--" else "C0", label=label)
        own = [(float(r["t_s"]), float(r["value"])) for r in rows if r["point"] == point["id"] and r["observable"] == observable]
        times = sorted({t for t, _ in own})
        axis.plot(times, [np.mean([v for s, v in own if s == t]) for t in times], "k.", ms=4, label="measured")
        axis.set_title(point["id"] + (", withheld" if point["role"] == "withheld" else ""), fontsize=9)
        axis.set_xlabel("t, s", fontsize=8)
        axis.set_ylabel(f"{observable}, {units[observable]}", fontsize=8)
        axis.tick_params(labelsize=7)
    axes.flat[0].legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(out, dpi=80)


main()
