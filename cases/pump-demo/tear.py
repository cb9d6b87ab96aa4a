"""Strain of the cloth and torn bonds over time: tear.py OUT.svg FOLDER=NAME..., folders of runs with breakage. Needs pandas, matplotlib."""
import pathlib, sys
import matplotlib
matplotlib.use("svg")
import matplotlib.pyplot as plt, pandas

TEARS = 0.26, 0.36  # strain at which the cloth tears, across and along
out, *runs = sys.argv[1:]
plt.rcParams.update({"font.size": 8, "svg.hashsalt": "snag"})
figure, axes = plt.subplots(1, len(runs), figsize=(4.6 * len(runs), 2.9), layout="constrained", squeeze=False)
for panel, run in zip(axes.flat, runs):
    folder, name = run.split("=")
    rags = pandas.read_csv(pathlib.Path(folder) / "monitors" / "rags.csv", comment="#")
    rags.columns = [c.split(" [")[0] for c in rags.columns]
    time, all_bonds = rags["time"] - rags["time"][0], 8120
    panel.axhspan(*TEARS, color="0.9"), panel.text(0.01 * time.iloc[-1], 0.305, "tears", fontsize=7)
    panel.plot(time, rags["bond_strain_p99"], lw=0.7, label="strain that 99 % of the bonds do not exceed")
    panel.plot(time, rags["broken_bonds"] / all_bonds, lw=1.2, label="torn bonds over all bonds")
    panel.set_title(name), panel.set_xlabel("time since the rag was put in [s]"), panel.set_ylim(0, 0.46), panel.grid(alpha=0.3), panel.legend(fontsize=6.5, loc="upper right")
figure.savefig(out, metadata={"Date": None})
