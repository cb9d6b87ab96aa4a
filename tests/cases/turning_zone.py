# timeout: 600
# processors: 3
# cost: 16
"""Requirement: a run with a turning zone and a turbulence model agrees to 1e-6 on any number of ranks, and one resumed in mid-turn equals the uninterrupted one to the bit on the same ranks."""
import math

import numpy

import harness
from small_cases import pump_case, tight_flow

STEP = 1e-3  # s
START = "initial_k_m2_s2 = 0.01\ninitial_epsilon_m2_s3 = 0.1\n"
RING_WALLS = '["impeller_walls", "walls"]'

SURFACES = {"interface_rotor": 1, "interface_stator": 2, "inlet": 3, "outlet": 4, "impeller_walls": 5, "walls": 6}
INNER, RADIUS, OUTER, HEIGHT, TOP = 0.03, 0.05, 0.08, 0.04, 0.06  # m


class RingMesh:
    """Hexahedra of rings about z; a gmsh file. Zone 1 turns."""

    def __init__(self):
        self.nodes, self.elements = [], []

    def add(self, zone, size, cells, patch, gap=lambda i, j, k: False):
        (r0, r1, z0, z1, start), (n, n_r, n_z), first = size, cells, len(self.nodes) + 1
        for k in range(n_z + 1):
            for j in range(n_r + 1):
                for i in range(n):
                    angle, r = start + 2 * math.pi * i / n, r0 + (r1 - r0) * j / n_r
                    self.nodes.append((r * math.cos(angle), r * math.sin(angle), z0 + (z1 - z0) * k / n_z))
        node = lambda i, j, k: first + i % n + n * (j + (n_r + 1) * k)
        inside = lambda i, j, k: 0 <= j < n_r and 0 <= k < n_z and not gap(i % n, j, k)
        sides = [((0, 3, 7, 4), (0, -1, 0), "r0"), ((1, 2, 6, 5), (0, 1, 0), "r1"), ((0, 1, 2, 3), (0, 0, -1), "z0"),
                 ((4, 5, 6, 7), (0, 0, 1), "z1"), ((0, 1, 5, 4), (-1, 0, 0), None), ((3, 2, 6, 7), (1, 0, 0), None)]
        for k in range(n_z):
            for j in range(n_r):
                for i in range(n):
                    if not inside(i, j, k):
                        continue
                    c = [node(i + a, j + b, k + h) for h in (0, 1) for a, b in ((0, 0), (0, 1), (1, 1), (1, 0))]
                    self.elements.append((5, zone, c))
                    for corners, (a, b, h), rim in sides:
                        if inside(i + a, j + b, k + h):
                            continue
                        at_rim = rim and not (0 <= j + b < n_r and 0 <= k + h < n_z)
                        self.elements.append((3, SURFACES[patch[rim] if at_rim else "impeller_walls"], [c[m] for m in corners]))

    def write(self, file):
        surfaces = {name: tag for name, tag in SURFACES.items() if any(kind == 3 and of == tag for kind, of, _ in self.elements)}
        lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(surfaces) + 2)]
        lines += [f'2 {tag} "{name}"' for name, tag in surfaces.items()] + ['3 1 "rotor"', '3 2 "stator"', "$EndPhysicalNames"]
        lines += ["$Nodes", str(len(self.nodes))] + [f"{i + 1} {x!r} {y!r} {z!r}" for i, (x, y, z) in enumerate(self.nodes)] + ["$EndNodes"]
        lines += ["$Elements", str(len(self.elements))]
        lines += [f"{i + 1} {kind} 2 {tag} {tag} " + " ".join(map(str, nodes)) for i, (kind, tag, nodes) in enumerate(self.elements)]
        file.write_text("\n".join([*lines, "$EndElements", ""]))


class Rings(RingMesh):
    """A turning ring with four blades, where cells are left out, a ring around it and a lid above."""

    def __init__(self):
        super().__init__()
        gaps = lambda i, j, k: j == 1 and i % 4 == 0 and k < 3  # blades
        self.add(1, (INNER, RADIUS, 0, HEIGHT, 0), (16, 3, 4), dict(r0="impeller_walls", r1="interface_rotor", z0="impeller_walls", z1="interface_rotor"), gaps)
        self.add(2, (RADIUS, OUTER, 0, HEIGHT, 0.1), (19, 3, 4), dict(r0="interface_stator", r1="walls", z0="outlet", z1="walls"))
        self.add(2, (INNER, RADIUS, HEIGHT, TOP, 0.1), (19, 3, 2), dict(r0="walls", r1="walls", z0="interface_stator", z1="inlet"))


