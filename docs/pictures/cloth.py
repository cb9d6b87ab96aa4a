"""Pictures of the validation of cloth in water, as SVG: cloth.py PICTURE OUT.svg, PICTURE one of forced, layers, turning, spheres, bending, choices, limits, with SNAG_BINARY_DIR and SNAG_SOURCE_DIR set. Runs the cases
of tests/cases and the test programs of the build folder (for turning, bending and limits), and draws what they find over exact solutions, theories and models; needs numpy, matplotlib, vtk. Takes one to five
minutes a picture.

Three kinds of runs are too long for that; what they found lies beside this script:
  cloth-channel.csv        nearly closed cloth across a channel: cloth.py channel cloth-channel.csv (ten minutes)
  cloth-kernels.txt        what tests/cases/plate_across_long.py PlateAcrossLong.test_any_resistance_kernel_and_step prints (ten minutes)
  cloth-sphere-drag.txt    what tests/cases/sphere_drag_long.py prints (half an hour)"""
import ast
import contextlib
import math
import pathlib
import re
import subprocess
import sys

import matplotlib
import numpy

matplotlib.use("svg")
import matplotlib.pyplot as plt

HERE = pathlib.Path(__file__).parent
sys.path.insert(0, str(HERE.parents[1] / "tests" / "cases"))
import blade_long
import co_rotation
import elastica
import flag
import harness
import held
import impulsive_sheet
import impulsive_sheet_long
import inclined_plate
import independence
import plate_across
import reconfiguration
import sedimenting_sheet_long
import sphere_drag
import stuart_loop
import strip_over_edge

BLUE, GREEN, RED, GREY = "#2060b0", "#207040", "#c03020", "0.2"
CIRCLES = {"marker": "o", "linestyle": "none", "markersize": 4, "markerfacecolor": "none"}
PLATE = """
[case]
name = "plate"
[time]
end_s = 1e-6
step_s = 1e-6
[flow]
kind = "prescribed"
density_kg_m3 = 1000
dynamic_viscosity_Pa_s = {viscosity!r}
velocity_m_s = {velocity}
[[rag]]
length_mm = 100
width_mm = 80
radius_mm = 1
[[hold]]
rows = [0, 39]
[coupling]
mode = "one_way"
forces = ["sheet_drag"]
[coupling.sheet_drag]
form = "viscous"
[output]
report = false
"""


@contextlib.contextmanager
def running(case):
    """A test of which single runs are made; their folders are there until it ends."""
    case.setUpClass()
    test = case()
    test.setUp()
    try:
        yield test
    finally:
        test.doCleanups()
        case.doClassCleanups()


def printed(program, tests, pattern):
    """Groups of the pattern in what tests of a test program of the build folder print."""
    run = subprocess.run([harness.BINARY_DIR / "tests" / program, f"--gtest_filter={tests}"], env=harness.ENVIRONMENT, capture_output=True, text=True, check=True)
    found = re.findall(pattern, run.stdout)
    assert found, run.stdout
    return found


def last_places(run):
    return harness.particles(sorted((run.folder / "rags").glob("particles_*.vtp"))[-1])[0]


def label(axes, name, x, y, **legend):
    axes.set_title(name, fontsize=9)
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.grid(linewidth=0.3)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(frameon=False, fontsize=7, **legend)


# Forced


def closed_channel(file):
    """Writes the flow through nearly closed cloth over that at its pressure."""
    with running(plate_across.PlateAcross) as test, open(file, "w") as table:
        table.write("kernel [m],time [s],flow over that of the cloth's K [1]\n")
        for delta in (0.016, 0.008):
            flow = test.across_a_channel(1000, delta, 0.01, 7, length=0.4)
            table.writelines(f"{delta},{0.01 * (k + 1):.2f},{flow[k]:.4f}\n" for k in range(9, len(flow), 10))


