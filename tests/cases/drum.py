# labels: long
# timeout: 7200
# processors: 2
"""Requirement: twenty rags that tumble in a closed drum of triangles, against it and each other, keep every particle and every bond over 50
turns, with bonds that may break."""
import math

import harness
import numpy

RADIUS, HALF_LENGTH, SPEED_RPM, TURNS = 0.09, 0.05, 80, 50
N_RAGS, N_PARTICLES, N_BONDS, PARTICLE_RADIUS = 20, 165, 304, 0.002
TURN = 60 / SPEED_RPM  # s
RIM_SPEED = 2 * math.pi * RADIUS / TURN  # m/s
RAG_MASS = 0.785 * N_PARTICLES * (2 * PARTICLE_RADIUS) ** 2  # kg, by the default mass_per_area
DRUM = """
[case]
name = "drum"
[time]
end_s = {end}
step_ms = 10
[gravity]
acceleration_m_s2 = [0, 0, -9.81]
[[wall]]
kind = "stl"
file = "drum.stl"
normals_into_fluid = true
axis = [0, 1, 0]
rotation_speed_rpm = {speed}
[[rag]]
length_mm = 60
width_mm = 44
radius_mm = 2
pose = "confined"
confine_radius_mm = 12
confine_axis = [0, 1, 0]
confine_length_mm = 70
breakage = true
copies = 5
copy_poses = 3
copy_step_m = [0.025, 0, 0]
centre_m = [-0.05, 0, {z}]
"""


def facet(a, b, c):
    u, v = ([q - p for p, q in zip(a, other)] for other in (b, c))
    normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    length = math.sqrt(sum(n * n for n in normal))
    vertices = "".join(f"vertex {x} {y} {z}\n" for x, y, z in (a, b, c))
    return f"facet normal {normal[0] / length} {normal[1] / length} {normal[2] / length}\nouter loop\n{vertices}endloop\nendfacet\n"


def drum():
    """A closed cylinder along y whose normals point inwards, with three lifters as ridges of its wall."""
    n, text = 48, "solid drum\n"
    ring = [(math.cos(t) * r, math.sin(t) * r) for k in range(n) for t, r in [(2 * math.pi * k / n, RADIUS - (0.012 if k % 16 == 0 else 0))]]
    for k in range(n):
        (x0, z0), (x1, z1) = ring[k], ring[(k + 1) % n]
        a, b, c, d = (x0, -HALF_LENGTH, z0), (x1, -HALF_LENGTH, z1), (x1, HALF_LENGTH, z1), (x0, HALF_LENGTH, z0)
        text += facet(a, b, c) + facet(a, c, d) + facet((0, -HALF_LENGTH, 0), b, a) + facet((0, HALF_LENGTH, 0), d, c)
    return text + "endsolid drum\n"


