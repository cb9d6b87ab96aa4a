# timeout: 600
# cost: 62
"""Requirement: the case files and meshes that README and tutorials print, and all cases and studies of cases/, are accepted by the program as they stand; cases without a warning."""
import ctypes
import ctypes.util
import hashlib
import os
import re
import shlex
import shutil
import tomllib

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
            if words[0] == "check" and (harness.SOURCE_DIR / words[1]).resolve() in self.cases():
                continue  # by test_cases
            run = harness.snag(words)
            self.assertEqual(run.code, 0, f"{document.name}: ./snag {' '.join(words)}\n{run.tail()}")
        os.chdir(before)
        checked = {words[1] for words in commands if words[0] == "check"}
        cases = {name for name, content in printed_files(text).items() if "[case]" in content}
        self.assertLessEqual(cases, checked, f"{document.name}: every case file printed is checked by a command")
        print(f"  {document.name}: {len(commands)} commands accepted")

    def test_readme(self):
        self.accepted(DOCUMENTS[0])

    def test_observed_runs_are_those_of_the_demo(self):
        """README observes folders that the demo writes, with a camera that is there."""
        text = DOCUMENTS[0].read_text()
        listed = harness.snag(["study", harness.SOURCE_DIR / "cases" / "pump-demo" / "study.toml", "--dry-run"])
        names = set(re.findall(r"run \d+ of \d+: (\S+)", listed.stdout))
        observed = set(re.findall(r"results/demo/([\w*-]+)", "\n".join(line for line in text.splitlines() if "./snag observe" in line)))
        self.assertEqual(observed, names)
        for camera in set(re.findall(r"cases/\S+/CAMERA\.toml", text)):
            self.assertIn("camera", tomllib.loads((harness.SOURCE_DIR / camera).read_text()))

    def test_camera_of_the_demo_sees_the_pump(self):
        """A cloth at rest in the volute: the picture has it where it is, in its size."""
        case = self.case(
            '[case]\nname = "still"\n[time]\nend_ms = 2\nstep_ms = 1\n[output]\nreport = false\nrags_interval_ms = 1\n'
            "[[rag]]\nlength_mm = 40\nwidth_mm = 20\nradius_mm = 2\ncentre_m = [0.12, 0.02, 0.04]\n"
        )
        self.run_case(case)
        camera = harness.SOURCE_DIR / "cases" / "pump-demo" / "CAMERA.toml"
        seen = harness.snag(["observe", self.work / "out", "--camera", camera, "--out", self.work / "seen"])
        self.assertEqual(seen.code, 0, seen.tail())
        observed = harness.Monitor(self.work / "seen" / "observations.csv")
        self.assertAlmostEqual(observed.column("x")[0], 0.12 - 0.03, delta=1e-3)  # from the middle of the picture
        self.assertAlmostEqual(observed.column("y")[0], 0.02 - 0.05, delta=1e-3)
        self.assertAlmostEqual(observed.column("area")[0], 0.04 * 0.02, delta=0.05 * 0.0008)

    def test_tutorial_of_the_bend_has_a_bend(self):
        """The pipe of the tutorial turns by a right angle: its inlet does not look along its main leg."""
        text = (harness.SOURCE_DIR / "docs" / "tutorial-own-mesh.md").read_text()
        words = next(words for words in printed_commands(text) if words[:2] == ["mesh", "pipe"])
        self.assertIn("bend_angle_deg=90", words, "a pipe is straight without bend_angle")

    def test_tutorial_script_for_gmsh(self):
        """The script that the tutorial prints makes a mesh that Snag finds fit; gmsh by its library."""
        text = (harness.SOURCE_DIR / "docs" / "tutorial-own-mesh.md").read_text()
        self.assertIn("apt-get install gmsh", text, "gmsh is not among Snag's packages")
        script = re.search(r"`stub\.geo`:\n\n((?:    .*\n)+)", text).group(1)
        (self.work / "stub.geo").write_text("\n".join(line[4:] for line in script.splitlines()) + "\n")
        gmsh, error = ctypes.CDLL(ctypes.util.find_library("gmsh")), ctypes.c_int(0)

        def call(function, *arguments):
            getattr(gmsh, function)(*arguments, ctypes.byref(error))
            self.assertEqual(error.value, 0, function)

        call("gmshInitialize", 0, None, 1)
        call("gmshOptionSetNumber", b"General.Terminal", ctypes.c_double(0))
        call("gmshOptionSetNumber", b"Mesh.MshFileVersion", ctypes.c_double(2.2))
        call("gmshOpen", str(self.work / "stub.geo").encode())
        call("gmshModelMeshGenerate", 3)
        call("gmshWrite", str(self.work / "stub.msh").encode())
        run = harness.snag(["mesh", "--info", self.work / "stub.msh"])
        self.assertEqual(run.code, 0, run.tail())
        self.assertRegex(run.stdout, r"patch walls")

    def test_tutorial_tear_tears(self):
        text = (harness.SOURCE_DIR / "docs" / "tutorial-rag-alone.md").read_text()
        line = next(line for line in text.splitlines() if "--out results/tear" in line)
        words = shlex.split(re.sub(r"\s+#.*", "", line))[3:]
        words = words[words.index("results/tear") + 1 :]
        run = self.run_case(self.case(printed_files(text)["fall.toml"]), 1, *words, "--set", "output.report=false")
        self.assertGreater(run.summary["rags"][0]["broken_bonds"], 10)

    def test_build_info_names_the_libraries(self):
        told = harness.snag(["--build-info"]).stdout
        for library in ("MPI: Open MPI", "PETSc: 3.", "hypre: ", "HDF5: 1.", "Eigen: 3."):
            self.assertIn(library, told)
        self.assertNotIn(str(harness.SOURCE_DIR), told, "nothing of this machine")

    def test_single_sphere_has_no_sub_steps(self):
        case = self.case('[case]\nname = "sphere"\n[time]\nend_ms = 2\nstep_ms = 1\n[[particle]]\n')
        told = harness.snag(["check", case]).stdout
        self.assertNotIn("inf", told.replace("info", ""))
        self.assertIn("no sub-steps", told)
        self.assertIn("each of 1 sub-step of the rags", told)

    def test_assumed_cloth_is_said(self):
        """Bonds and mass of the default cloth are named where a case changes a part of them only."""
        rag = '[case]\nname = "a"\n[time]\nend_ms = 2\nstep_ms = 1\n[flow]\n{flow}\n[[rag]]\nlength_mm = 40\nwidth_mm = 20\nradius_mm = 2\n{rag}\n'
        for flow, mass, words in (
            ("", "mass_per_area_kg_m2 = 0.4", ["assumed: [[rag]] 1 has mass_per_area = 0.4 kg/m2", "bonds of the wet dust cloth"]),
            ("density_kg_m3 = 1261", "", ["soaked with water of 998.2 kg/m3", "of 1261 kg/m3 it has 0.976"]),
            ("", "", []),
        ):
            told = harness.snag(["check", self.case(rag.format(flow=flow, rag=mass))]).stdout
            for part in words:
                self.assertIn(part, told)
            self.assertEqual("assumed:" in told, bool(words), told)

    def test_tutorials(self):
        for document in DOCUMENTS[1:]:
            with self.subTest(document.name):
                self.accepted(document)

    medium_mesh = False  # examples_long.py has meshes of cases as they stand

    def checkable(self, case):
        """The case as it stands; where it is of a generated pump of medium resolution, a copy of it with a coarse one."""
        pump = case.parent / "pump.toml"
        if self.medium_mesh or not pump.exists() or 'resolution = "medium"' not in pump.read_text():
            return case
        (self.work / "cases").mkdir(exist_ok=True)
        copy = shutil.copytree(case.parent, self.work / "cases" / case.parent.name)
        (copy / "pump.toml").write_text(pump.read_text().replace('"medium"', '"coarse"'))
        # The second case of the same pump takes the mesh of the first, which is made here.
        coarse, made = copy / "pump.toml", self.work / f"{hashlib.sha256(pump.read_bytes()).hexdigest()}.msh"
        if sum(other.read_bytes() == pump.read_bytes() for other in (harness.SOURCE_DIR / "cases").glob("*/pump.toml")) > 1:
            if not made.exists():
                run = harness.snag(["mesh", "pump", coarse, "--out", made])
                self.assertEqual(run.code, 0, run.tail())
            text, n = re.subn(r'geometry = "pump"\nparameters = "pump.toml".*', f'file = "{made}"', (copy / case.name).read_text())
            self.assertEqual(n, 1, case)
            (copy / case.name).write_text(text)
        return copy / case.name

    def studies(self):
        return sorted((harness.SOURCE_DIR / "cases").glob("*/*study.toml"))

    def cases(self):
        studied = {(study.parent / tomllib.loads(study.read_text())["study"]["case"]).resolve() for study in self.studies()}
        return studied | set((harness.SOURCE_DIR / "cases").glob("*/case.toml"))

    def test_cases(self):
        # Particles of 2 mm and a quarter of the cloth make the poses quick, and change nothing that a check of keys, mesh and conditions sees.
        quick = [word for key in ("radius_mm=2", "length_mm=110", "width_mm=150") for word in ("--set", "rag.0." + key)]
        for case in sorted(self.cases()):
            words = ["check", self.checkable(case)] + (quick if "confined" in case.read_text() else [])
            run = harness.snag(words)
            self.assertEqual(run.code, 0, f"{case.parent.name}/{case.name}\n{run.tail()}")
            warnings = [line for line in (run.stdout + run.stderr).splitlines() if "warning" in line]
            if case.parent.name == "study-kernel":  # widths that are too large belong to the study
                warnings = [line for line in warnings if "[coupling] kernel_width" not in line]
            self.assertFalse(warnings, f"{case.parent.name}/{case.name}")

    def test_studies(self):
        for study in self.studies():
            run = harness.snag(["study", study, "--dry-run"])
            self.assertEqual(run.code, 0, f"{study.parent.name}/{study.name}\n{run.tail()}")


if __name__ == "__main__":
    harness.main()
