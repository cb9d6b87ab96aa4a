# timeout: 300
# cost: 30
# processors: 3
"""Requirement: many rags are kept apart and counted, alike on any number of ranks: 81 that fall into a box (240 in many_rags_long.py) touch each other and
come to rest as a heap; those released one after the other leave the mesh as whole objects, also after a resume."""
import math

import harness
import numpy
from small_cases import CHANNEL, COARSE_CHANNEL_MESH

RELEASED = """copies = 3
copy_interval_ms = 8
copy_step_m = [0, 0.002, 0]
release_patch = "outlet"
release_depth_mm = 25
release_spread = 0.3
velocity_m_s = [0.5, 0, 0]
"""

# Five sheets rolled up about z, one above the other and one after the other.
ROLLED = """copies = 5
copy_interval_ms = 20
copy_step_m = [0, 0.019, 0]
centre_m = [0.275, 0.015, 0.05]
pose_file = "rolled.csv"
velocity_m_s = [0.5, 0, 0]
"""

# A square of columns of sheets. Those of neighbouring columns stand across each other, and all move sideways and turn as they fall.
PILE = """
[case]
name = "pile"
[time]
end_s = 0.18
step_ms = 4
[gravity]
acceleration_m_s2 = [0, 0, -9.81]
[contact]
impact_speed_m_s = 3
[[wall]]
kind = "box"
lower_m = [-{half_width}, -{half_width}, 0]
upper_m = [{half_width}, {half_width}, 0.5]
[output]
report = false
rags_interval_ms = 60
"""
PILE_COLUMN = """
[[rag]]
name = "column {number}"
length_mm = 32
width_mm = 24
radius_mm = 2
breakage = true
centre_m = [{x}, {y}, 0.022]
lengthwise = {lengthwise}
crosswise = {crosswise}
velocity_m_s = {velocity}
spin_rad_s = {spin}
copies = {layers}
copy_step_m = [0, 0, 0.012]
"""
N_IN_SHEET, N_BONDS, RADIUS, SPACING = 48, 82, 0.002, 0.039  # spacing of the columns, m
SHEET_MASS = 0.785 * N_IN_SHEET * (2 * RADIUS) ** 2  # kg, by the default mass_per_area
CLOSEST_PACKING = math.pi / math.sqrt(18)  # of equal spheres, share of the space


def half_width(side):
    """Of the box, m."""
    return round(0.002 + 0.5 * side * SPACING, 4)


def pile(side, layers):
    text = PILE.format(half_width=half_width(side))
    for i in range(side):
        for j in range(side):
            along_x, sign, other_sign = (i + j) % 2 == 0, (-1) ** i, (-1) ** j
            text += PILE_COLUMN.format(
                number=side * i + j, layers=layers, x=round((i - 0.5 * (side - 1)) * SPACING, 4), y=round((j - 0.5 * (side - 1)) * SPACING, 4),
                lengthwise=[1, 0, 0.5] if along_x else [0, 1, 0.5], crosswise=[0, 1, 0.2] if along_x else [1, 0, 0.2],
                velocity=[round((0.3 - 0.2 * i) * other_sign, 1), 0.4 * sign, -1.5], spin=[20 * sign * other_sign, -20 * sign, 0])
    return text


def largest_heap(rag_pairs, n_rags):
    """Number of rags that hang together by their contacts."""
    heap = numpy.arange(n_rags)
    for one, other in rag_pairs:
        heap[heap == heap[one]] = heap[other]
    return numpy.bincount(heap).max()


class PileTest(harness.CaseTest):
    side, layers = 3, 9  # columns in a row, sheets above each other
    deepest = 0.3  # overlap over radius: the more layers land on each other, the deeper

    @classmethod
    def setUpClass(cls):
        cls.n_piled = cls.side**2 * cls.layers
        super().setUpClass()

    def fall(self, ranks=1, *arguments):
        return self.run_once(self.case(pile(self.side, self.layers), "pile"), ranks, *arguments)


