# timeout: 60
"""Requirement: how far around particles contacts are looked for ([contact] skin_over_radius), and when the lists were made, change no result."""
import harness

# A stiff fibre that drifts towards a floor and does not reach it: its bonds alone set the sub-step.
CASE = """
[case]
name = "near"
[time]
end_s = 0.02
step_s = 0.001
[[wall]]
kind = "plane"
point_m = [0, 0, 0]
normal = [0, 0, 1]
[contact]
skin_over_radius = {skin}
[[fibre]]
length_mm = 20
centre_m = [0, 0, 0.003]
velocity_m_s = [0, 0, -0.05]
spin_rad_s = [0, 3, 0]
[output]
report = false
"""


class ContactSkin(harness.CaseTest):
    def test_a_fibre_beside_a_floor(self):
        texts = []
        for skin in (0.1, 0.5, 2):
            run = self.run_case(self.case(CASE.format(skin=skin)), out=f"skin-{skin}")
            self.assertEqual(run.monitor("contacts").column("wall_contacts").max(), 0)
            texts.append((run.folder / "monitors" / "rags.csv").read_text())
        self.assertEqual(texts[0], texts[1])
        self.assertEqual(texts[0], texts[2])


if __name__ == "__main__":
    harness.main()
