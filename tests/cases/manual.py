"""Requirement: docs/case-file.md is what `snag manual` prints, so the manual cannot fall behind the program, and it has every key that the mesh
generator reads."""
import difflib

import harness


class Manual(harness.CaseTest):
    def test_documentation_equals_program(self):
        printed = harness.snag(["manual"])
        self.assertEqual(printed.code, 0, printed.tail())
        written = (harness.SOURCE_DIR / "docs" / "case-file.md").read_text()
        difference = "\n".join(difflib.unified_diff(written.splitlines(), printed.stdout.splitlines(), "docs/case-file.md", "snag manual", lineterm="", n=0))
        self.assertFalse(difference, f"write it anew: ./snag manual --out docs/case-file.md\n{difference}")

    def test_parameters_of_meshes(self):
        manual = harness.documented_keys()
        refused = harness.snag(["mesh", "sphere"])
        geometries = refused.stderr.split("known: ")[1].split(";")[0].split("\n")[0].split(", ")
        self.assertLessEqual({"box", "pump"}, set(geometries), refused.tail())
        for geometry in geometries:
            self.assertIn(geometry, manual, "a geometry that the manual lacks")
        mesh = self.work / "box.msh"
        made = harness.snag(["mesh", "box", "--set", "size_m=0.5", "--out", mesh])
        self.assertEqual(made.code, 0, made.tail())
        self.assertEqual(harness.undocumented_keys(mesh.with_suffix(".resolved.toml")), [])


if __name__ == "__main__":
    harness.main()
