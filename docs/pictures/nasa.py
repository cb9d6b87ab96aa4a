"""Pictures of the k-omega SST model on the cases of NASA's Turbulence Modeling Resource, as SVG: nasa.py PICTURE OUT.svg, PICTURE one of step, bump, plate, with SNAG_BINARY_DIR set. Runs the long test of
the case (tests/verification/solver/) in the build folder, and draws what it prints beside nasa_turbulence.toml; needs numpy, matplotlib. Takes one to five minutes a picture. nasa.py PICTURE OUT.svg LOG draws
what that test has printed to a file."""
import collections
import os
import pathlib
import subprocess
import sys
import tomllib

import matplotlib
import numpy

matplotlib.use("svg")
import matplotlib.pyplot as plt

BLUE, RED, GREY = "#2060b0", "#c03020", "0.2"
MEASURED = {"marker": "o", "linestyle": "none", "markersize": 3.5, "markerfacecolor": "none", "color": GREY}
CFL3D = {"color": RED, "linewidth": 1, "linestyle": "--"}
FUN3D = {"color": GREY, "linewidth": 1, "linestyle": ":"}
SNAG = {"color": BLUE, "linewidth": 1.3}
TESTS = {"step": "NasaStepFine", "bump": "NasaBumpFine", "plate": "FlatPlateFine"}
NASA = tomllib.loads((pathlib.Path(__file__).parent / "nasa_turbulence.toml").read_text())


def tables(name, log):
    """Rows by table and grid."""
    if log is None:
        program = pathlib.Path(os.environ["SNAG_BINARY_DIR"]) / "tests" / "verification_solver"
        text = subprocess.run([program, f"--gtest_filter={TESTS[name]}.*"], check=True, capture_output=True, text=True).stdout
    else:
        text = pathlib.Path(log).read_text()
    rows = collections.defaultdict(list)
    for line in text.splitlines():
        words = line.split()
        if words and words[0].startswith(name + "-"):
            rows[words[0].removeprefix(name + "-"), int(words[1])].append([float(word) for word in words[2:]])
    return {key: numpy.array(value) for key, value in rows.items()}


def finish(axes, x, y):
    axes.set_xlabel(x), axes.set_ylabel(y)
    axes.grid(alpha=0.3)


def step(found):
    case = NASA["backward_step"]
    grids = sorted({m for table, m in found if table == "floor"})
    figure = plt.figure(figsize=(11, 6.4), layout="constrained")
    above, below = figure.subfigures(2, 1)
    friction, pressure = above.subplots(1, 2)
    measured = case["cf_lower"]
    friction.errorbar(measured["x"], measured["cf"], measured["uncertainty"], elinewidth=0.7, label="measured", **MEASURED)
    friction.plot(measured["x"], measured["cf_sst_cfl3d"], label="CFL3D, SST", **CFL3D)
    measured = case["cp_lower"]
    pressure.plot(measured["x"], measured["cp"], label="measured", **MEASURED)
    pressure.plot(measured["x"], measured["cp_sst_cfl3d"], label="CFL3D, SST", **CFL3D)
    for m in grids:
        style = SNAG if m == grids[-1] else {"color": BLUE, "linewidth": 0.7, "alpha": 0.5}
        label = "Snag, three grids" if m == grids[-1] else None
        floor, upstream = found["floor", m], found["upstream", m]
        near = upstream[:, 0] > -6
        friction.plot(upstream[near, 0], upstream[near, 1], **style)
        friction.plot(floor[:, 0], floor[:, 1], label=label, **style)
        pressure.plot(floor[:, 0], floor[:, 2], label=label, **style)
    for axes in (friction, pressure):
        axes.set_xlim(-6, 38)
        axes.legend(fontsize=8, loc="lower right")
    finish(friction, "x/H", "$c_f$ of the floor"), finish(pressure, "x/H", "$c_p$ of the floor, 0 at x/H = 37.5")
    friction.set_ylim(-0.0025, 0.004)
    for axes, profile in zip(below.subplots(1, len(case["profile"]), sharey=True), case["profile"]):
        x = profile["x"]
        axes.plot(profile["u"], profile["y"], label="measured", **MEASURED)
        axes.plot(profile["u_sst_cfl3d"], profile["y"], label="CFL3D, SST", **CFL3D)
        rows = found["profile", grids[-1]]
        rows = rows[rows[:, 0] == x]
        axes.plot(rows[:, 2], rows[:, 1], label="Snag", **SNAG)
        axes.set_title(f"x/H = {x}", fontsize=9)
        axes.set_ylim(0, 4)
        finish(axes, "$u/U$", "y/H" if x == -4 else "")
    axes.legend(fontsize=8, loc="upper left")