def forced():
    figure, ((channel, closed), (impulse, released)) = plt.subplots(2, 2, figsize=(9, 5.8))
    with running(plate_across.PlateAcross) as test:
        for delta, colour in ((0.016, BLUE), (0.008, RED)):
            for step, end, line in ((0.01, 0.3, "-"), (0.04, 2, "--")):
                flow = test.across_a_channel(10, delta, step, end)
                channel.plot(step * (1 + numpy.arange(len(flow))), flow, line, color=colour, linewidth=1, label=f"kernel {1e3 * delta:g} mm, steps of {1e3 * step:g} ms: {100 * (flow[-1] - 1):+.1f} %")
        for step, colour, line in ((0.0005, RED, "-"), (0.004, BLUE, "o")):
            rags = test.sheet(1000, 0.012, free_mass=plate_across.ADDED_MASS / plate_across.SIDE**2, end=0.048, step=step).monitor("rags")
            released.plot(1e3 * rags.column("time [s]"), rags.column("vx [m/s]"), line, color=colour, markersize=4, markerfacecolor="none", linewidth=1, label=f"kernel 12 mm, steps of {1e3 * step:g} ms")
        at_once = test.speed(0.0005, delta=0.006, end=0.0005, step=0.00005)
        released.plot(0.5, at_once, "s", color=GREEN, markersize=5, markerfacecolor="none", label="kernel 6 mm, after 0.5 ms")
    table = numpy.loadtxt(HERE / "cloth-channel.csv", delimiter=",", skiprows=1)
    for delta, colour in ((0.016, BLUE), (0.008, RED)):
        part = table[table[:, 0] == delta]
        closed.plot(part[:, 1], part[:, 2], color=colour, linewidth=1, label=f"kernel {1e3 * delta:g} mm: {100 * (part[-1, 2] - 1):+.0f} % at the end")
    for of, name, exact, colour in (("disc", "[[disc]]\ndiameter_mm = 100", 8 / 3 * 0.05**3, BLUE), ("strip", "[[rag]]\nlength_mm = 100\nwidth_mm = 100", math.pi / 4 * 0.1**3, RED)):
        for case, line in ((impulsive_sheet.ImpulsiveSheet, "-"), (impulsive_sheet_long.OnFineCells, "--")):
            with running(case) as test:
                exact_impulse = impulsive_sheet.DENSITY * exact
                test.impulse(of, name, exact_impulse, of == "disc")
                (run,) = test.finished.values()
                force = run.monitor("coupling")
                given = -numpy.cumsum(force.column("force_on_rags_x [N]")) * impulsive_sheet.STEP / exact_impulse
                impulse.plot(1e3 * force.column("time [s]"), given, line, color=colour, linewidth=1,
                             label=f"{of}, cells of {1e3 * test.size:g} mm: {100 * (given[-1] - 1):+.1f} %")
    for axes in (channel, closed, impulse):
        axes.axhline(1, color=GREY, linewidth=1, label="exact")
    released.axhline(0.5, color=GREY, linewidth=1, label="exact before drag acts")
    channel.set_ylim(0.9, 1.3)
    closed.set_ylim(0.9, 2.5)
    impulse.set_ylim(0, 2)
    released.set_ylim(0, 0.8)
    label(channel, "cloth across a channel, K = 10", "time, s", "flow over that at its pressure")
    label(closed, "the same, K = 1000", "time, s", "flow over that at its pressure")
    label(impulse, "closed sheets set in motion at once", "time, ms", "impulse over exact", loc="upper right")
    label(released, "free sheet released in a stream of 1 m/s", "time, ms", "speed, m/s", loc="lower right")
    return figure


# Layers


def plate(test, name, viscosity, velocity):
    """Force on a prescribed plate, N."""
    run = test.run_case(test.case(PLATE.format(viscosity=viscosity, velocity=velocity), name), out=name)
    return numpy.array([run.monitor("coupling").column(f"force_on_rags_{axis}")[-1] for axis in "xyz"])


