# labels: long
# timeout: 1800
"""Requirement: the same on cells of half the size."""
import harness
import impulsive_sheet


class ImpulsiveSheetOnFineCells(impulsive_sheet.SheetSetInMotion):
    def test_disc(self):
        self.assertLess(abs(self.disc(0.00625) - 1), 0.10)

    def test_strip(self):
        self.assertLess(abs(self.strip(0.00625) - 1), 0.10)


if __name__ == "__main__":
    harness.main()
