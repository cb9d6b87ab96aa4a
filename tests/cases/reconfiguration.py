# timeout: 300
# cost: 35
"""Requirement: a plate that is clamped along its middle line across a prescribed stream bends and drags as the elastica does, from a nearly rigid plate to one whose halves lie
along the stream; the error of a coarser lattice falls with its spacing. A sector of a cut disc, which is wider at its tip, does the same."""
import math
import tomllib

import cut_disc
import elastica
import expected
import harness

FOLDER = harness.SOURCE_DIR / "cases" / "held-cloth"
LENGTH, WIDTH, DENSITY, DRAG = 0.10125, 0.00375, 1000.0, 1.17  # m, m, kg/m3, C_D
FINE = 0.625e-3  # radius of the particles of the case, m
STIFFNESS = DRAG * DENSITY * LENGTH**3 / 16 / 10  # bending stiffness per width, N m: C = 10 at 1 m/s
# C = C_D C_Y, and the time in which the plate comes to rest, s: drag against bending where it is small, length over speed where it is large.
PLATES = {0.1: 0.14, 1: 0.2, 10: 0.5, 100: 0.12, 1000: 0.06}


class Reconfiguration(harness.CaseTest):
    def drag(self, run, speed):
        """Of the plate at the end, over that of a rigid one."""
        return -run.monitor("holds").column("force_x")[-1] / (0.5 * DENSITY * LENGTH * WIDTH * DRAG * speed**2)

    def plate(self, C, *settings):
        """Run of the case and R at a speed that gives C."""
        speed = math.sqrt(C / 10)
        words = [word for s in (f"flow.velocity_m_s=[{speed!r},0,0]", f"time.end_s={PLATES[C]}", "output.report=false", *settings) for word in ("--set", s)]
        run = self.run_case(FOLDER / "case.toml", 1, *words, out=f"{len(list(self.work.iterdir()))}")
        return run, self.drag(run, speed)

    def lattice(self, columns):
        """Settings for the same plate of other particles: its stiffness per width and its length stay."""
        radius = LENGTH / columns / 2
        bonds = {"bending": 4 * STIFFNESS / (math.pi * radius**4), **dict.fromkeys(("normal", "tangential"), 1.6e10 * (FINE / radius) ** 2)}
        stiffness = [f"rag.0.{kind}_stiffness_{way}wise_N_m3={value!r}" for kind, value in bonds.items() for way in ("length", "cross")]
        return f"rag.0.radius_m={radius!r}", f"rag.0.width_m={6 * radius!r}", f"hold.0.columns=[{columns // 2},{columns // 2}]", *stiffness

    def test_plates_have_the_drag_of_the_elastica(self):
        self.assertLess(abs(elastica.reconfiguration(1e-6) - 1), 1e-5, "a stiff plate")
        for C in PLATES:
            run, drag = self.plate(C)
            if C == 10:  # the case as it stands
                expected.assert_entries(self, run.summary, tomllib.loads((FOLDER / "expected.toml").read_text())["expect"])
            exact = elastica.reconfiguration(C)
            print(f"  C = {C:g}: R {drag:.5f}, elastica {exact:.5f}, off by {100 * (drag / exact - 1):+.2f} %", flush=True)
            with self.subTest(C=C):
                self.assertLess(abs(drag / exact - 1), 5e-3 if C == 1000 else 2e-3)

    def error(self, columns):
        """Of R at C = 10, of a plate of so many columns."""
        run, _ = self.plate(10, *self.lattice(columns))
        drag = -run.monitor("holds").column("force_x")[-1] / (0.5 * DENSITY * 3 * LENGTH**2 / columns * DRAG)
        error = drag / elastica.reconfiguration(10) - 1
        print(f"  {columns} columns: R {drag:.5f}, deviation {100 * error:+.2f} %")
        return error

    def test_error_falls_with_the_spacing(self):
        order = math.log(self.error(15) / self.error(27)) / math.log(27 / 15)
        print(f"  order {order:.2f}")
        self.assertGreater(order, 1.7)


class SectorOfADisc(harness.CaseTest):
    """Gosselin, de Langre and Machado-Almeida (2010): disc D3 at the largest C that was measured; reconfiguration_long has whole discs."""

    def sector(self, across):
        """The piece, its run, and the error of R at C = 500, of a sector of so many particles across its clamp."""
        piece = cut_disc.Disc(0.037).sector(500, across, 0.1)
        run, exact = self.run_case(self.case(piece.text, f"{across}"), out=f"{across}"), elastica.reconfiguration(500, taper=piece.taper)
        drag = piece.reconfiguration(run)
        print(f"  {across} particles across the clamp: R {drag:.4f}, elastica {exact:.4f}, deviation {100 * (drag / exact - 1):+.1f} %", flush=True)
        return piece, run, drag / exact - 1

    def test_sector_has_the_drag_of_the_elastica(self):
        self.assertLess(abs(elastica.reconfiguration(1e-6, taper=4) - 1), 1e-5, "a stiff sector")
        coarse, fine = (self.sector(across)[2] for across in (3, 6))
        order = math.log2(coarse / fine)
        print(f"  order {order:.2f}")
        self.assertLess(abs(fine), 0.03)
        self.assertGreater(order, 1.3)


if __name__ == "__main__":
    harness.main()
