# timeout: 60
"""Requirement: a case gives the contact thickness and friction of a piece; `snag check` compares the thickness with the gaps of the walls and with
the depth of impacts, and refuses what is thicker than the lattice spacing."""
import harness

CASE = """
[case]
name = "between-plates"
[time]
end_ms = 2
step_ms = 1
[[wall]]
kind = "plane"
name = "lower plate"
point_m = [0, 0, -0.5e-3]
normal = [0, 0, 1]
[[wall]]
kind = "plane"
name = "upper plate"
point_m = [0, 0, 0.5e-3]
normal = [0, 0, -1]
[[rag]]
length_mm = 20
width_mm = 12
radius_mm = 1
{more}
[output]
report = false
"""
GAP = "gap of 1 mm between lower plate and upper plate:"


class ThinCloth(harness.CaseTest):
    def checked(self, more, code=0):
        run = harness.snag(["check", self.case(CASE.format(more=more))])
        self.assertEqual(run.code, code, run.tail())
        return run

    def test_check_compares_thickness_and_gap(self):
        thick = self.checked("").stdout
        self.assertIn(f"{GAP} 0.5 of the contact thickness of rag 1, 2 mm, which cannot enter it. Without contact_thickness cloth is as thick as its particles", thick)
        thin = self.checked("contact_thickness_mm = 0.8").stdout
        self.assertIn(f"{GAP} 1.25 of the contact thickness of rag 1, 0.8 mm, which enters it.", thin)
        soft = self.checked("contact_thickness_mm = 0.5").stdout
        self.assertIn("more than half its contact_thickness, 0.25 mm: raise [contact] wall_stiffness_factor", soft)
        stiff = self.checked("contact_thickness_mm = 0.5\n[contact]\nwall_stiffness_factor = 5").stdout
        self.assertNotIn("raise [contact] wall_stiffness_factor", stiff)

    def test_too_thick_is_refused(self):
        for key in ("contact_thickness", "layer_thickness"):
            run = self.checked(f"{key}_mm = 2.5", 2)
            self.assertIn(f"{key} = 0.0025 m, must be at most the lattice spacing, 2 r_p = 0.002 m", run.stderr)

    def test_a_thin_cloth_lies_free_between_the_plates(self):
        contacts = {}
        for name, more in (("thick", ""), ("thin", "contact_thickness_mm = 0.77\nlayer_thickness_mm = 1.5\nwall_friction = 0.4\ncloth_friction = 0.3")):
            run = self.run_case(self.case(CASE.format(more=more)), out=name)
            contacts[name] = run.monitor("contacts").column("wall_contacts")
            self.assertEqual(run.summary["conservation"]["particles_beyond_walls"], 0)
            columns = run.monitor("wall_contacts").columns
            self.assertIn("lower_plate_normal_force_z [N]", columns, "names fit into columns")
        self.assertEqual(list(contacts["thick"]), [120, 120])
        self.assertEqual(list(contacts["thin"]), [0, 0])


if __name__ == "__main__":
    harness.main()
