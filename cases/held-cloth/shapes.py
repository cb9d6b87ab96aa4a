"""Shapes of held cloth against theory, as SVG: shapes.py OUT.svg, with SNAG_BINARY_DIR and SNAG_SOURCE_DIR set; runs the cases of the tests blade, stuart_loop and hanging_strip (half a minute); needs
numpy, matplotlib, vtk. Lines: theory; circles: particles of Snag at rest."""
import math
import pathlib
import sys
import tempfile

import matplotlib
import numpy

matplotlib.use("svg")
import matplotlib.pyplot as plt

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "tests" / "cases"))
import blade
import elastica
import hanging_strip
import harness
import stuart_loop

BLUE, GREEN, RED = "#2060b0", "#207040", "#c03020"
CIRCLES = {"marker": "o", "linestyle": "none", "markersize": 3, "markerfacecolor": "none"}


def at_rest(folder, text, end):
    """Places of the particles at the end of a run."""
    folder.mkdir()
    file = folder / "case.toml"
    file.write_text(text.replace("report = false", f"report = false\nrags_interval_s = {end!r}"))
    run = harness.snag(["run", file, "--out", folder / "out"], 1, folder / "out")
    assert run.code == 0, run.tail()
    return harness.particles(sorted((folder / "out" / "rags").glob("particles_*.vtp"))[-1])[0]


def blades(axes, folder):
    for (name, (density, modulus, thickness, speeds)), colour in zip(blade.BLADES.items(), (BLUE, RED)):
        stiffness = modulus * thickness**3 / 12
        buoyancy = (blade.DENSITY - density) * blade.GRAVITY * thickness * blade.LENGTH**3 / stiffness
        for speed, end in speeds.items():
            radius = blade.RADIUS
            text = blade.CASE.format(length=2 * blade.COLUMNS * radius, width=2 * blade.ROWS * radius, radius=radius, middle=blade.LENGTH / 2 - radius / 2, end=end, speed=speed, mass=density * thickness,
                                     thickness=thickness, bending=4 * stiffness / (math.pi * radius**4))
            places = at_rest(folder / f"{name}-{speed}", text, end)[: blade.COLUMNS : 3] / blade.LENGTH
            C = 0.5 * blade.DENSITY * blade.DRAG * speed**2 * blade.LENGTH**3 / stiffness
            theta = elastica.blade(C, buoyancy)[::-1, 0]
            x, z = (numpy.concatenate([[0], numpy.cumsum(of[1:] + of[:-1])]) / (2 * len(theta) - 2) for of in (numpy.sin(theta), numpy.cos(theta)))
            axes.plot(x, z, color=colour, linewidth=1)
            axes.plot(places[:, 0], places[:, 2], color=colour, **CIRCLES)
            axes.annotate(f"{name}, {speed} m/s", (x[-1], z[-1]), xytext=(4, -3), textcoords="offset points", fontsize=7)
    axes.axhline(0, color="0.5", linewidth=0.8)
    axes.set(xlim=(-0.05, 1.35), xlabel="x over length", ylabel="height over length")
    axes.set_title("blades in a stream", fontsize=9)


class Loop(stuart_loop.StuartLoop):
    def runTest(self):
        Loop.places = self.outline(120)


def loop(axes):
    result = Loop().defaultTestResult()
    Loop.setUpClass()
    Loop().run(result)
    Loop.doClassCleanups()
    assert result.wasSuccessful(), result.failures + result.errors
    exact, places = elastica.stuart_loop(1000), Loop.places
    shift = places[places[:, 1].argmax(), 0] - exact[exact[:, 1].argmax(), 0]
    axes.plot(exact[:, 0] + shift, exact[:, 1], color="0.2", linewidth=1, label="theory")
    axes.plot(places[::2, 0], places[::2, 1], color=RED, label="Snag", **CIRCLES)
    axes.axhline(0, color="0.5", linewidth=0.8)
    axes.set(xlabel="x over bending length")
    axes.legend(frameon=False, fontsize=7, loc="upper left")
    axes.set_title("strip folded over on a table", fontsize=9)


def strips(axes, folder):
    for speed, colour in ((2, BLUE), (2.6, GREEN), (3.3, RED)):
        places = at_rest(folder / f"strip-{speed}", hanging_strip.STRIP.format(speed=speed), 6)[: hanging_strip.N]
        way = 1e3 * (places - places[0])
        k = 0.5 * hanging_strip.DENSITY * hanging_strip.NORMAL * speed**2 / hanging_strip.WEIGHT
        angle, length = math.acos((math.sqrt(1 + 4 * k * k) - 1) / (2 * k)), numpy.linalg.norm(way[-1])
        axes.plot([0, length * math.cos(angle)], [0, -length * math.sin(angle)], color=colour, linewidth=1)
        axes.plot(way[::2, 0], way[::2, 2], color=colour, label=f"{speed} m/s", **CIRCLES)
    axes.set(xlabel="x, mm", ylabel="z, mm")
    axes.legend(frameon=False, fontsize=7, loc="lower left")
    axes.set_title("limp strips that hang in a stream", fontsize=9)


fig, (left, middle, right) = plt.subplots(1, 3, figsize=(10, 3.4), gridspec_kw={"width_ratios": (1.3, 1.1, 0.9)})
with tempfile.TemporaryDirectory() as folder:
    blades(left, pathlib.Path(folder))
    loop(middle)
    strips(right, pathlib.Path(folder))
for axes in (left, middle, right):
    axes.set_aspect("equal")
    axes.grid(linewidth=0.3)
fig.tight_layout()
fig.savefig(sys.argv[1])
