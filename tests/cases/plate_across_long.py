# labels: long
# timeout: 7200
# cost: 3200
"""Requirement: plate_across.py for more kernels, widths, meshes, steps, particles and loss coefficients, over up to 60 times the plate's side over the speed."""
import harness
import numpy
import plate_across


class PlateAcrossLong(plate_across.SheetInAStream):
    def compare(self, what, value, expected, tolerance):
        print(f"  {what}: {value:.3f}, expected {expected:.3f}, off by {100 * (value / expected - 1):+.1f} %", flush=True)
        with self.subTest(what):
            self.assertLess(abs(value / expected - 1), tolerance)

    def test_nearly_closed_sheet(self):
        rigid = self.plate(6)
        for delta in (0.006, 0.012):
            drag = self.sheet_drag(1000, delta, 6)
            self.assert_smooth(drag, 0.15)
            self.compare(f"K 1000, kernel {1e3 * delta:g} mm, 1 to 6 s", self.mean(drag, 1, 6), self.mean(rigid, 1, 6), 0.10)
        # A quarter of the plate is too wide for the law, and the run says so.
        wide = self.sheet(1000, 0.024, 3)
        self.assertIn("advised at most 0.125", wide.stdout + wide.stderr)
        drag = self.mean(self.coefficient(wide, "force_on_rags_x [N]"), 1, 3)
        print(f"  K 1000, kernel 24 mm, 1 to 3 s: {drag:.3f}, rigid {self.mean(rigid, 1, 3):.3f}, off by {100 * (drag / self.mean(rigid, 1, 3) - 1):+.1f} %")
        for name, keys in {"wendland": {"kernel": "wendland"}, "diffusion": {"kernel": "diffusion"}, "a quarter of the step": {"step": 0.0015}, "four times the step": {"step": 0.024}, "particles of 1.25 mm": {"radius": 1.25e-3}, "K 1e5": {"K": 1e5}}.items():
            K = keys.pop("K", 1000)
            self.compare(f"K {K:g}, {name}, 0.48 to 0.96 s", self.mean(self.sheet_drag(K, 0.012, 0.96, **keys), 0.48, 0.96), self.mean(rigid, 0.48, 0.96), 0.15)

    def test_finer_mesh(self):
        rigid = self.mean(self.plate(2, 0.004, 0.00625), 0.5, 2)
        for delta in (0.006, 0.012):
            self.compare(f"K 1000, kernel {1e3 * delta:g} mm, cells of 6.25 mm, 0.5 to 2 s", self.mean(self.sheet_drag(1000, delta, 2, 0.004, 0.00625), 0.5, 2), rigid, 0.10)

    def test_cloth_across_a_channel_by_a_narrow_kernel(self):
        self.assertLess(abs(self.across_a_channel(10, 0.008, 0.01, 0.3)[-1] - 1), 0.05)
        self.assertLess(abs(self.across_a_channel(10, 0.008, 0.04, 2)[-1] - 1), 0.02)

    def test_nearly_closed_cloth_across_a_channel(self):
        """It comes to hold 500 times the dynamic pressure of the stream that is forced through it; the eddies behind it leave through the outlet."""
        for delta, bound in ((0.016, 0.02), (0.008, 0.08)):
            flow = self.across_a_channel(1000, delta, 0.01, 7, length=0.4)
            self.assertLess(abs(flow[-1] - 1), bound)
            self.assertTrue((numpy.diff(flow[100:]) < 0.01).all())

    def test_narrowest_kernel(self):
        """One cell: any loss coefficient is stable."""
        for K in (1000, 1e5):
            drag = self.sheet_drag(K, 0, 0.96, kernel="cell")
            self.assert_smooth(drag, 0.15)
            print(f"  cell kernel, K {K:g}: {self.mean(drag, 0.48, 0.96):.3f}, rigid plate {self.mean(self.plate(0.96), 0.48, 0.96):.3f}")

    def test_any_resistance_kernel_and_step(self):
        """Cells of 25 mm: the force neither grows nor rings, once a sudden start has settled. (With `diffusion` of half a cell that takes some 50 steps.)"""
        for kernel in ("cell", "satellite", "gaussian", "wendland", "diffusion"):
            for K in (1, 1000, 1e6):
                for cells in (0.25, 1, 4):
                    step = cells * 0.025 / plate_across.SPEED
                    _, drag = self.sheet_drag(K, 0.012, 100 * step, step, 0.025, kernel=kernel)
                    late, changes = drag[60:], numpy.diff(drag[60:])
                    turns = (changes[1:] * changes[:-1] < 0) & (numpy.abs(changes[1:]) > 0.02 * numpy.abs(late.mean()))
                    print(f"  {kernel}, K {K:g}, {cells} cells a step: {late.mean():.3f}, least {late.min():.3f}, largest {late.max():.3f}", flush=True)
                    with self.subTest(f"{kernel}, K {K:g}, {cells} cells a step"):
                        self.assertTrue((late > 0.2).all() and (late < 3).all())
                        self.assertEqual(turns.sum(), 0)

    def test_porous_sheets(self):
        """Two theories of screens up to K 2, which agree within 1 % there; at K 4 they give 1.00 and 1.09."""
        for K in (0.5, 1, 2):
            for delta in (0.006, 0.012, 0.024):
                drag = self.mean(self.sheet_drag(K, delta, 1.2), 0.9, 1.2)
                for theory in (plate_across.taylor, plate_across.steiros_hultmark):
                    self.compare(f"K {K}, kernel {1e3 * delta:g} mm, {theory.__name__}", drag, theory(K), 0.08)
        for delta in (0.006, 0.012):
            drag = self.mean(self.sheet_drag(4, delta, 1.2), 0.9, 1.2)
            print(f"  K 4, kernel {1e3 * delta:g} mm: {drag:.3f}")
            self.assertTrue(1.00 < drag < 1.17, drag)


if __name__ == "__main__":
    harness.main()