class TurningZone(harness.CaseTest):
    """26 steps, of which the last six at full speed; turning_zone_long.py has 50 of them, and more numbers of ranks."""

    n_steps, n_before_checkpoint = 26, 16
    ranks = {"sliding": (2, 3), "frame": (2,)}  # that are compared with one rank

    def rings(self, motion="sliding", model="k_epsilon"):
        mesh = self.shared / "rings.msh"
        Rings().write(mesh)
        rotor = f'motion = "{motion}"\nrotation_speed = "1200 rpm"\nramp = "0.02 s"\nstart_angle = "5 deg"'
        return self.case(pump_case(
            "turning-rings", mesh, rotor=rotor, time=f"end_s = {self.n_steps * STEP}\nstep_s = {STEP}", flow=tight_flow("1e-11"),
            flow_rate_L_s=2, walls=RING_WALLS, more=f'[turbulence]\nmodel = "{model}"\n' + ("curvature_correction = true\n" if model == "k_omega_sst" else "") + START,
            output=f"single_precision = false\n[checkpoint]\ninterval_s = {self.n_before_checkpoint * STEP}"), f"{motion}-{model}")

    def agree(self, motion, model="k_epsilon"):
        case = self.rings(motion, model)
        one = self.run_once(case, 1)
        self.assertEqual(one.summary["time_steps"], self.n_steps)
        self.assertGreater(numpy.abs(one.monitor("pump").column("torque")).max(), 1e-3, "the blades must move water, else the case shows nothing")
        self.assertLess(one.summary["conservation"]["interface_closure_rel"], 1e-12)
        for ranks in self.ranks[motion]:
            other = self.run_once(case, ranks)
            for monitor in ("patches", "residuals", "pump"):
                self.assert_monitors_agree(one, other, monitor, 1e-6)

    @harness.parallel
    def test_sliding_on_any_number_of_ranks(self):
        self.agree("sliding")

    @harness.parallel
    def test_sliding_with_sst_on_any_number_of_ranks(self):
        self.agree("sliding", "k_omega_sst")

    @harness.parallel
    def test_frame_on_any_number_of_ranks(self):
        self.agree("frame")

    def crash_and_resume(self, ranks, motion="sliding", model="k_epsilon"):
        def final_fields(run):
            return sorted((run.folder / "fields").glob(f"water_{self.n_steps:06}_*.vtu"))

        case = self.rings(motion, model)
        whole = self.run_once(case, ranks)
        resumed = self.crashed_and_resumed(whole, case, final_fields, self.n_before_checkpoint * STEP)
        self.assert_equal_to_the_bit(whole, resumed, final_fields)

    def test_resume_on_one_rank(self):
        self.crash_and_resume(1)

    @harness.parallel
    def test_resume_on_two_ranks(self):
        self.crash_and_resume(2)

    def test_resume_with_sst(self):
        self.crash_and_resume(1, model="k_omega_sst")

    def test_resume_in_a_frame(self):
        self.crash_and_resume(1, "frame")

    def test_pump_that_cannot_be_meant(self):
        """Walls that stand count as walls of the shaft, and water that leaves through the inlet gives a head of the wrong sign: both are remarked on."""
        case = self.rings()
        check = harness.snag(["check", case, "--set", 'pump.walls=["impeller_walls", "walls"]'])
        self.assertRegex(check.stdout, r'warning: \[pump\] walls: "walls" has \d+ faces outside the rotating zone')
        self.assertNotIn("outside the rotating zone", harness.snag(["check", case]).stdout)
        exchanged = self.run_case(case, 1, "--set", "time.end_s=0.002", "--set", "pump.inlet=outlet", "--set", "pump.outlet=inlet", out="exchanged")
        self.assertIn('warning: [pump]: water leaves through the inlet "outlet"', exchanged.stdout)


if __name__ == "__main__":
    harness.main()
