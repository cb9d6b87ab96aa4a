# labels: long
# timeout: 3600
# cost: 250
"""Requirement: the drag of a plate that bends in a wind tunnel, two-way, is the measured one within 15 % at 5 m/s; at 9 and 13 m/s, where its halves lie nearly along the stream, the
model gives too much, and not more than now. Gosselin, de Langre and Machado-Almeida (2010), J. Fluid Mech. 650, 319-341, plate R16."""
import tomllib

import harness
import numpy

FOLDER = harness.SOURCE_DIR / "cases" / "held-cloth"
LIMITS = {5: 0.15, 9: 0.20, 13: 0.50}  # by speed, m/s


class PlateInATunnel(harness.CaseTest):
    def test_drag(self):
        measured = tomllib.loads((FOLDER / "measured.toml").read_text())["plate_R16"]
        for speed, limit in LIMITS.items():
            settings = (f"flow.initial_velocity_m_s=[{speed},0,0]", f"boundary.0.velocity_m_s=[{speed},0,0]", f"time.step_s={0.01 / speed}", f"time.end_s={1.5 / speed}")
            words = [word for s in settings for word in ("--set", s)]
            run = self.run_case(FOLDER / "tunnel.toml", 1, *words, out=f"{speed}", timeout=1800)
            drag = -run.monitor("holds").column("force_x")[-1]
            exact = numpy.exp(numpy.interp(numpy.log(speed), numpy.log(measured["speed_m_s"]), numpy.log(measured["drag_N"])))
            print(f"  {speed} m/s: drag {drag:.4f} N, measured {exact:.4f} N, off by {100 * (drag / exact - 1):+.0f} %", flush=True)
            with self.subTest(speed=speed):
                self.assertLess(abs(drag / exact - 1), limit)


if __name__ == "__main__":
    harness.main()