class Pile(PileTest):
    """How many touch is counted here from the places of the particles, not taken from the program."""

    def setUp(self):
        super().setUp()
        self.done = self.fall()

    def test_every_rag_is_kept_whole(self):
        summary = self.done.summary
        self.assertEqual(len({rag["name"] for rag in summary["rags"]}), self.n_piled)
        for rag in summary["rags"]:
            self.assertEqual((rag["particles"], rag["bonds"], rag["broken_bonds"], rag["outcome"]), (N_IN_SHEET, N_BONDS, 0, "in_domain"))
            self.assertLess(rag["max_wall_overlap_over_radius"], 0.2)
            self.assertLess(rag["max_overlap_over_radius"], self.deepest)
        for name in ("particles_lost", "bonds_lost", "particles_beyond_walls"):
            self.assertEqual(summary["conservation"][name], 0, name)
        files = sorted((self.done.folder / "rags").glob("particles_*.vtp"))
        self.assertEqual(len(files), 4)
        for file in files:
            position, rag = harness.particles(file)
            numpy.testing.assert_array_equal(numpy.bincount(rag), numpy.full(self.n_piled, N_IN_SHEET), file.name)
            self.assertLess(numpy.abs(position[:, :2]).max(), half_width(self.side))
            self.assertGreater(position[:, 2].min(), 0)

    def test_they_touch_each_other(self):
        contacts = self.done.monitor("contacts")
        position, rag = harness.particles(max((self.done.folder / "rags").glob("particles_*.vtp")))
        # A particle of radius r lies one layer thickness, 2 r, above another cloth. Along the cloth, the nearest of its particles is at most
        # sqrt(2) r away. So their distance is at most sqrt(4 + 2) r.
        touching = harness.touching_particles(position, rag, math.sqrt(6) * RADIUS)
        rag_pairs = numpy.unique(touching, axis=0)
        n_touching, heap = len(numpy.unique(rag_pairs)), largest_heap(rag_pairs, self.n_piled)
        in_pile = contacts.column("contacts")[contacts.column("time") > 0.08]
        print(f"  at the end {n_touching} of {self.n_piled} rags touch another, {len(rag_pairs)} pairs of rags at {len(touching)} pairs of particles, "
              f"{heap} rags in one heap; monitor: {in_pile[-1]:.0f} contacts, never below {in_pile.min():.0f} after 0.08 s, "
              f"overlap {contacts.column('overlap_over_radius_max').max():.2f} r")
        self.assertGreater(n_touching, 0.95 * self.n_piled)
        self.assertGreater(len(rag_pairs), 1.25 * self.n_piled)  # each rag touches two and a half others in the mean
        self.assertGreater(heap, 0.9 * self.n_piled)
        self.assertGreater(in_pile.min(), 10 * self.n_piled)

    def test_they_lie_on_each_other(self):
        """Spheres that keep apart cannot be packed closer than CLOSEST_PACKING, so their mean height has a least value."""
        position, _ = harness.particles(max((self.done.folder / "rags").glob("particles_*.vtp")))
        least = 0.5 * len(position) * 4 / 3 * math.pi * RADIUS**3 / CLOSEST_PACKING / (2 * half_width(self.side)) ** 2
        print(f"  mean height {1000 * position[:, 2].mean():.1f} mm, of the closest packing {1000 * least:.1f} mm")
        self.assertGreater(position[:, 2].mean(), least)
        self.assertLess(position[:, 2].mean(), 4 * least, "the rags have not come down")

    def test_energy_is_only_lost(self):
        rags = self.done.monitor("rags")
        of_a_step = lambda values: values.reshape(-1, self.n_piled)  # [step][rag]
        kinetic = of_a_step(rags.column("kinetic_energy"))
        whole = kinetic + of_a_step(rags.column("bond_energy")) + SHEET_MASS * 9.81 * of_a_step(rags.column("z"))
        total = whole.sum(axis=1)
        print(f"  energy from {total[0]:.3g} to {total[-1]:.3g} J, largest rise in a step {numpy.diff(total).max() / total[0]:.1e} of it; kinetic from "
              f"{kinetic.sum(axis=1).max():.3g} to {kinetic.sum(axis=1)[-1]:.3g} J, of one rag at most {kinetic.max():.2g} of {whole[0].max():.2g} J")
        self.assertLess(numpy.diff(total).max(), 1e-3 * total[0])
        self.assertLess(kinetic.sum(axis=1)[-1], 0.01 * kinetic.sum(axis=1).max())
        self.assertLess(kinetic.max(), whole[0].max(), "a rag is faster than its fall can make it")
        self.assertLess(rags.column("bond_strain_max").max(), 0.05)


class PileOnRanks(PileTest):
    layers = 4

    @harness.parallel
    def test_the_same_on_three_ranks(self):
        """The fall and the impacts, one rank's rags among those of the others."""
        one, three = (self.fall(ranks, "--set", "time.end_s=0.06") for ranks in (1, 3))
        self.assertGreater(three.monitor("contacts").column("contacts").max(), 10 * self.n_piled)
        for name in ("rags", "contacts"):
            self.assertEqual(three.monitor(name).column("time")[-1], 0.06)
            self.assert_monitors_agree(one, three, name, 1e-12)


