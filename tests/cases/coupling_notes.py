# processors: 2
"""Requirement: a run says once what its coupling cannot represent: particles that fill more of a cell than they can, and the water that a sheet moves where the coupling is one-way."""
import harness
from small_cases import CHANNEL, COARSE_CHANNEL_MESH

SPHERE = "[[particle]]\ndiameter_mm = 40\nposition_m = [0.08, 0.05, 0.05]\n"


class CouplingNotes(harness.CaseTest):
    def channel(self, mode):
        text = CHANNEL.format(mesh=self.mesh(*COARSE_CHANNEL_MESH), kernel="cell").replace("end_s = 0.05", "end_s = 0.004")
        self.assertIn('mode = "two_way"', text)
        return text.replace('mode = "two_way"', f'mode = "{mode}"')

    def test_particles_that_overfill_a_cell(self):
        """A sphere of 34 cm3 in a cell of some 3 cm3."""
        text = self.channel("two_way")
        rag = text[text.index("[[rag]]") : text.index("[coupling]")]
        run = self.run_case(self.case(text.replace(rag, SPHERE)), 2)
        told = run.stdout + run.stderr
        self.assertEqual(told.count("more than the 0.6 of a dense packing"), 1, told)
        self.assertGreater(run.monitor("coupling").column("max_solid_fraction").max(), 0.6)

    def test_drag_of_suspensions_refuses_an_overfilled_cell(self):
        text = self.channel("two_way")
        rag, forces = text[text.index("[[rag]]") : text.index("[coupling]")], text[text.index("forces = ") :].split("\n")[0]
        run = self.run_case(self.case(text.replace(rag, SPHERE).replace(forces, 'forces = ["di_felice"]')), 2, code=2)
        for words in ("di_felice is a law for packings up to 0.6", 'kernel is "cell"', "widen it"):
            self.assertIn(words, run.stderr)

    def test_cloth_that_fits_is_not_warned_of(self):
        run = self.run_case(self.case(self.channel("two_way")), 2)
        self.assertNotIn("dense packing", run.stdout + run.stderr)

    def test_water_moved_by_a_sheet_is_left_out_one_way(self):
        for mode, is_said in (("one_way", True), ("two_way", False)):
            run = self.run_case(self.case(self.channel(mode), mode), 1, out=mode)
            self.assertEqual("left out: " in (run.folder / "log.txt").read_text(), is_said, mode)


if __name__ == "__main__":
    harness.main()
