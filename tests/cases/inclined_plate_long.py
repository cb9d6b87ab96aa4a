# labels: long
# timeout: 7200
# cost: 1500
"""Requirement: inclined_plate.py at five angles, and as a rigid plate in the same mesh within 10 %, for two kernels."""
import harness
import inclined_plate


class InclinedPlateLong(inclined_plate.InclinedPlate):
    def test_angles(self):
        for degrees in inclined_plate.MEASURED:
            rigid = self.compare(degrees, None, 0.15)
            for delta in (0.006, 0.012):
                sheet = self.compare(degrees, delta, 0.15)
                with self.subTest(f"{degrees} degrees, kernel {1e3 * delta:g} mm, rigid plate"):
                    self.assertLess(abs(sheet / rigid - 1), 0.10)


if __name__ == "__main__":
    harness.main()