class Drum(harness.CaseTest):
    """The limits are about half of what the drum gives; circulation, rise and contact with the turning wall are zero if it stands still. The
    first turn, in which the rags fall from where they were put, does not count, but for what is summed up over the run."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        (cls.shared / "drum.stl").write_text(drum())
        rows = [DRUM.format(end=TURNS * TURN, speed=SPEED_RPM, z=-0.0375)]
        for z in (-0.0125, 0.0125, 0.0375):  # four rows of five
            text = DRUM.format(end=TURNS * TURN, speed=SPEED_RPM, z=z)
            rows.append(text[text.index("[[rag]]"):])
        case = cls.shared / "drum.toml"
        case.write_text("".join(rows) + "[output]\nreport = false\nrags_interval_ms = 500\n")
        cls.done = harness.snag(["run", case, "--out", cls.shared / "out"], 2, cls.shared / "out", timeout=7000)
        assert cls.done.code == 0, cls.done.tail()
        cls.rags, cls.contacts = cls.done.monitor("rags"), cls.done.monitor("contacts")

    def after_first_turn(self, name):
        """A column of monitors/rags.csv: [step][rag]."""
        return self.rags.column(name).reshape(-1, N_RAGS)[self.contacts.column("time") > TURN]

    def test_nothing_is_lost(self):
        summary = self.done.summary
        self.assertAlmostEqual(summary["simulated_s"], TURNS * TURN, places=9)
        self.assertEqual(len(summary["rags"]), N_RAGS)
        print(f"  {summary['wall_s']:.0f} s, {summary['performance']['dem_particle_steps_per_s']:.3g} particle-steps/s, "
              f"overlap {max(rag['max_overlap_over_radius'] for rag in summary['rags']):.2f} r, "
              f"strain p99 {max(rag['bond_strain_p99'] for rag in summary['rags']):.3f}")
        for rag in summary["rags"]:
            self.assertEqual((rag["particles"], rag["bonds"], rag["broken_bonds"]), (N_PARTICLES, N_BONDS, 0))
        for name in ("particles_lost", "bonds_lost", "particles_beyond_walls"):
            self.assertEqual(summary["conservation"][name], 0, name)

    def test_rags_touch_each_other_and_the_drum(self):
        late = self.contacts.column("time") > TURN
        for name in ("contacts", "wall_contacts"):
            count = self.contacts.column(name)[late]
            print(f"  {name}: more than {numpy.quantile(count, 0.1):.0f} in nine steps of ten, median {numpy.median(count):.0f}")
            self.assertGreater(numpy.quantile(count, 0.1), 3 * N_RAGS, name)
        # The monitor also counts contacts of a rag with itself; in pictures, every half second, they can be told apart.
        n_touching = []
        for file in sorted((self.done.folder / "rags").glob("particles_*.vtp")):
            position, rag = harness.particles(file)
            if float(harness.arrays(harness.read_vtk(file).GetFieldData())["TimeValue"][0]) > TURN:
                n_touching.append(len(numpy.unique(harness.touching_particles(position, rag, 2 * PARTICLE_RADIUS))))
        print(f"  rags that touch another, in {len(n_touching)} pictures: {min(n_touching)} to {max(n_touching)}, median {numpy.median(n_touching):.0f}")
        self.assertGreaterEqual(len(n_touching), 1.4 * (TURNS - 1))
        self.assertGreaterEqual(numpy.median(n_touching), 0.6 * N_RAGS)
        self.assertGreaterEqual(numpy.quantile(n_touching, 0.1), 0.4 * N_RAGS)
        on_moving_wall = [rag["wall_contact_by_zone_s"]["impeller"] for rag in self.done.summary["rags"]]
        print(f"  each rag touches the turning wall {min(on_moving_wall) / TURNS / TURN:.2f} to {max(on_moving_wall) / TURNS / TURN:.2f} of the time")
        self.assertGreater(min(on_moving_wall), 0.1 * TURNS * TURN)

    def test_rags_are_carried_round(self):
        x, z, vx, vz = (self.after_first_turn(name) for name in ("x", "z", "vx", "vz"))
        circulation = (z * vx - x * vz).mean() / (RADIUS * RIM_SPEED)  # 1: all move with the rim; positive: the way the drum turns
        rise = z.max(axis=0) - z.min(axis=0)
        above_axis = (z > 0).sum(axis=1).mean()
        height = numpy.median(self.after_first_turn("z_max").max(axis=1) - self.after_first_turn("z_min").min(axis=1))
        kinetic = self.after_first_turn("kinetic_energy").mean() / (0.5 * RAG_MASS * RIM_SPEED**2)
        print(f"  mean circulation {circulation:.2f} of the rim's, kinetic energy {kinetic:.2f} of that at the rim's speed, rags above the axis "
              f"{above_axis:.1f}, height over all rags {height / RADIUS:.2f} R, centres rise by {rise.min() / RADIUS:.2f} R and more")
        self.assertGreater(circulation, 0.15)
        self.assertGreater(kinetic, 0.3)
        self.assertGreater(above_axis, 0.1 * N_RAGS)
        self.assertGreater(height, 1.2 * RADIUS)
        self.assertGreater(rise.min(), 0.7 * RADIUS, "a rag stayed where it was")


if __name__ == "__main__":
    harness.main()
