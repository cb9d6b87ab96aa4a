# labels: long
# timeout: 7200
# processors: 2
"""Requirement: twenty rags in a closed drum of triangles keep every particle and every bond over 50 turns, with bonds that may break."""
import math

import harness

RADIUS, HALF_LENGTH, SPEED_RPM, TURNS = 0.09, 0.05, 80, 50
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
speed_rpm = {speed}
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
    def test_fifty_turns(self):
        end = TURNS * 60 / SPEED_RPM
        (self.work / "drum.stl").write_text(drum())
        rows = [DRUM.format(end=end, speed=SPEED_RPM, z=-0.0375)]
        for z in (-0.0125, 0.0125, 0.0375):  # four rows of five
            text = DRUM.format(end=end, speed=SPEED_RPM, z=z)
            rows.append(text[text.index("[[rag]]"):])
        case = self.case("".join(rows) + "[output]\nreport = false\nrags_interval_ms = 1000\n")
        run = self.run_case(case, 2, timeout=7000)
        summary = run.summary
        self.assertEqual(len(summary["rags"]), 20)
        print(f"  {summary['wall_s']:.0f} s, {summary['performance']['dem_particle_steps_per_s']:.3g} particle-steps/s, "
              f"overlap {max(rag['max_overlap_over_radius'] for rag in summary['rags']):.2f} r, "
              f"strain p99 {max(rag['bond_strain_p99'] for rag in summary['rags']):.3f}")
        for rag in summary["rags"]:
            self.assertEqual((rag["particles"], rag["bonds"], rag["broken_bonds"]), (165, 304, 0))
        for name in ("particles_lost", "bonds_lost", "particles_beyond_walls"):
            self.assertEqual(summary["conservation"][name], 0, name)


if __name__ == "__main__":
    harness.main()
