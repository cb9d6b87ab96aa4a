# timeout: 300
# processors: 3
"""Requirement: rags released one after the other at a patch leave the mesh as whole objects, all counted, alike on 1 and 3 ranks and after a resume."""
import harness
from small_cases import CHANNEL, CHANNEL_MESH

RELEASED = """copies = 3
copy_interval_ms = 8
copy_step_m = [0, 0.002, 0]
release_patch = "outlet"
release_depth_mm = 25
release_spread = 0.3
velocity_m_s = [0.5, 0, 0]
"""


class ManyRags(harness.CaseTest):
    def channel(self, more=""):
        text = CHANNEL.format(mesh=self.mesh(*CHANNEL_MESH), kernel="gaussian")
        rag = "length_mm = 60\nwidth_mm = 40\nradius_mm = 2\ncentre_m = [0.08, 0.05, 0.05]\nlengthwise = [0.3, 0.2, 0.9]\n"
        self.assertIn(rag, text)
        return self.case(text.replace(rag, "name = \"small\"\nlength_mm = 40\nwidth_mm = 24\nradius_mm = 2\nlengthwise = [0, 0, 1]\ncrosswise = [0, 1, 0]\n" + RELEASED)
                         .replace("end_s = 0.05", "end_s = 0.1") + more)

    def test_leave_as_whole_objects(self):
        case = self.channel()
        runs = [self.run_case(case, ranks, out=f"ranks-{ranks}") for ranks in (1, 3)]
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

    def test_resume_after_some_have_left(self):
        case = self.channel("[checkpoint]\ninterval_s = 0.03\n")
        last = lambda run: sorted((run.folder / "rags").glob("*_000100.vtp"))
        whole, resumed = self.crashed_and_resumed(case, 2, lambda run: [], 0.09)
        self.assert_equal_to_the_bit(whole, resumed, last)
        self.assertEqual(whole.summary["rags"], resumed.summary["rags"])

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
