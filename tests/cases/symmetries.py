# timeout: 200
# cost: 10
"""Requirement: the flow does not depend on how the case lies, with planes of symmetry aslant to the coordinates, nor on the level of the pressure,
nor on the numbers of nodes and the order of patches; a closed case whose water is at rest starts whatever its round-off; a body turns in it with and without friction, in its frame and sliding."""
import math
import pathlib
import re
import shutil

import graded_box
import harness
import numpy
from turning_zone import RingMesh

# Of oil: nu dt/h2 is 2 to 9.
CHANNEL = """
[mesh]
file = "{mesh}"
[time]
end_s = 3
step_s = 0.02
[flow]
kinematic_viscosity_m2_s = 5.4e-3
initial_velocity_m_s = [0.4, 0, 0]
momentum_tolerance = 1e-8
pressure_tolerance = 1e-6
limiter = "none"
[turbulence]
model = "laminar"
[[boundary]]
patch = "x0"
kind = "velocity_inlet"
velocity_m_s = [0.4, 0, 0]
[[boundary]]
patch = "x1"
kind = "pressure_outlet"
[[boundary]]
patch = "y0"
kind = "wall"
[[boundary]]
patches = ["y1", "z0", "z1"]
kind = "symmetry"
[output]
report = false
"""

LEVEL = """
[mesh]
geometry = "box"
set = ["lower_m=[0,0,0]", "upper_m=[0.2,0.1,0.1]", "size_m=0.012", "cells=\\"tetrahedra\\""]
[time]
end_s = 0.02
step_s = 0.002
[flow]
initial_velocity_m_s = [0.4, 0, 0]
pressure_tolerance = 1e-8
[[boundary]]
patch = "x0"
{inlet}
[[boundary]]
patch = "x1"
kind = "pressure_outlet"
pressure_Pa = {level}
[[boundary]]
patches = ["y0", "y1", "z0", "z1"]
kind = "wall"
[output]
fields_interval_s = 0.02
single_precision = false
report = false
"""

NUMBERING = """
[mesh]
file = "{mesh}"
[time]
end_s = 0.03
step_s = 0.003
[flow]
initial_velocity_m_s = [0.4, 0, 0]
pressure_tolerance = 1e-11
pressure_tolerance_intermediate = 1e-11
momentum_tolerance = 1e-12
limiter = "vector_venkatakrishnan"
[turbulence]
model = "laminar"
[[boundary]]
patch = "x0"
kind = "velocity_inlet"
velocity_m_s = [0.4, 0, 0]
[[boundary]]
patch = "x1"
kind = "pressure_outlet"
[[boundary]]
patches = ["y0", "y1", "z0", "z1"]
kind = "wall"
[output]
fields_interval_s = 0.03
single_precision = false
report = false
"""

REST = """
[mesh]
file = "{mesh}"
[rotating_zone]
zone = "rotor"
rotation_speed_rad_s = 10
[time]
end_s = 0.03
step_s = 0.01
[turbulence]
model = "laminar"
[[boundary]]
patches = ["impeller_walls", "walls"]
kind = "wall"
[[boundary]]
patch = "outlet"
kind = "symmetry"
[output]
report = false
"""


ELLIPSE = """
[mesh]
file = "{mesh}"
[rotating_zone]
zone = "rotor"
motion = "{motion}"
rotation_speed_rad_s = 10
[time]
end_s = 0.5
step_s = 0.01
[flow]
kinematic_viscosity_m2_s = {viscosity}
[turbulence]
model = "laminar"
[[boundary]]
patches = ["impeller_walls", "walls"]
kind = "{kind}"
[[boundary]]
patch = "outlet"
kind = "symmetry"
[output]
report = false
{start}
"""


def mapped(file, matrix):
    """The mesh of a gmsh 2.2 file, its nodes mapped by a 3 x 3 matrix; the file is changed."""
    lines = file.read_text().split("\n")
    for i in range(lines.index("$Nodes") + 2, lines.index("$EndNodes")):
        number, *place = lines[i].split()
        lines[i] = " ".join([number, *map(repr, (matrix @ numpy.array(place, float)).tolist())])
    file.write_text("\n".join(lines))


def turned(file, angle):
    """The mesh, turned about x."""
    c, s = math.cos(angle), math.sin(angle)
    mapped(file, numpy.array([[1, 0, 0], [0, c, -s], [0, s, c]]))


def renumbered(file, random):
    """Gives the nodes of a gmsh 2.2 file other numbers and another order, and exchanges its sides along y and z; the file is changed."""
    lines = file.read_text().split("\n")
    side = dict(re.findall(r'2 (\d+) "(.*)"', "\n".join(lines)))
    tag = {name: number for number, name in side.items()}
    exchanged = {tag[one + end]: tag[other + end] for one, other in ("yz", "zy") for end in "01"}
    first, end = lines.index("$Nodes") + 2, lines.index("$EndNodes")
    number = {line.split()[0]: str(new + 1) for line, new in zip(lines[first:end], random.permutation(end - first))}
    nodes = [line.split() for line in lines[first:end]]
    lines[first:end] = [" ".join([number[node[0]], *node[1:]]) for node in sorted(nodes, key=lambda node: int(number[node[0]]))]
    for i in range(lines.index("$Elements") + 2, lines.index("$EndElements")):
        words = lines[i].split()
        words[3] = exchanged.get(words[3], words[3])
        corners = 3 + int(words[2])
        lines[i] = " ".join(words[:corners] + [number[node] for node in words[corners:]])
    file.write_text("\n".join(lines))


