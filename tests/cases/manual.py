"""Requirement: docs/case-file.md is what `snag manual` prints, so the manual cannot fall behind the program."""
import difflib

import harness


class Manual(harness.CaseTest):
    def test_documentation_equals_program(self):
        printed = harness.snag(["manual"])
        self.assertEqual(printed.code, 0, printed.tail())
        written = (harness.SOURCE_DIR / "docs" / "case-file.md").read_text()
        difference = "\n".join(difflib.unified_diff(written.splitlines(), printed.stdout.splitlines(), "docs/case-file.md", "snag manual", lineterm="", n=0))
        self.assertFalse(difference, f"write it anew: ./snag manual --out docs/case-file.md\n{difference}")


if __name__ == "__main__":
    harness.main()
