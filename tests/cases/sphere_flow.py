# cost: 10
# timeout: 600
"""Requirement: the drag of a sphere in a stream at Re 100 is the published one within 3 %, and within 1 % in the limit of fine cells: 1.087 to 1.096 (Clift, Grace and Weber
(1978); Johnson and Patel (1999), J. Fluid Mech. 378, 19-70). A slice of the axisymmetric flow between planes of symmetry, with prisms on the axis."""
import graded_box
import harness
import numpy

SLICE = numpy.radians(10)
CASE = """
[mesh]
file = "{mesh}"
[time]
step_s = 0.5
end_s = 60
[flow]
density_kg_m3 = 1
kinematic_viscosity_m2_s = {viscosity}
initial_velocity_m_s = [1, 0, 0]
n_outer_correctors = 2
[turbulence]
model = "laminar"
[[boundary]]
patch = "sphere"
kind = "wall"
[[boundary]]
patch = "upstream"
kind = "velocity_inlet"
velocity_m_s = [1, 0, 0]
[[boundary]]
patch = "downstream"
kind = "pressure_outlet"
[[boundary]]
patches = ["side0", "side1"]
kind = "symmetry"
[output]
report = false
fields_interval_s = 1000
"""


def write_slice(file, radii, n_polar):
    """Cells about the x axis between two planes; the angle to the axis grows from downstream (0) to upstream."""
    n_r, n_t = len(radii), n_polar + 1
    theta = numpy.linspace(0, numpy.pi, n_t)
    number, places = numpy.zeros((n_r, n_t, 2), int), []
    for i, r in enumerate(radii):
        for j, t in enumerate(theta):
            on_axis = j in (0, n_polar)
            for k in (0, 1):
                if on_axis and k:
                    number[i, j, 1] = number[i, j, 0]
                    continue
                side = (k - 0.5) * SLICE
                rho = 0 if on_axis else r * numpy.sin(t)
                places.append((r * numpy.cos(t), rho * numpy.cos(side), rho * numpy.sin(side)))
                number[i, j, k] = len(places)
    cells, faces = [], {name: [] for name in ("sphere", "upstream", "downstream", "side0", "side1")}

    def distinct(*nodes):
        return list(dict.fromkeys(nodes))

    for i in range(n_r - 1):
        for j in range(n_polar):
            v = {(a, b, k): number[i + a, j + b, k] for a in (0, 1) for b in (0, 1) for k in (0, 1)}
            if j == 0:
                cells.append([v[0, 0, 0], v[0, 1, 0], v[0, 1, 1], v[1, 0, 0], v[1, 1, 0], v[1, 1, 1]])
            elif j == n_polar - 1:
                cells.append([v[0, 0, 0], v[0, 1, 0], v[0, 0, 1], v[1, 0, 0], v[1, 1, 0], v[1, 0, 1]])
            else:
                cells.append([v[0, 0, 0], v[0, 1, 0], v[0, 1, 1], v[0, 0, 1], v[1, 0, 0], v[1, 1, 0], v[1, 1, 1], v[1, 0, 1]])
            for k in (0, 1):
                faces[f"side{k}"].append([v[0, 0, k], v[1, 0, k], v[1, 1, k], v[0, 1, k]])
            if i == 0:
                faces["sphere"].append(distinct(v[0, 0, 0], v[0, 1, 0], v[0, 1, 1], v[0, 0, 1]))
            if i == n_r - 2:
                faces["upstream" if 2 * j >= n_polar else "downstream"].append(distinct(v[1, 0, 0], v[1, 1, 0], v[1, 1, 1], v[1, 0, 1]))
    graded_box.write_cells(file, places, cells, faces)


class SphereFlow(harness.CaseTest):
    def drag(self, reynolds, n_polar, first):
        """C_D of a sphere of 1 m in 1 m/s, far boundary at 30 m, first cells `first` m thick."""
        growth, radii = 1 + 3.2 / n_polar, [0.5]
        while radii[-1] < 30:
            radii.append(radii[-1] + first * growth ** (len(radii) - 1))
        write_slice(self.work / f"slice-{n_polar}.msh", radii, n_polar)
        run = self.run_case(self.case(CASE.format(mesh=self.work / f"slice-{n_polar}.msh", viscosity=1 / reynolds)), 1, out=f"{n_polar}", timeout=300)
        C = run.monitor("patches").column("sphere_force_x") * 2 * numpy.pi / SLICE / (0.5 * numpy.pi / 4)
        print(f"  Re {reynolds:g}, {n_polar} x {len(radii) - 1} cells: C_D {C[-1]:.4f}, ten seconds before {C[-21]:.4f}", flush=True)
        return C[-1]

    def test_drag(self):
        coarse, fine = self.drag(100, 24, 0.016), self.drag(100, 48, 0.008)
        limit = (4 * fine - coarse) / 3  # second order
        for C, tolerance in ((fine, 0.03), (limit, 0.01)):
            self.assertGreater(C, 1.087 * (1 - tolerance))
            self.assertLess(C, 1.096 * (1 + tolerance))


if __name__ == "__main__":
    harness.main()