class Symmetries(harness.CaseTest):
    def test_planes_of_symmetry_aslant(self):
        found = {}
        for name, angle in (("straight", 0), ("turned", math.pi / 4), ("odd", 0.4)):
            mesh = self.work / f"{name}.msh"
            graded_box.write(mesh, [numpy.linspace(0, 0.14, 21), numpy.linspace(0, 0.028, 9), numpy.linspace(0, 0.014, 4)])
            turned(mesh, angle)
            run = self.run_case(self.case(CHANNEL.format(mesh=mesh), name), 2 if name == "odd" else 1, out=name)
            found[name] = run.monitor("patches").column("x0_pressure")
        for name in ("turned", "odd"):
            self.assertLess(numpy.abs(found[name] / found["straight"] - 1).max(), 1e-6, name)

    def test_level_of_the_pressure(self):
        for name, inlet, level in (("flow", 'kind = "velocity_inlet"\nvelocity_m_s = [0.4, 0, 0]', 101325),
                                   ("pressure", 'kind = "pressure_inlet"\npressure_Pa = {p}', 1e5)):
            runs = []
            for p in (0, level):
                text = LEVEL.format(inlet=inlet.format(p=p + 200), level=p)
                run = self.run_case(self.case(text, f"{name}-{p}"), 2 if name == "pressure" else 1, out=f"{name}-{p}")
                grid = harness.read_vtk(max((run.folder / "fields").glob("water*.pvtu")))
                order = numpy.lexsort(numpy.round(harness.cell_centres(grid), 9).T)
                runs.append((run.monitor("patches").column("x0_pressure"), harness.arrays(grid.GetCellData())["velocity [m/s]"][order]))
            self.assertLess(numpy.abs(runs[1][0] - level - runs[0][0]).max(), 1e-5, name)
            self.assertLess(numpy.abs(runs[1][1] - runs[0][1]).max(), 1e-9, name)

    def test_numbers_and_names(self):
        """Of tetrahedra, sheared so that some have two walls that they lie aslant over."""
        box = self.mesh("box", "lower_m=[0,0,0]", "upper_m=[0.2,0.1,0.1]", "size_m=0.02", 'cells="tetrahedra"')
        found = []
        for name in ("first", "second"):
            mesh = pathlib.Path(shutil.copy(box, self.work / f"{name}.msh"))
            mapped(mesh, numpy.array([[1, 1, 1], [0, 1, 0.5], [0, 0, 1]]))
            if found:
                renumbered(mesh, numpy.random.default_rng(1))
            run = self.run_case(self.case(NUMBERING.format(mesh=mesh), name), 1, out=name)
            grid = harness.read_vtk(max((run.folder / "fields").glob("water*.pvtu")))
            order = numpy.lexsort(numpy.round(harness.cell_centres(grid), 9).T)
            found.append(harness.arrays(grid.GetCellData())["velocity [m/s]"][order])
        self.assertLess(numpy.abs(found[1] - found[0]).max(), 1e-8)

    def test_closed_case_at_rest(self):
        """What goes through its walls is the round-off of what goes along them."""
        mesh, n = RingMesh(), 192
        mesh.add(1, (0.03, 0.05, 0, 0.004, 0), (n, 6, 1), dict(r0="impeller_walls", r1="interface_rotor", z0="outlet", z1="outlet"))
        mesh.add(2, (0.05, 0.08, 0, 0.004, 0), (n, 8, 1), dict(r0="interface_stator", r1="walls", z0="outlet", z1="outlet"))
        mesh.write(self.work / "ring.msh")
        self.run_case(self.case(REST.format(mesh=self.work / "ring.msh")), 1)


    def ellipse(self, kind, viscosity, motion, start=""):
        """Balance of the water round an ellipse that turns in a closed ring."""
        mesh, n = RingMesh(), 96
        mesh.add(1, (0.03, 0.05, 0, 0.004, 0), (n, 6, 1), dict(r0="impeller_walls", r1="interface_rotor", z0="outlet", z1="outlet"))
        mesh.add(2, (0.05, 0.08, 0, 0.004, 0), (n, 8, 1), dict(r0="interface_stator", r1="walls", z0="outlet", z1="outlet"))
        for i, (x, y, z) in enumerate(mesh.nodes):
            r = math.hypot(x, y)
            longer = 1 + 0.2 * math.cos(2 * math.atan2(y, x)) * max(0, (0.05 - r) / 0.02)
            mesh.nodes[i] = (longer * x, longer * y, z)
        mesh.write(self.work / "ellipse.msh")
        name = f"{kind}-{motion}"
        start = f'[initial_flow]\nfrom = "{start}"' if start else ""
        case = self.case(ELLIPSE.format(mesh=self.work / "ellipse.msh", kind=kind, viscosity=viscosity, motion=motion, start=start), name)
        return self.run_case(case, 1, out=name).monitor("balance")

    def test_turning_body_that_slips(self):
        """The power of the water that an ellipse pushes aside is that of its torque."""
        for motion in ("frame", "sliding"):
            balance = self.ellipse("symmetry", 1e-6, motion)
            power = balance.column("shaft_power")
            self.assertLess(numpy.abs(balance.column("shaft_torque") * 10 - power).max(), 1e-3 * numpy.abs(power).max(), motion)

    def test_sliding_from_the_frame(self):
        """The water of the frame turns with the rotor from the first step of the sliding run on: no kick."""
        self.ellipse("wall", 1e-3, "frame")
        torque = self.ellipse("wall", 1e-3, "sliding", "wall-frame").column("shaft_torque")
        self.assertLess(abs(torque[0] / torque[1] - 1), 0.05)


if __name__ == "__main__":
    harness.main()
