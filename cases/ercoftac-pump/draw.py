"""Velocity at four instants, pressure on the casing and, of runs in three dimensions, velocity over the span, against measurement, as SVG: draw.py OUT.svg START_S RUN_DIR...; fields from START_S on. Needs numpy, vtk, matplotlib."""
import pathlib
import sys

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

import sample

out, start, folders = sys.argv[1], float(sys.argv[2]), sys.argv[3:]
radii, cp = sample.measured_casing()
measured = sample.measured_midspan()
runs = {pathlib.Path(folder).name: sample.Sampled(folder, start, radii=radii) for folder in folders}
colours = ("#c03020", "#2060b0", "#208040")
over_span = {name: run for name, run in runs.items() if not run.is_plane}
rows = 4 if over_span else 3
fig, axes = plt.subplots(rows, 2, figsize=(8.2, 2.53 * rows))
for axis, instant in zip(axes.flat, sample.INSTANTS):
    y, cr, cu = (values[::2] for values in measured[instant])
    axis.plot(y, cu, ".", color="0.55", markersize=3, label="hot wires, mid-span")
    axis.plot(y, cr, ".", color="0.75", markersize=3)
    for colour, (name, run) in zip(colours, runs.items()):
        axis.plot(sample.Y, run.profile[instant][0][1], color=colour, linewidth=1.2, label=name)
        axis.plot(sample.Y, run.profile[instant][0][0], color=colour, linewidth=0.8)
    axis.set_title(f"$t/T_i$ = {instant}", fontsize=9)
    axis.set_xlim(0, 2)
    axis.set_ylim(-0.1, 0.95)
    axis.set_xlabel("y, pitches of the impeller")
    axis.set_ylabel("$c_u/U_2$ (above), $c_r/U_2$ (below)", fontsize=8)
    axis.grid(linewidth=0.3)
axes[0, 0].legend(frameon=False, fontsize=7, loc="upper right")
pressure, difference = axes[2]
pressure.plot(radii, cp, "o", color="0.4", markersize=4, label="taps in the front casing")
for colour, (name, run) in zip(colours, runs.items()):
    error, reference = sample.casing_difference(run, cp)
    pressure.plot(radii, run.cp - reference, color=colour, label=name)
    difference.plot(radii, error, "o-", color=colour, markersize=3)
pressure.set_ylabel("$c_p$, reference fitted")
pressure.legend(frameon=False, fontsize=8)
difference.set_ylabel("$c_p$ of the run less measured")
difference.axhspan(-0.05, 0.05, color="0.93")
for axis in axes[2]:
    axis.set_xlabel("$r/R_2$")
    axis.grid(linewidth=0.3)
if over_span:
    z_over_b, *measured_means = sample.measured_span()
    for axis, mean, word in zip(axes[3], measured_means, ("cr", "cu")):
        axis.plot(mean, z_over_b, "o", color="0.4", markersize=4, label="hot wires")
        for colour, (name, run) in zip(colours, runs.items()):
            if name in over_span:
                axis.plot(getattr(run, f"span_{word}"), z_over_b, color=colour, label=name)
        axis.set_xlabel(f"$c_{word[1]}/U_2$, mean of circumference and time")
        axis.set_ylabel("$z/b$, 0 at the hub")
        axis.set_ylim(0, 1)
        axis.grid(linewidth=0.3)
    axes[3, 0].legend(frameon=False, fontsize=8, loc="lower left")
fig.tight_layout()
fig.savefig(out)
