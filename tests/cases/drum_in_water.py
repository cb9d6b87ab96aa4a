# timeout: 300
# cost: 12
"""Requirement: twenty rags in the water of a closed turning drum, killed and resumed on the way, keep every particle and every bond and stay between the walls; the water and the rags turn with the drum."""
import math
import os
import signal

import harness
import numpy
from turning_zone import RingMesh

RADIUS, INTERFACE, SHAFT, HALF_LENGTH, SPEED_RPM = 0.09, 0.04, 0.02, 0.05, 600  # of the drum, the sliding interface, the shaft at rest; m
STEPS_A_TURN, N_RAGS, N_PARTICLES, N_BONDS = 50, 20, 70, 123
TURN = 60 / SPEED_RPM  # s
DRUM = """
[case]
name = "drum-in-water"
[mesh]
file = "drum.msh"
[time]
end_s = {end}
step_s = {step}
[gravity]
acceleration_m_s2 = [0, -9.81, 0]
[flow]
density_kg_m3 = 998.2
kinematic_viscosity_m2_s = 1e-6
[rotating_zone]
zone = "rotor"
speed_rad_s = "{speed} rpm"
[turbulence]
model = "k_epsilon"
initial_k_m2_s2 = 1e-3
initial_epsilon_m2_s3 = 1e-3
[[boundary]]
patches = ["impeller_walls", "walls"]
kind = "wall"
[[wall]]
kind = "patches"
patches = ["impeller_walls", "walls"]
[coupling]
mode = "two_way"
[output]
report = false
rags_interval_s = {turns_5}
[checkpoint]
interval_s = {half_turn}
"""
RAG = """
[[rag]]
length_mm = 40
width_mm = 28
radius_mm = 2
pose = "confined"
confine_radius_mm = 9
confine_axis = [0, 0, 1]
confine_length_mm = 44
breakage = true
copies = 2
copy_poses = 2
copy_step_m = [0, 0, 0.05]
centre_m = [{x:.5f}, {y:.5f}, -0.025]
"""


class DrumMesh(RingMesh):
    """A drum with three lifters, where cells are left out, around a shaft at rest."""

    def __init__(self):
        super().__init__()
        lifters = lambda i, j, k: j == 2 and i % 8 == 0
        turning = dict(r0="interface_rotor", r1="impeller_walls", z0="impeller_walls", z1="impeller_walls")
        self.add(1, (INTERFACE, RADIUS, -HALF_LENGTH, HALF_LENGTH, 0), (24, 3, 6), turning, lifters)
        self.add(2, (SHAFT, INTERFACE, -HALF_LENGTH, HALF_LENGTH, 0), (24, 2, 6), dict(r0="walls", r1="interface_stator", z0="walls", z1="walls"))


class DrumInWater(harness.CaseTest):
    """Two turns; drum_in_water_long.py makes a thousand of them."""

    n_turns, kills_at = 2, (0.3, 0.7)  # the latter: shares of the steps

    def drum(self):
        DrumMesh().write(self.work / "drum.msh")
        text = DRUM.format(end=self.n_turns * TURN, step=TURN / STEPS_A_TURN, speed=SPEED_RPM, turns_5=5 * TURN, half_turn=TURN / 2)
        angles = (math.radians(7.5 + 36 * k) for k in range(N_RAGS // 2))
        return self.case(text + "".join(RAG.format(x=0.055 * math.cos(a), y=0.055 * math.sin(a)) for a in angles), "drum")

    def run_with_kills(self, case):
        folder = self.work / "out"
        for share in self.kills_at:
            run = harness.start(["run", case, "--out", folder, "--resume" if folder.exists() else "--overwrite"])
            harness.wait_for_records(folder / "monitors" / "contacts.csv", share * self.n_turns * STEPS_A_TURN, run, timeout=self.timeout)
            ranks = harness.program_processes(run)
            for process in ranks:
                os.kill(process, signal.SIGKILL)
            run.communicate()
            for process in ranks:
                harness.wait_for_the_end_of(process)
        return self.run_case(case, 1, "--resume", timeout=self.timeout)

    timeout = 200  # s, of each part

    def test_nothing_is_lost(self):
        run = self.run_with_kills(self.drum())
        self.assertIn("resumed at", run.stdout)
        summary = run.summary
        self.assertEqual(summary["time_steps"], self.n_turns * STEPS_A_TURN)
        self.assertEqual(len(summary["rags"]), N_RAGS)
        for rag in summary["rags"]:
            self.assertEqual((rag["particles"], rag["bonds"], rag["broken_bonds"], rag["outcome"]), (N_PARTICLES, N_BONDS, 0, "in_domain"))
        conservation = summary["conservation"]
        for name in ("particles_lost", "bonds_lost", "particles_beyond_walls"):
            self.assertEqual(conservation[name], 0, name)
        self.assertLess(conservation["momentum_exchange_rel"], 1e-12)
        self.assertLess(conservation["mass_imbalance_rel"], 1e-4, "a closed drum has a scale too")
        rags = run.monitor("rags")
        time, x, y, z, vx, vy = (rags.column(name).reshape(-1, N_RAGS) for name in ("time", "x", "y", "z", "vx", "vy"))
        r = numpy.hypot(x, y)
        self.assertLess(r.max(), RADIUS)
        self.assertGreater(r.min(), SHAFT)
        self.assertLess(numpy.abs(z).max(), HALF_LENGTH)
        late = time[:, 0] > (1 if self.n_turns < 10 else 5) * TURN
        turning = ((x * vy - y * vx) / r**2)[late] / (2 * math.pi / TURN)  # 1: with the drum
        through_interface = ((r[late][1:] > INTERFACE) != (r[late][:-1] > INTERFACE)).sum()
        print(f"  {summary['wall_s']:.0f} s in the last part; overlap {max(rag['max_overlap_over_radius'] for rag in summary['rags']):.2f} r, strain p99 "
              f"{max(rag['bond_strain_p99'] for rag in summary['rags']):.3f}, mass {conservation['mass_imbalance_rel']:.1e}, exchange "
              f"{conservation['momentum_exchange_rel']:.1e}; rags turn at {turning.mean():.2f} of the drum's speed, radius {r[late].min():.3f} to "
              f"{r[late].max():.3f} m, {through_interface} times through the interface")
        self.assertGreater(turning.mean(), 0.1)


if __name__ == "__main__":
    harness.main()
