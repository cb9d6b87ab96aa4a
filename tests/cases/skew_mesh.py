# timeout: 120
# processors: 2
"""Requirement: water past a sphere stays bounded on a mesh of prisms around an axis, with faces skew by 1.49, at a Courant number of 14."""
import math

import harness

N_RADIAL, N_POLAR, N_SECTORS = 10, 8, 28
SPHERE_RADIUS, BALL_RADIUS, GROWTH = 0.5, 15.0, 1.09  # m, m, of one cell's height over the last
TRIANGLE, QUADRILATERAL, HEXAHEDRON, PRISM = 2, 3, 5, 6  # of gmsh
SPHERE, INLET, OUTLET, WATER = 1, 2, 3, 4  # physical groups
CASE = """
[case]
name = "sphere"
[mesh]
file = "{mesh}"
[time]
end_s = 300
step_s = 5
[flow]
density_kg_m3 = 1
dynamic_viscosity_Pa_s = 0.003333333333
initial_velocity_m_s = [1, 0.02, 0]
[[boundary]]
patch = "inlet"
kind = "velocity_inlet"
velocity_m_s = [1, 0, 0]
[[boundary]]
patch = "outlet"
kind = "pressure_outlet"
[[boundary]]
patch = "sphere"
kind = "wall"
[output]
report = false
"""


def ball():
    """A sphere in a ball of water as gmsh 2.2: hexahedra, and prisms around the x axis. Returns the text."""
    first = (BALL_RADIUS - SPHERE_RADIUS) * (GROWTH - 1) / (GROWTH**N_RADIAL - 1)
    radii = [SPHERE_RADIUS + first * (GROWTH**i - 1) / (GROWTH - 1) for i in range(N_RADIAL + 1)]
    places = {}

    def node(i, j, k):
        k = 0 if j in (0, N_POLAR) else k % N_SECTORS
        polar, azimuth = math.pi * j / N_POLAR, 2 * math.pi * k / N_SECTORS
        across = radii[i] * math.sin(polar)
        place = (radii[i] * math.cos(polar), across * math.cos(azimuth), across * math.sin(azimuth))
        return places.setdefault((i, j, k), (len(places) + 1, place))[0]

    elements = []
    for i in range(N_RADIAL):
        for j in range(N_POLAR):
            for k in range(N_SECTORS):
                inner, outer = (
                    list(dict.fromkeys([node(layer, j, k), node(layer, j + 1, k), node(layer, j + 1, k + 1), node(layer, j, k + 1)])) for layer in (i, i + 1)
                )
                face, cell = (TRIANGLE, PRISM) if len(inner) == 3 else (QUADRILATERAL, HEXAHEDRON)
                elements.append((cell, WATER, inner + outer))
                if i == 0:
                    elements.append((face, SPHERE, inner))
                if i == N_RADIAL - 1:
                    elements.append((face, OUTLET if 2 * j + 1 < N_POLAR else INLET, outer))
    names = f'2 {SPHERE} "sphere"\n2 {INLET} "inlet"\n2 {OUTLET} "outlet"\n3 {WATER} "water"'
    nodes = "\n".join(f"{n} {x:.16g} {y:.16g} {z:.16g}" for n, (x, y, z) in places.values())
    rows = "\n".join(f"{e} {kind} 2 {group} {group} {' '.join(map(str, corners))}" for e, (kind, group, corners) in enumerate(elements, 1))
    return (
        f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n{names}\n$EndPhysicalNames\n"
        f"$Nodes\n{len(places)}\n{nodes}\n$EndNodes\n$Elements\n{len(elements)}\n{rows}\n$EndElements\n"
    )


class SkewMesh(harness.CaseTest):
    def test_prisms_around_an_axis(self):
        mesh = self.work / "ball.msh"
        mesh.write_text(ball())
        judged = harness.snag(["mesh", "--info", mesh])
        self.assertEqual(judged.code, 0, judged.tail())
        self.assertIn("skew cells", judged.stdout)
        run = self.run_case(self.case(CASE.format(mesh=mesh)), 2)
        courant = run.monitor("residuals").column("courant_max")
        print(f"  Courant number {courant[0]:.3g} at the start, at most {courant.max():.3g}, {courant[-1]:.3g} at the end")
        self.assertLess(courant.max(), 20)
        self.assertLess(abs(courant[-1] - courant[-10]), 0.01 * courant[-1], "it settles")


if __name__ == "__main__":
    harness.main()