def layers():
    figure = plt.figure(figsize=(9, 6.4))
    grid = figure.add_gridspec(2, 2)
    parts = grid[0, 0].subgridspec(2, 1, height_ratios=(2, 1), hspace=0.08)
    friction, error = figure.add_subplot(parts[0]), figure.add_subplot(parts[1])
    across, speed, shape = (figure.add_subplot(grid[k]) for k in ((0, 1), (1, 0), (1, 1)))

    def law(Re):
        return 2 * (1.328 * Re**-0.5 + 2.67 * Re**-0.875)

    Re = numpy.logspace(2.8, 5.2, 50)
    friction.loglog(Re, law(Re), color=GREY, linewidth=1, label="Blasius (1908), Messiter (1970)")
    points = {}
    with running(harness.CaseTest) as test:
        pressure, area = 500.0, 0.008  # of 1 m/s, m2
        points["one-way"] = [(Re, plate(test, f"along-{Re:g}", 100 / Re, [1, 0, 0])[0] / (pressure * area)) for Re in (1e3, 1e4, 1e5)]
        slow = numpy.logspace(-3, 2, 11)
        slower = 0.01  # m/s
        drag = [plate(test, f"across-{Re:g}", 1000 * slower * 2 * math.sqrt(area / math.pi) / Re, [0, 0, slower])[2] / (pressure * slower**2 * area) for Re in slow]
    with running(inclined_plate.InclinedPlate) as test:
        for delta in (0.012, 0.006):
            points[f"two-way, kernel {delta / inclined_plate.CHORD:.2g} c"] = [(Re, test.along(Re, delta, 0.1)) for Re in (1e3, 1e4, 1e5)]
    for (name, found), colour, mark in zip(points.items(), (BLUE, RED, GREEN), "osD"):
        x, y = numpy.array(found).T
        friction.plot(x, y, mark, color=colour, markersize=5, markerfacecolor="none", label=name)
        error.semilogx(x, 100 * (y / law(x) - 1), mark, color=colour, markersize=5, markerfacecolor="none")
    error.axhline(0, color=GREY, linewidth=1)
    error.set_ylim(-4, 4)
    label(friction, "sheet along a stream", "", "friction of both sides")
    friction.set_xticklabels([])
    label(error, "", "Re of the side along the stream", "deviation, %")
    error.set_xlim(friction.get_xlim())

    across.loglog(slow, 64 / math.pi / slow, color=GREY, linewidth=1, label=r"disc in creeping flow, $16 \mu a U$")
    across.axhline(1.17, color=GREY, linewidth=1, linestyle="--", label="plate in a fast stream, 1.17")
    across.loglog(slow, drag, color=BLUE, label="one-way", **CIRCLES)
    creeping = drag[0] / (64 / math.pi / slow[0]) - 1
    across.annotate(f"deviation {100 * creeping:+.2f} %", (slow[0], drag[0]), xytext=(8, 0), textcoords="offset points", fontsize=7)
    label(across, "sheet across slow water", "Re of the disc of the same area", "drag coefficient")

    exact, places, rise = sedimenting_sheet_long.thin_plate()
    with running(sedimenting_sheet_long.SedimentingSheet) as test:
        (run, sheet), (_, alone) = test.two_way(), test.one_way()
        rags = run.monitor("rags")
        time, found = rags.column("time [s]"), -rags.column("vz")
    times = numpy.linspace(0, sedimenting_sheet_long.END, 100)
    speed.plot(times, [1e3 * exact(t) for t in times], color=GREY, linewidth=1, label="thin plate in creeping flow")
    speed.plot(time[::10], 1e3 * found[::10], color=RED, label="two-way", **CIRCLES)
    speed.annotate(f"at the end {100 * (found[-1] / exact(time[-1]) - 1):+.1f} %", (0.7, 0.7), xycoords="axes fraction", fontsize=7)
    label(speed, "flexible sheet that sinks in a viscous liquid", "time, s", "speed, mm/s", loc="lower right")
    shape.plot(1e3 * numpy.concatenate([-places[::-1], places]), 1e3 * numpy.concatenate([rise[::-1], rise]), color=GREY, linewidth=1, label="bent by the load of creeping flow")
    for way, of, colour, mark in (("two-way", sheet, RED, "o"), ("one-way", alone, BLUE, "s")):
        z = of[:, 1] - of[len(of) // 2 - 1 : len(of) // 2 + 1, 1].mean()
        shape.plot(1e3 * (of[:, 0] - of[:, 0].mean()), 1e3 * z, mark, color=colour, markersize=3, markerfacecolor="none", label=way)
        if way == "two-way":
            spacing = sedimenting_sheet_long.SPACING
            theory = numpy.interp((sedimenting_sheet_long.LENGTH - spacing) / 2, places, rise) - numpy.interp(spacing / 2, places, rise)
            shape.annotate(f"ends {100 * ((z[0] + z[-1]) / 2 / theory - 1):+.0f} %", (0.5, 0.65), xycoords="axes fraction", fontsize=7, ha="center")
    label(shape, "the same sheet at 0.8 s", "along the sheet, mm", "above its middle, mm", loc="upper center")
    return figure


# Turning


def turning():
    figure, ((radius, swirl), (mixture, behind)) = plt.subplots(2, 2, figsize=(9, 5.8))
    with running(co_rotation.CoRotation) as test:
        start = test.start()
        for cloth, colour, line in zip(co_rotation.CLOTHS[:2], (BLUE, RED), ("-", "--")):
            turns, r, speed = test.turn(start, *cloth)
            mode, lengthwise, _ = cloth
            name = f"whole program, {mode.replace('_', '-')}, {'across' if lengthwise[0] else 'along'} the stream"
            radius.plot(turns, 100 * (r - 1), line, color=colour, linewidth=1.2, label=name)
            swirl.plot(turns, 100 * (speed - 1), line, color=colour, linewidth=1.2, label=name)
    ends = printed("verification_coupling", "*NeutralClothStaysAtItsRadius", r"at (\S+) m, (.*): (\S+) of the radius after a turn")
    for k, (at, way, end) in enumerate(ends):
        zone = "turning zone" if float(at) < 0.15 else "zone at rest"
        radius.plot(1, 100 * (float(end) - 1), "osD^"[k], color=GREEN, markersize=5, markerfacecolor="none", label=f"given water, {zone}, {way.replace('it', 'the stream')}")
    for axes in (radius, swirl):
        axes.axhline(0, color=GREY, linewidth=1)
        axes.set_xlim(0, 1.04)
    radius.set_ylim(-0.2, 0.8)
    swirl.set_ylim(-2, 2)
    label(radius, "neutral cloth in water that turns as a solid", "turns", "change of its radius, %", loc="upper left")
    label(swirl, "the same: its speed of turning", "turns", "deviation from the housing, %", loc="upper left")

    found = numpy.array(printed("verification_coupling", "*MixtureMovesAsOne", r"solid fraction (\S+): neutral 1 (\S+) (\S+), twice as dense (\S+) to (\S+), exact"), float)
    phi = numpy.linspace(0, 0.6, 50)
    mixture.plot(phi, 1 + 0 * phi, color=BLUE, linewidth=1, label="exact, neutral")
    mixture.plot(phi, 1 / (1 + phi), color=RED, linewidth=1, label=r"exact, twice as dense, $1/(1 + \phi)$")
    mixture.plot(found[:, 0], 1 + found[:, 1], color=BLUE, label=f"Snag, deviation {abs(found[:, 1:3]).max():.0e}", **CIRCLES)
    deviation = abs(found[:, 3:] * (1 + found[:, :1]) - 1).max()
    mixture.plot(found[:, 0], found[:, 3:].mean(axis=1), color=RED, label=f"Snag, deviation at most {100 * deviation:.2f} %", **CIRCLES)
    mixture.set_ylim(0.5, 1.1)
    label(mixture, "mixture under a body force", r"solid fraction $\phi$", "acceleration over that of the force", loc="lower left")

    share = {(name, gap): float(value) for name, gap, value in printed("unit_coupling", "*PassesThroughNoWall", r"(\w+), (no gap|gap): share behind the wall (\S+)")}
    names = sorted({name for name, _ in share}, key=lambda name: (name != "diffusion", name))
    for k, name in enumerate(names):
        for gap, shift, colour in (("no gap", -0.19, BLUE), ("gap", 0.19, RED)):
            value = share[name, gap]
            behind.bar(k + shift, value, 0.36, color=colour, alpha=0.8, label={"no gap": "closed wall", "gap": "gap, 5 widths away"}[gap] if k == 0 else None)
            behind.annotate(f"{value:.1g}" if value < 0.01 else f"{value:.2f}", (k + shift, value), xytext=(0, 2), textcoords="offset points", ha="center", fontsize=7)
    behind.axhline(0, color=GREY, linewidth=1, label="exact: none")
    behind.set_xticks(range(len(names)), names)
    behind.set_ylim(-0.02, 0.6)
    label(behind, "particle before a wall of 10 mm, kernel of 60 mm", "kernel", "share of its force behind the wall", loc="upper left")
    return figure


# Spheres


def spheres():
    """Lines of the test: `(Re, cells to the diameter) {settings}: error %`."""
    text = (HERE / "cloth-sphere-drag.txt").read_text()
    rows = [(float(Re), float(cells), ast.literal_eval(settings), float(error)) for Re, cells, settings, error in re.findall(r"\((\S+), (\S+)\) (\{.*\}): (\S+) %", text)]
    figure, axes = plt.subplots(1, 4, figsize=(12, 3.4), gridspec_kw={"width_ratios": (1, 1, 1, 1.6)})
    marks = {0.2: ("^", GREEN), 1: ("s", BLUE), 2: ("o", RED), 4: ("D", "0.4"), 8: ("v", "0.1")}
    for of, kernel in zip(axes, ("gaussian", "diffusion", "satellite")):
        for cells, (mark, colour) in marks.items():
            points = sorted((Re, error) for Re, d, keys, error in rows if d == cells and keys.get("kernel", "gaussian") == kernel and "wall" not in keys)
            if points:
                of.semilogx(*zip(*points), mark, color=colour, markersize=5, markerfacecolor="none", linestyle="-", linewidth=0.5, label=f"{cells:g} cells" if cells != 1 else "1 cell")
        of.axhline(0, color=GREY, linewidth=1)
        of.set_ylim(-2, 2)
        label(of, kernel, "Re", "deviation of the speed, %" if kernel == "gaussian" else "", loc="upper right", title="diameter of", title_fontsize=7)
    for cells, (_, colour) in marks.items():
        points = [(Re, error) for Re, d, keys, error in rows if d == cells and keys.get("kernel") == "wendland" and "wall" not in keys]
        if points:
            axes[0].plot(*zip(*points), "*", color=colour, markersize=7, label=f"{cells:g} cells, wendland")
    axes[0].legend(frameon=False, fontsize=7, loc="upper right", title="diameter of", title_fontsize=7)

    distance = numpy.linspace(0.7, 4, 100)
    axes[3].plot(distance, [sphere_drag.faxen(h * sphere_drag.DIAMETER) for h in distance], color=GREY, linewidth=1, label="Faxen")
    for kernel, width, mark, colour in (("gaussian", 1, "o", RED), ("gaussian", 2, "s", BLUE), ("wendland", 1, "*", "0.1"), ("diffusion", 1, "^", GREEN), ("satellite", 1, "D", "0.4")):
        points = sorted((keys["wall"], error) for _, _, keys, error in rows if keys.get("wall") and keys.get("width", 1) == width and keys.get("kernel", "gaussian") == kernel)
        drag = [sphere_drag.faxen(h * sphere_drag.DIAMETER) / (1 + error / 100) for h, error in points]
        name = f"{kernel}{', 2 diameters wide' if width > 1 else ''}: {', '.join(f'{error:+.1f}' for _, error in points)} %"
        axes[3].plot([h for h, _ in points], drag, mark, color=colour, markersize=5, markerfacecolor="none", label=name)
    axes[3].set_ylim(1, 1.9)
    label(axes[3], "along a wall, Re 0.005", "distance over diameter", "drag over that in the open")
    return figure


# Bending


def cantilever(axes):
    with running(held.Held) as test:
        places = last_places(test.run_case(test.strip(held.HELD_EDGE + held.FLUID, 0.2)))[: held.N]
    weight = (held.MASS - 1e-3 * 0.77e-3 * held.SPACING**2) * held.GRAVITY
    x = numpy.linspace(0, held.SPACING * (held.N - 1), 100)
    arms = held.SPACING * numpy.arange(held.N)
    low, high = numpy.minimum(x[:, None], arms), numpy.maximum(x[:, None], arms)
    line = (weight * low**2 * (3 * high - low) / (6 * held.BENDING)).sum(axis=1)
    axes.plot(1e3 * x, -1e6 * line, color=GREY, linewidth=1, label="Euler and Bernoulli")
    axes.plot(1e3 * (places[:, 0] - places[0, 0]), 1e6 * (places[:, 2] - places[0, 2]), color=RED, label="Snag", **CIRCLES)
    axes.annotate(f"{100 * ((places[0, 2] - places[-1, 2]) / line[-1] - 1):+.2f} %", (1e3 * x[-1], -1e6 * line[-1]), xytext=(-36, 0), textcoords="offset points", fontsize=7)
    label(axes, "cantilever under its weight", "along it, mm", r"deflection, $\mu$m")


def cut_cantilever(axes):
    found = numpy.array(printed("verification_dem", "*CantileverCutInTwo*", r"row (\d): cut (\S+), whole (\S+) of two beams"), float)
    rows, n = found[:, 0] + 1, len(found)
    axes.plot([0.5, n / 2 + 0.5, n / 2 + 0.5, n + 0.5], [1, 1, 0, 0], color=GREY, linewidth=1, label="two beams, one loaded")
    axes.plot(rows, found[:, 1], color=RED, label="Snag, cut", **CIRCLES)
    axes.plot(rows, found[:, 2], "s", color=BLUE, markersize=4, markerfacecolor="none", label="Snag, not cut")
    axes.annotate(f"{100 * (found[0, 1] - 1):+.2f} %", (1, found[0, 1]), xytext=(0, -12), textcoords="offset points", fontsize=7)
    axes.set_ylim(-0.1, 1.4)
    label(axes, "cantilever cut into two strips", "row of particles", "deflection of the tip over exact", loc="upper right")


def sector(axes, errors):
    with running(reconfiguration.SectorOfADisc) as test:
        errors["sector, across its clamp"] = []
        for across, mark, colour in ((3, "s", BLUE), (6, "o", RED)):
            piece, run, error = test.sector(across)
            errors["sector, across its clamp"].append((across, error))
            files = sorted((run.folder / "rags").glob("particles_*.vtp"))
            start, end = (harness.particles(file)[0] for file in (files[0], files[-1]))
            y = numpy.unique(start[:, 1].round(9))
            row = abs(start[:, 1] - y[numpy.argmin(abs(y - start[:, 1].mean()))]) < 1e-9
            start, end = start[row], end[row]
            free = numpy.flatnonzero(numpy.abs(end - start).max(axis=1) > 1e-9)
            part, length = end[free[0] - 1 : free[-1] + 1] - start[free[0] - 1], 0.028
            axes.plot(part[:, 0] / length, part[:, 2] / length, mark, color=colour, markersize=4, markerfacecolor="none", markevery=across // 3, label=f"Snag, {across} at its clamp: {100 * error:+.1f} %")
        theta = elastica.blade(500 / piece.taper, 0, 80, piece.taper)[::-1, 0]
    way = [numpy.concatenate([[0], numpy.cumsum(of[1:] + of[:-1])]) / (2 * len(theta) - 2) for of in (numpy.cos(theta), numpy.sin(theta))]
    axes.plot(*way, color=GREY, linewidth=1, label="elastica")
    axes.set_aspect("equal")
    axes.set(xlim=(-0.05, 1.05), ylim=(-0.05, 0.95))
    label(axes, "sector of a disc, C = 500", "out from the hub, over length", "downstream, over length", loc="lower right")


def blade(axes):
    with running(blade_long.BladeLong) as test:
        _, rigid = test.blade(300 * blade_long.STIFFNESS)
        run, drag = test.blade(3 * blade_long.STIFFNESS)
        C, model, model_height, shape = test.model(rigid)
        height = run.monitor("rags").column("z_max")[-1] / blade_long.LENGTH
        places = last_places(run)[: round(blade_long.LENGTH / blade_long.SIZE)] / blade_long.LENGTH
    axes.plot(*shape.T, color=GREY, linewidth=1, label="model of Luhar and Nepf (2011)")
    axes.plot(places[:, 0], places[:, 2], color=RED, label="Snag, two-way", markevery=2, **CIRCLES)
    axes.axhline(0, color="0.5", linewidth=0.8)
    axes.annotate(f"drag {100 * (drag / model - 1):+.0f} %, height {100 * (height / model_height - 1):+.0f} %", (0.45, 0.1), xycoords="axes fraction", fontsize=7)
    axes.set_aspect("equal", adjustable="datalim")
    label(axes, f"blade of foam in a stream, Ca = {C:.0f}", "x over length", "height over length", loc="upper left")


def lattices(axes, errors):
    with running(reconfiguration.Reconfiguration) as test:
        errors["plate across a stream, C = 10, to a half"] = [(n / 2, test.error(n)) for n in (15, 27, 51)]
    with running(stuart_loop.StuartLoop) as test:
        errors["loop of Stuart, to the bending length"] = [(n * stuart_loop.BENDING_LENGTH / stuart_loop.LENGTH, test.error(n)) for n in (60, 120)]
    for (name, points), mark, colour in zip(errors.items(), "sod", (BLUE, RED, GREEN)):
        n, error = numpy.array(points).T
        axes.loglog(n, 100 * abs(error), mark, color=colour, markersize=5, markerfacecolor="none", linestyle="-", linewidth=0.7, label=name)
    n = numpy.array([6, 24])
    axes.loglog(n, 12 * (n / 6.0) ** -2, color=GREY, linewidth=1, linestyle="--", label="second order")
    axes.set_ylim(0.02, 100)
    axes.set_xticks([3, 5, 10, 20], ["3", "5", "10", "20"])
    axes.minorticks_off()
    label(axes, "error of coarse lattices", "particles", "deviation of drag or height, %")


def flutter(axes):
    points, theory = {}, flag.Flag.theory
    with running(flag.Flag) as test:
        for beta in (0.02, 0.03, 0.04, 0.05):
            points[beta] = test.mode(1, beta, 0.025, 0.025, 0.02, 3, 9)
    betas = numpy.linspace(0.018, 0.053, 20)
    modes = numpy.array([theory.flutter_mode(1, beta) for beta in betas])
    axes.plot(betas, modes.real, color=BLUE, linewidth=1, label="growth, theory")
    axes.plot(betas, modes.imag, color=RED, linewidth=1, label="frequency, theory")
    axes.plot(list(points), [mode.real for mode in points.values()], color=BLUE, label="growth, Snag", **CIRCLES)
    axes.plot(list(points), [mode.imag for mode in points.values()], color=RED, label="frequency, Snag", **CIRCLES)
    axes.axhline(0, color="0.5", linewidth=0.8)
    deviations = [abs(mode / theory.flutter_mode(1, beta) - 1) for beta, mode in points.items()]
    axes.annotate(rf"deviation at most {100 * max(deviations):.0f} % of $\sigma$", (0.05, 0.3), xycoords="axes fraction", fontsize=7)
    label(axes, r"flag, $m/(\rho L)$ = 1", r"stiffness $B/(\rho U^2 L^3)$", r"$\sigma L/U$")


def bending():
    figure, ((a, b, c), (d, e, f)) = plt.subplots(2, 3, figsize=(10.5, 6.4))
    errors = {}
    cantilever(a)
    cut_cantilever(b)
    sector(c, errors)
    blade(d)
    lattices(e, errors)
    flutter(f)
    return figure


def choices():
    """What a result owes to choices of the user: particles, cells, steps and sub-steps."""
    figure, (free, held, rest) = plt.subplots(1, 3, figsize=(10.5, 3.6))
    settings = {f"radius {radius} mm": f"rag.0.radius_mm={radius}" for radius in (1, 1.5, 2.5, 4)}
    settings |= {"cells 1/2": "mesh.parameters='channel-half.toml'", "cells 1/3": "mesh.parameters='channel-third.toml'", "step 1/2": "time.step_ms=2", "step 1/4": "time.step_ms=1"}
    with running(independence.IndependenceOfParticles) as test:
        for axes, piece in ((free, "free"), (held, "held")):
            found = [test.deviations(piece, setting) for setting in settings.values()]
            for k, (name, colour) in enumerate(zip(found[0], (BLUE, RED))):
                axes.barh(numpy.arange(len(found)) + 0.4 * k - 0.2, [100 * deviations[name] for deviations in found], height=0.36, color=colour, label=name)
            axes.set_yticks(range(len(found)), list(settings), fontsize=7)
            axes.invert_yaxis()
            axes.axvspan(-3, 3, color="0.93", zorder=0)
            axes.set_xlim(-4, 4)
            label(axes, f"{piece} rag", "deviation [%]", "")
    with running(strip_over_edge.StripOverEdge) as test:
        for safety, colour, line in ((0.8, BLUE, "-"), (0.08, RED, "--")):
            _, _, rags = test.rest('["recommended"]', 0.5, safety)
            name = "chosen sub-step" if safety == 0.8 else "a tenth of it"
            rest.semilogy(1e3 * rags.column("time [s]"), 1e3 * rags.column("kinetic_energy [J]"), line, color=colour, linewidth=1, label=f"kinetic energy [mJ], {name}")
            rest.semilogy(1e3 * rags.column("time [s]"), rags.column("bond_strain_p99 [1]"), line, color=GREEN if line == "-" else GREY, linewidth=1, label=f"strain of 99 %, {name}")
    label(rest, "strip over an edge", "time [ms]", "")
    return figure


# Limits


def limits():
    """Any kernel, loss coefficient and step, and cloth that is pressed to a floor. Lines of the first test: `KERNEL, K K, CELLS cells a step: mean, least LEAST, largest LARGEST`."""
    text = (HERE / "cloth-kernels.txt").read_text()
    rows = re.findall(r"(\w+), K (\S+), (\S+) cells a step: (\S+), least (\S+), largest (\S+)", text)
    kernels, coefficients = (list(dict.fromkeys(row[k] for row in rows)) for k in (0, 1))
    figure, (drag, energy, strain) = plt.subplots(1, 3, figsize=(11, 3.6), gridspec_kw={"width_ratios": (1.5, 1, 1)})
    marks = dict(zip(dict.fromkeys(row[2] for row in rows), ("o", "s", "^")))
    for kernel, K, cells, *force in rows:
        mean, least, largest = (float(value) for value in force)
        k = coefficients.index(K)
        x = kernels.index(kernel) + 0.27 * (k - 1) + 0.07 * (list(marks).index(cells) - 1)
        first = kernel == kernels[0] and (k == 0 or cells == "1")
        name = f"K = 1, {cells} cells a step" if k == 0 else f"K = {float(K):g}"
        drag.errorbar(x, mean, [[mean - least], [largest - mean]], fmt=marks[cells], color=(BLUE, RED, GREEN)[k], markersize=3.5, markerfacecolor="none", linewidth=1, label=name if first else None)
    drag.set_xticks(range(len(kernels)), kernels)
    drag.set_ylim(0, 2)
    label(drag, "sheet across a stream, last 40 of 100 steps", "", "drag coefficient: mean, least, largest", ncols=2)

    found = numpy.array(printed("verification_dem", "PressedCloth.ComesToRest*", r"(\S+) s: kinetic energy (\S+) of m g r, strain (\S+); at a tenth of the step (\S+), (\S+)"), float)
    for k, (colour, line, name) in enumerate(((BLUE, "-", "chosen sub-step"), (RED, "--", "a tenth of it"))):
        energy.semilogy(1e3 * found[:, 0], found[:, 1 + 2 * k], line, color=colour, linewidth=1, label=name)
        strain.plot(1e3 * found[:, 0], found[:, 2 + 2 * k], line, color=colour, linewidth=1, label=name)
    energy.axhline(1e-6, color=GREY, linewidth=1, label="bound")
    strain.axhspan(0.95 * found[-1, 4], 1.05 * found[-1, 4], color="0.9", zorder=0, label="within 5 %")
    strain.set_ylim(0.05, 0.075)
    label(energy, "five layers pressed onto a floor", "time, ms", r"kinetic energy over $m g r_p$")
    label(strain, "the same: strain of 99 %", "time, ms", "strain", loc="lower right")
    return figure


if __name__ == "__main__":
    picture, out = sys.argv[1:]
    if picture == "channel":
        closed_channel(out)
    else:
        plt.rcParams.update({"font.size": 9, "svg.hashsalt": "snag"})
        figure = {f.__name__: f for f in (forced, layers, turning, spheres, bending, choices, limits)}[picture]()
        figure.tight_layout()
        figure.savefig(out, metadata={"Date": None})