def convergence(axes, cells, values, sizes, found, quantity):
    """Values of the grids of NASA's codes and of Snag over h, (cells of the finest over cells)^(1/2)."""
    finest = cells[0]
    for name, style in (("cfl3d", CFL3D), ("fun3d", FUN3D)):
        axes.plot(numpy.sqrt(finest / numpy.array(cells)), values[name], marker=".", label=name.upper(), **style)
    axes.plot(numpy.sqrt(finest / numpy.array(sizes)), found, marker="o", markersize=4, label="Snag", **SNAG)
    axes.set_xlim(0, 9)
    finish(axes, "thickness of cells, finest of NASA's = 1", quantity)


def bump(found):
    case, cells = NASA["bump"], [901120, 225280, 56320, 14080, 3520]
    grids = sorted({m for _, m in found})
    figure, axes = plt.subplots(2, 3, figsize=(11, 6.4), layout="constrained")
    for m in grids:
        style = SNAG if m == grids[-1] else {"color": BLUE, "linewidth": 0.7, "alpha": 0.5}
        wall = found["wall", m]
        axes[0, 0].plot(wall[:, 0], wall[:, 1], label=f"Snag, {3520 * m * m} cells", **style)
        axes[0, 1].plot(wall[:, 0], wall[:, 2], **style)
    places = {0.6321975: "cf_at_0_6321975", 0.75: "cf_at_0_75", 0.8678025: "cf_at_0_8678025"}
    for name, colour in (("cfl3d", RED), ("fun3d", GREY)):
        axes[0, 0].plot(list(places), [case[name][key][0] for key in places.values()], "+" if name == "cfl3d" else "x", color=colour, label=name.upper() + ", SST")
    axes[0, 0].set_ylim(0, 0.008)
    axes[0, 0].legend(fontsize=7)
    finish(axes[0, 0], "x", "$c_f$"), finish(axes[0, 1], "x", "$c_p$")
    axes[0, 1].invert_yaxis()
    x = numpy.linspace(0, 1.5, 301)
    axes[0, 2].plot(x, numpy.where((x > 0.3) & (x < 1.2), 0.05 * numpy.sin(numpy.pi * x / 0.9 - numpy.pi / 3) ** 4, 0), color=GREY)
    axes[0, 2].set_ylim(-0.1, 0.4)
    finish(axes[0, 2], "x", "y of the wall")
    for place, (at, key) in zip(axes[1], places.items()):
        friction = [numpy.interp(at, found["wall", m][:, 0], found["wall", m][:, 1]) for m in grids]
        convergence(place, cells, {name: case[name][key] for name in ("cfl3d", "fun3d")}, [3520 * m * m for m in grids], friction, f"$c_f$ at x = {at:.3f}")
        place.legend(fontsize=7)


def plate(found):
    case = NASA["flat_plate"]
    grids = sorted({m for _, m in found})
    figure, (friction, law, grid) = plt.subplots(1, 3, figsize=(11, 3.6), layout="constrained")
    wall = found["wall", grids[-1]]
    friction.plot(case["wall_cf_cfl3d"]["x"], case["wall_cf_cfl3d"]["cf"], "+", color=RED, label="CFL3D, SST")
    friction.plot(wall[:, 0], wall[:, 1], label=f"Snag, {816 * grids[-1] ** 2} cells", **SNAG)
    friction.set_ylim(0.002, 0.005)
    friction.legend(fontsize=8)
    finish(friction, "x", "$c_f$")
    profile = found["profile", grids[-1]]
    wall = case["law_of_the_wall_x_0_97"]
    law.semilogx(10 ** numpy.array(wall["log10_y_plus"]), wall["u_plus"], "+", color=RED, label="CFL3D, SST")
    law.semilogx(profile[:, 0], profile[:, 1], label="Snag", **SNAG)
    law.legend(fontsize=8)
    finish(law, "$y^+$ at x = 0.97", "$u^+$")
    values = {name: case[name]["cf_at_x_0_97"] for name in ("cfl3d", "fun3d")}
    found_friction = [numpy.interp(0.97, found["wall", m][:, 0], found["wall", m][:, 1]) for m in grids]
    convergence(grid, case["cfl3d"]["cells"], values, [816 * m * m for m in grids], found_friction, "$c_f$ at x = 0.97")
    grid.legend(fontsize=8)


if __name__ == "__main__":
    name, out = sys.argv[1:3]
    {"step": step, "bump": bump, "plate": plate}[name](tables(name, sys.argv[3] if len(sys.argv) > 3 else None))
    plt.savefig(out, metadata={"Date": None})
