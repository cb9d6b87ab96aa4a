# timeout: 600
"""Requirement: the case files and meshes that README and tutorials print, and all cases and studies of cases/, are accepted by the program as they stand."""
import os
import re
import shlex

import harness

DOCUMENTS = [harness.SOURCE_DIR / "README.md", *sorted((harness.SOURCE_DIR / "docs").glob("tutorial-*.md"))]
PLACEHOLDER = re.compile(r"\b[A-Z]{3,}\b|\||\$")


def printed_files(text):
    """Blocks of TOML below a line that ends in `name.toml`: {name: content}; a later block of the same name replaces the earlier one."""
    return {name: block for name, block in re.findall(r"`([\w.-]+\.toml)`[^\n]*:\n\n```toml\n(.*?)```", text, re.S)}


def printed_commands(text):
    """Commands `./snag mesh ...` and `./snag check ...` that hold no placeholder."""
    lines = [re.sub(r"\s+#.*", "", line).strip() for line in text.splitlines() if re.match(r"    \./snag (mesh|check) ", line)]
    return [shlex.split(line)[1:] for line in lines if not PLACEHOLDER.search(line)]


class Examples(harness.CaseTest):
    def accepted(self, document):
        text = document.read_text()
        for name, content in printed_files(text).items():
            (self.work / name).write_text(content)
        # The commands are meant for the source folder, but what they write goes elsewhere.
        if not (self.work / "cases").exists():
            (self.work / "cases").symlink_to(harness.SOURCE_DIR / "cases")
        before = os.getcwd()
        os.chdir(self.work)
        self.addCleanup(os.chdir, before)
        commands = printed_commands(text)
        for words in commands:
            run = harness.snag(words)
            self.assertEqual(run.code, 0, f"{document.name}: ./snag {' '.join(words)}\n{run.tail()}")
        os.chdir(before)
        checked = {words[1] for words in commands if words[0] == "check"}
        self.assertLessEqual(set(printed_files(text)), checked, f"{document.name}: every case file printed is checked by a command")
        print(f"  {document.name}: {len(commands)} commands accepted")

    def test_readme(self):
        self.accepted(DOCUMENTS[0])

    def test_tutorials(self):
        for document in DOCUMENTS[1:]:
            with self.subTest(document.name):
                self.accepted(document)

    def test_cases(self):
        # Particles of 2 mm make the poses quick, and change nothing that a check of keys, mesh and conditions sees.
        for case in sorted((harness.SOURCE_DIR / "cases").glob("*/case.toml")):
            words = ["check", case] + (["--set", "rag.0.radius_mm=2"] if "confined" in case.read_text() else [])
            run = harness.snag(words)
            self.assertEqual(run.code, 0, f"{case.parent.name}\n{run.tail()}")

    def test_studies(self):
        for study in sorted((harness.SOURCE_DIR / "cases").glob("*/study.toml")):
            run = harness.snag(["study", study, "--dry-run"])
            self.assertEqual(run.code, 0, f"{study.parent.name}\n{run.tail()}")


if __name__ == "__main__":
    harness.main()
