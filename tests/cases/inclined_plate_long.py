# labels: long
# timeout: 7200
# cost: 1500
"""Requirement: inclined_plate.py at five angles, and within 10 % of a rigid plate in the same mesh; a kernel of half a cell along the plate within 12 % of the rigid plate, and on cells half as
large at the measurement, too."""
import math

import harness
import inclined_plate


class InclinedPlateLong(inclined_plate.InclinedPlate):
    def test_angles(self):
        for degrees in inclined_plate.MEASURED:
            rigid = self.compare(degrees, None, 0.15)
            for delta, of_measured, of_rigid in ((0.012, 0.15, 0.10), (0.006, math.inf, 0.12)):
                sheet = self.compare(degrees, delta, of_measured)
                with self.subTest(f"{degrees} degrees, kernel {1e3 * delta:g} mm, rigid plate"):
                    self.assertLess(abs(sheet / rigid - 1), of_rigid)

    def test_along(self):
        """Kernels below and above the thickness of the layers, which is 5 Re^(-1/2) of the side."""
        for Re in (1e3, 1e4, 1e5):
            for delta in (0.006, 0.012):
                self.along(Re, delta, 0.10)
        for delta in (0.006, 0.012):
            self.along(1e6, delta, 0.20, turbulent=True)
        friction = [self.along(1e4, 0.012, 0.10, step=12, radius_mm=radius) for radius in (1, 2)]
        self.assertLess(abs(friction[0] / friction[1] - 1), 0.03)


class InclinedPlateInFineCells(inclined_plate.InclinedPlate):
    size, thickness = 0.00625, 0.0025  # m

    def test_narrow_kernel(self):
        for degrees in (30, 45):
            self.compare(degrees, 0.006, 0.15, step=3)


if __name__ == "__main__":
    harness.main()
