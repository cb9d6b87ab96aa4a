# labels: long
# timeout: 7200
# cost: 1500
"""Requirement: inclined_plate.py at five angles, and within 10 % of a rigid plate in the same mesh; a kernel of half a cell along the plate within 12 % of the rigid plate."""
import harness
import inclined_plate


class InclinedPlateLong(inclined_plate.InclinedPlate):
    def test_angles(self):
        for degrees in inclined_plate.MEASURED:
            rigid = self.compare(degrees, None, 0.15)
            for delta, of_measured, of_rigid in ((0.012, 0.15, 0.10), (0.006, 0.20, 0.12)):
                sheet = self.compare(degrees, delta, of_measured)
                with self.subTest(f"{degrees} degrees, kernel {1e3 * delta:g} mm, rigid plate"):
                    self.assertLess(abs(sheet / rigid - 1), of_rigid)


if __name__ == "__main__":
    harness.main()
