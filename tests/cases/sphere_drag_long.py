# labels: long
# timeout: 7200
# cost: 2600
"""Requirement: sphere_drag.py for Reynolds numbers of 0.1 to 100, spheres of a fifth of a cell to eight cells, four kernels, and both distances from a wall."""
import harness
import sphere_drag


class SphereDragLong(sphere_drag.SphereDrag):
    def test_in_a_stream(self):
        for Re, bound in ((0.1, 0.02), (1, 0.01), (10, 0.02), (100, 0.03)):
            for per_cell, width in ((0.2, 10), (1, 2), (2, 1), (4, 1)):
                self.check(bound, Re, per_cell, width=width)
            self.check(bound, Re, 8, far=30, diameters=15)
        for Re, bound in ((0.1, 0.02), (1, 0.01), (10, 0.02), (100, 0.03)):
            self.check(bound, Re, 2, kernel="wendland")
        self.check(0.01, 1, 8, kernel="wendland", far=20, diameters=15)

    def test_in_a_stream_by_points_and_by_diffusion(self):
        for Re, bound in ((0.1, 0.02), (1, 0.01), (10, 0.02), (100, 0.03)):
            for per_cell, width in ((0.2, 10), (1, 2), (2, 1)):
                for kernel in ("satellite", "diffusion"):
                    # Points that lie apart need steps in which friction crosses few cells: pressure answers to each of them by itself.
                    steps = 900 if kernel == "satellite" and per_cell > 1 else 300
                    self.check(bound, Re, per_cell, width=width, kernel=kernel, far=20 if width < 10 else 55, steps=steps, diameters=15)
        self.check(0.01, 1, 4, kernel="satellite", far=20, steps=900, diameters=15)
        for per_cell in (4, 8):
            self.check(0.01, 1, per_cell, kernel="diffusion", far=20, diameters=15)

    def test_along_a_wall(self):
        forces = ("schiller_naumann", "self_disturbance", "wall")
        for wall in (1, 3):
            for kernel, width in (("gaussian", 1), ("gaussian", 2), ("wendland", 1), ("diffusion", 1)):
                self.check(0.05, 0.005, 2, width=width, wall=wall, far=30, steps=120, kernel=kernel, forces=forces)
            self.check(0.05, 0.005, 2, wall=wall, far=30, steps=120 if wall == 1 else 1920, kernel="satellite", forces=forces)

    def test_the_cell_kernel_stays_finite(self):
        for Re in (0.1, 1, 100):
            for per_cell in (1, 4, 8):
                print(f"  cell kernel, Re {Re}, {per_cell} cells: {100 * self.error(Re, per_cell, kernel='cell', far=20, steps=100, diameters=10):+.0f} %", flush=True)


if __name__ == "__main__":
    harness.main()