class ManyRags(harness.CaseTest):
    def channel(self, released=RELEASED, end=0.1):
        text = CHANNEL.format(mesh=self.mesh(*COARSE_CHANNEL_MESH), kernel="gaussian")
        rag = "length_mm = 60\nwidth_mm = 40\nradius_mm = 2\ncentre_m = [0.08, 0.05, 0.05]\nlengthwise = [0.3, 0.2, 0.9]\n"
        self.assertIn(rag, text)
        return self.case(text.replace(rag, "name = \"small\"\nlength_mm = 40\nwidth_mm = 24\nradius_mm = 2\nlengthwise = [0, 0, 1]\ncrosswise = [0, 1, 0]\n" + released)
                         .replace("end_s = 0.05", f"end_s = {end}") + "[checkpoint]\ninterval_s = 0.03\n")

    @harness.parallel
    def test_leave_as_whole_objects(self):
        case = self.channel()
        runs = [self.run_once(case, ranks) for ranks in (1, 2)]
        for run in runs:
            self.assertEqual([rag["name"] for rag in run.summary["rags"]], ["small 1", "small 2", "small 3"])
            for rag in run.summary["rags"]:
                self.assertEqual(rag["outcome"], "exited")
                self.assertEqual((rag["particles"], rag["bonds"], rag["broken_bonds"]), (60, 104, 0))
                self.assertGreaterEqual(rag["elongation_ratio"], 1)
                self.assertIn(f"{rag['name']}: left the mesh as a whole", run.stdout)
            self.assertEqual(run.summary["conservation"]["particles_lost"], 0)
            self.assertEqual(run.summary["conservation"]["bonds_lost"], 0)
            time, rag = run.monitor("rags").column("time"), run.monitor("rags").column("rag")
            ends = [time[rag == r].max() for r in range(3)]
            self.assertTrue(0.02 < ends[0] < ends[1] < ends[2] < 0.1, ends)
            starts = [time[rag == r].min() for r in range(3)]
            for r in (1, 2):
                self.assertAlmostEqual(starts[r] - starts[0], 0.008 * r, places=9)
        self.assert_monitors_agree(*runs, "rags", 1e-6)

    @harness.parallel
    def test_poses_from_a_file_leave_as_whole_objects(self):
        n_columns, n_rows, radius, arc = 10, 6, 0.002, 0.007  # arc: radius of the roll, m
        turn = 2 * math.asin(radius / arc)  # between neighbours, which stay a diameter apart
        rows = ["id,x,y,z,qw,qx,qy,qz"]
        for row in range(n_rows):
            for column in range(n_columns):
                angle = (column - (n_columns - 1) / 2) * turn
                rows.append(f"{row * n_columns + column},{arc * math.sin(angle)},{-arc * math.cos(angle)},{(row - (n_rows - 1) / 2) * 2 * radius},"
                            f"{math.cos(angle / 2)},0,0,{math.sin(angle / 2)}")
        (self.work / "rolled.csv").write_text("\n".join(rows) + "\n")
        # Rag k is put in at 20 k ms, unrolls, and is gone some 84 ms later.
        run = self.run_case(self.channel(released=ROLLED, end=0.132).rename(self.work / "rolled.toml"), 2, "--set", "output.rags_interval_ms=5")
        self.assertEqual([rag["outcome"] for rag in run.summary["rags"]], ["exited"] * 3 + ["in_domain"] * 2)
        for rag in run.summary["rags"]:
            self.assertEqual((rag["particles"], rag["bonds"], rag["broken_bonds"]), (60, 104, 0))
        self.assertEqual((run.summary["conservation"]["particles_lost"], run.summary["conservation"]["bonds_lost"]), (0, 0))
        time, rag = run.monitor("rags").column("time"), run.monitor("rags").column("rag")
        n_seen = []
        for file in sorted((run.folder / "rags").glob("particles_*.vtp"))[1:]:
            position, of_rag = harness.particles(file)
            now = float(harness.arrays(harness.read_vtk(file).GetFieldData())["TimeValue"][0])
            there = rag[numpy.abs(time - now) < 1e-9].astype(int)
            n_seen.append(len(there))
            numpy.testing.assert_array_equal(numpy.bincount(of_rag, minlength=5), [60 * (r in there) for r in range(5)], file.name)
        print(f"  rags in the mesh, every 5 ms: {n_seen}")
        self.assertGreaterEqual(max(n_seen), 3)
        self.assertEqual(n_seen[-1], 2)

    @harness.parallel
    def test_resume_after_some_have_left(self):
        case = self.channel()
        last = lambda run: sorted((run.folder / "rags").glob("*_000100.vtp"))
        whole = self.run_once(case, 2)
        resumed = self.crashed_and_resumed(whole, case, lambda run: [], 0.09)
        self.assert_equal_to_the_bit(whole, resumed, last)
        self.assertEqual(whole.summary["rags"], resumed.summary["rags"])

    @harness.parallel
    def test_release_needs_its_patch(self):
        for old, new, code, message in (('release_patch = "outlet"', 'release_patch = "out"', 3, "outlet"),
                                        ('release_patch = "outlet"\n', "", 2, "release_patch")):
            case = self.channel()
            case.write_text(case.read_text().replace(old, new))
            run = self.run_case(case, 2, code=code)
            self.assertIn(message, "\n".join(run.messages))
            self.assertEqual(len(run.messages), 1, run.messages)


if __name__ == "__main__":
    harness.main()
