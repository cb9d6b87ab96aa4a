"""Path, drag, lag and impulse over the kernel width: draw.py FOLDER OUT.svg, FOLDER with the studies sphere, plate-fine, rag and pump. Needs pandas, matplotlib."""
import pathlib, sys
import matplotlib
matplotlib.use("svg")
import matplotlib.pyplot as plt, pandas

folder, out = map(pathlib.Path, sys.argv[1:3])
STREAM, TIME = 1.0, 0.064  # of the rag: m/s, s
PANELS = (("sphere", "Path of a sinking sphere [mm]", "diameter", lambda s: 1e3 * s["rags.0.before_contact.path_m"]),
          ("plate-fine", "Drag of a held sheet [N]", "radius_mm", lambda s: s["rags.0.before_contact.mean_force_N.0"]),
          ("rag", "Lag of a free rag behind the stream [mm]", "radius_mm", lambda s: 1e3 * (STREAM * TIME - s["rags.0.before_contact.path_m"])),
          ("pump", "Impulse on the demo's rag [mN s]", "radius", lambda s: 1e3 * s["rags.0.before_contact.impulse_N_s.2"]))
plt.rcParams.update({"font.size": 8, "svg.hashsalt": "snag"})
figure, axes = plt.subplots(2, 2, figsize=(8, 6), layout="constrained")
for panel, (name, title, size, value) in zip(axes.flat, PANELS):
    study = pandas.read_csv(folder / name / "study.csv")
    study.columns = [c.split(" [")[0] for c in study.columns]
    size = next(c for c in study.columns if c.split(".")[-1] == size)
    kernel = next((c for c in study.columns if c.split(".")[-1] == "kernel"), "kernel")
    if kernel not in study:
        study[kernel] = "gaussian"
    kernels, meshes, sizes = (list(study[c].unique()) for c in (kernel, "mesh", size))
    for (kind, mesh, particle), runs in study.groupby([kernel, "mesh", size], sort=False):
        is_fine, is_large = mesh == meshes[-1], particle == sizes[-1]
        panel.plot(runs["width"], value(runs), ls="--" if is_fine else "-", marker="s" if is_large else "o", color=f"C{kernels.index(kind)}", ms=3.5, lw=1, mfc="none" if is_fine else None,
                   label=kind if not is_fine and not is_large else None)
    for particle, marker in zip(sizes, "os"):
        panel.plot([], [], marker, color="grey", ms=3.5, label=f"{particle:g} mm")
    panel.set_title(title), panel.set_xscale("log"), panel.set_ylim(0, 1.05 * panel.get_ylim()[1]), panel.grid(alpha=0.3), panel.legend(fontsize=6)
    ticks = sorted(study["width"].unique())
    panel.set_xticks(ticks, [f"{t:g}" for t in ticks]), panel.minorticks_off(), panel.set_xlabel("kernel width [mm]")
figure.savefig(out, metadata={"Date": None})
