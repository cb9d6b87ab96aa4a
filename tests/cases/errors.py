# timeout: 300
# cost: 48
"""Requirement: what a user gets wrong ends on all ranks with the documented exit code and one clear message, and leaves an existing output folder as it was."""
import re
import subprocess

import harness
from small_cases import CHANNEL, CHANNEL_MESH, SMALL_SHEETS, TWO_SHEETS


class Mistakes(harness.CaseTest):
    def refused(self, code, fragments, file, *arguments, out="out"):
        """`snag run` on 2 ranks ends with `code` and one line on stderr that holds all fragments."""
        folder = self.work / out
        folder.mkdir(exist_ok=True)
        (folder / "notes.txt").write_text("a user's own file")
        before = harness.snapshot(folder)
        run = harness.snag(["run", file, "--out", folder, *arguments], 2, folder)
        self.assertEqual(run.code, code, run.tail())
        self.assertEqual(len(run.messages), 1, f"one message on stderr is wanted, these came:\n{run.stderr}")
        print(f"  {code}: {run.messages[0]}")
        for fragment in fragments:
            self.assertIn(fragment, run.messages[0])
        self.assertEqual(before, harness.snapshot(folder), "the output folder must stay as it was")

    def channel(self, replace="", by="", mesh=None):
        text = CHANNEL.format(mesh=mesh or self.mesh(*CHANNEL_MESH), kernel="cell")
        self.assertIn(replace, text)
        return self.case(text.replace(replace, by, 1))

    def sheets(self, replace="", by=""):
        self.assertIn(replace, TWO_SHEETS)
        return self.case(TWO_SHEETS.replace(replace, by, 1))

    def test_missing_case_file(self):
        self.refused(6, ["absent.toml"], self.work / "absent.toml")

    def test_missing_mesh(self):
        self.refused(6, ["absent.msh"], self.channel(mesh="absent.msh"))

    def test_broken_mesh_file(self):
        mesh = self.mesh(*CHANNEL_MESH)
        torn = self.work / "torn.msh"
        torn.write_bytes(mesh.read_bytes()[: mesh.stat().st_size // 2])
        self.refused(6, ["torn.msh"], self.channel(mesh=torn))

    def test_bad_mesh(self):
        """A cell turned inside out: a node of the mesh is moved across the channel."""
        lines = self.mesh(*CHANNEL_MESH).read_text().splitlines()
        first = lines.index("$Nodes") + 2
        inner = next(i for i in range(first, len(lines)) if all(0.03 < float(x) < 0.07 for x in lines[i].split()[1:]))
        number, x, y, z = lines[inner].split()
        lines[inner] = f"{number} {float(x) + 0.15} {y} {z}"
        bad = self.work / "bad.msh"
        bad.write_text("\n".join(lines) + "\n")
        self.refused(3, ["bad.msh"], self.channel(mesh=bad))

    def test_unknown_key(self):
        self.refused(2, ["densty", "density", ":"], self.channel("density_kg_m3", "densty_kg_m3"))

    def test_unknown_section(self):
        self.refused(2, ["couplign", "coupling"], self.channel("[coupling]", "[couplign]"))

    def test_unknown_force(self):
        self.refused(2, ["free_stream_drug", "free_stream_drag"], self.channel('"free_stream_drag"', '"free_stream_drug"'))

    def test_unit_of_another_dimension(self):
        self.refused(2, ["end", "m"], self.sheets("end_s = 0.02", 'end = "20 mm"'))

    def test_prescribed_flow_that_makes_volume(self):
        flow = '[flow]\nkind = "prescribed"\ngradient_per_s = [[1, 0, 0], [0, -0.5, 0], [0, 0, 0]]\n'
        self.refused(2, ["[flow]", "gradient_per_s", "0.5 1/s", "must be zero"], self.case(TWO_SHEETS + flow))

    def test_intensity_in_percent(self):
        self.refused(2, ["turbulence_intensity", "5"], self.channel('kind = "velocity_inlet"', 'kind = "velocity_inlet"\nturbulence_intensity = 5'))

    def test_file_of_a_limited_size(self):
        """`ulimit -f`: the run ends as on a full disk."""
        command = ["bash", "-c", 'ulimit -f 10; exec "$@"', "bash", *harness.command(["run", self.channel(), "--out", self.work / "out"])]
        run = subprocess.run(command, env=harness.ENVIRONMENT, capture_output=True, text=True, timeout=100)
        self.assertEqual(run.returncode, 6, run.stderr)
        self.assertIn("File too large", run.stderr)

    def test_output_that_cannot_be_written(self):
        """What a command prints is its result: an output on a full disk is an error. A run has its result in files, and goes on."""
        mesh, case = self.mesh(*CHANNEL_MESH), self.case(SMALL_SHEETS)
        for words in (["manual"], ["completion"], ["--version"], ["--build-info"], ["--help"], ["run", "--help"], ["mesh", "--info", mesh], ["mesh", "--manual"], ["mesh", "pump", "--help"],
                      ["run", case, "--out", self.work / "out"]):
            with open("/dev/full", "w") as full:
                run = subprocess.run(harness.command(words), env=harness.ENVIRONMENT, stdout=full, stderr=subprocess.PIPE, text=True, timeout=100)
            self.assertEqual(run.returncode, 0 if "--out" in words else 6, f"{words}: {run.stderr}")
            if "--out" not in words:
                self.assertIn("standard output: cannot be written (No space left on device)", run.stderr, words)

    def test_rank_that_fails_alone(self):
        """The memory of the second rank is limited, the first one waits for it: the error names the rank."""
        one_sheet, _, _ = SMALL_SHEETS.rpartition("[[rag]]")
        case = self.case(one_sheet.replace("_mm = 20\n", "_mm = 1600\n").replace("0, 0, 0.0535]", "0, 0, 2]"))
        check = harness.command(["check", case])
        command = ["mpirun", "-n", "1", *check, ":", "-n", "1", "bash", "-c", 'ulimit -v 450000; exec "$@"', "bash", *check]
        run = subprocess.run(command, env=harness.ENVIRONMENT, capture_output=True, text=True, timeout=100)
        self.assertEqual(run.returncode, 6, run.stderr)
        self.assertIn("error: rank 1 of 2: the memory of this machine", run.stderr)

    def test_scale_of_a_mesh(self):
        refused = harness.snag(["mesh", "--info", self.mesh(*CHANNEL_MESH), "--scale", "-1"])
        self.assertEqual(refused.code, 2)
        self.assertIn("--scale", refused.stderr)
        self.assertIn("must be positive", refused.stderr)

    def test_run_on_without_its_condition(self):
        self.refused(2, ["run_on", "end_when_rags_left"], self.sheets(), "--set", "time.run_on_s=0.01")

    def test_value_out_of_range(self):
        self.refused(2, ["acceleration"], self.sheets(), "--set", "gravity.acceleration_m_s2=[0, 0, -2000]")
        self.refused(2, ["density"], self.channel("density_kg_m3 = 998.2", "density_kg_m3 = -1"))

    def test_no_toml(self):
        self.refused(2, ["case.toml:"], self.sheets("[case]", "[case"))

    def test_patch_without_condition(self):
        self.refused(2, ["outlet"], self.channel('[[boundary]]\npatch = "outlet"\nkind = "pressure_outlet"\n', ""))

    def test_condition_for_unknown_patch(self):
        self.refused(2, ["outlett", "outlet"], self.channel('patch = "outlet"', 'patch = "outlett"'))

    def test_step_above_the_limit(self):
        self.refused(2, ["step", "is above the stable step", "set by"], self.sheets("[dem]\nstep_s = 8e-6", "[dem]\nstep_s = 2e-4"))

    def test_set_without_value(self):
        self.refused(2, ["time.end_s"], self.sheets(), "--set", "time.end_s")

    def test_set_of_unknown_key(self):
        self.refused(2, ["tme", "time"], self.sheets(), "--set", "tme.end_s=1")

    def test_set_of_absent_table(self):
        self.refused(2, ["rag"], self.sheets(), "--set", "rag.7.radius_mm=1")

    def test_value_that_is_no_number(self):
        self.refused(2, ["centre_m", "--set", "finite"], self.sheets(), "--set", "rag.0.centre_m=[0, 0, nan]")

    def test_set_of_a_whole_section(self):
        self.refused(2, ["time", "section"], self.sheets(), "--set", "time=1")

    def test_rag_outside_the_mesh(self):
        self.refused(2, ["rag 1", "outside the mesh"], self.channel(), "--set", "rag.centre_m=[0.08, 0.5, 0.05]")

    def test_rag_across_a_wall(self):
        self.refused(2, ["rag 1", "beyond a wall"], self.sheets(), "--set", "rag.0.centre_m=[0, 0, 0.03]")

    def test_rags_in_each_other(self):
        self.refused(2, ["overlaps"], self.sheets("[-0.008, 0.01, 0.055]\nlengthwise = [0.5, 0.1, 0.8]", "[0, 0, 0.054]\nlengthwise = [0.5, 0, 0.8]"))

    def test_too_many_particles(self):
        self.refused(2, ["particles", "radius"], self.sheets(), "--set", "rag.0.length_mm=1e9")
        self.refused(2, ["copies = 1000000 have", "fewer copies"], self.sheets(), "--set", "rag.0.copies=1000000", "--set", "rag.0.copy_step_m=[0, 0, 0.1]")

    def test_copies_at_one_place(self):
        self.refused(2, ["copies = 3 would all begin at one place", "copy_step"], self.sheets(), "--set", "rag.0.copies=3")

    def test_folder_with_a_run(self):
        case = self.sheets("end_s = 0.02", "end_s = 8e-4")
        self.run_case(case, 2)
        self.refused(2, ["--resume", "--overwrite"], case)
        others = [self.work / "out" / name for name in ("walls/casing.stl", "rags/note.txt", "pictures/photo.jpg", "fields/pump.msh")]
        for file in others:
            file.parent.mkdir(exist_ok=True)
            file.write_text("of the user")
        old = self.work / "out" / "rags" / "rags_99999999.vtp"
        old.write_text("of the earlier run")
        self.run_case(case, 2, "--overwrite")
        self.assertEqual(["of the user"] * 4, [file.read_text() for file in others])
        self.assertFalse(old.exists())

    def test_folder_of_the_user(self):
        case = self.sheets("end_s = 0.02", "end_s = 8e-4")
        for name in ("walls/casing.stl", "pictures/photo.png", "log.txt"):
            folder = self.work / name.split("/")[0].replace(".", "_")
            (folder / name).parent.mkdir(parents=True)
            (folder / name).write_text("of the user")
            for how in ([], ["--overwrite"]):
                self.refused(2, [folder.name, name.split("/")[0], "--out"], case, *how, out=folder.name)

    def test_k_epsilon_where_nothing_enters(self):
        """Requirement: an inlet that rises from nothing gives no turbulence for the start, whatever the round-off of the first fluxes is."""
        case = self.channel('"velocity_inlet"', '"velocity_inlet"\nramp_s = 0.03', mesh=self.mesh("channel", "length_mm=300", "height_mm=100", "width_mm=100", 'cells="hexahedra"', "size_mm=25", "wall_ratio=1"))
        run = self.run_case(case, 2, "--set", 'turbulence.model="k_epsilon"', code=2)
        self.assertIn("no fluid enters at the start", run.messages[-1])

    def test_rag_through_a_boundary_without_wall(self):
        """Requirement: a rag that nothing holds back goes through no wall of the mesh unnoticed."""
        text = CHANNEL.format(mesh=self.mesh(*CHANNEL_MESH), kernel="cell")
        wall = text[text.index("[[wall]]"):text.index("[[rag]]")]
        case = self.case(text.replace(wall, "").replace("0.08, 0.05, 0.05", "0.08, 0.05, 0.065").replace("lengthwise", "velocity_m_s = [0.5, 0, 3]\nlengthwise").replace(
            "dynamic_viscosity_Pa_s = 0.05", "dynamic_viscosity_Pa_s = 1e-3").replace('"two_way"', '"one_way"').replace("end_s = 0.05", "end_s = 0.2"))
        check = harness.snag(["check", case], 1)
        self.assertEqual(check.code, 0, check.tail())
        self.assertIn("the case has no [[wall]]", check.stdout)
        run = self.run_case(case, 2, code=2)
        self.assertIn('"side_z1"', run.messages[-1])
        self.assertIn("go through patches of kind wall", run.messages[-1])

    def test_rag_leaves_by_an_inlet_that_draws_water_out(self):
        text = CHANNEL.format(mesh=self.mesh(*CHANNEL_MESH), kernel="cell").replace(
            'kind = "pressure_outlet"', 'kind = "velocity_inlet"\nvelocity_m_s = [0.5, 0, 0]')
        text = text.replace("length_mm = 60\nwidth_mm = 40", "length_mm = 20\nwidth_mm = 16").replace(
            "centre_m = [0.08, 0.05, 0.05]", "centre_m = [0.285, 0.05, 0.05]\nvelocity_m_s = [0.5, 0, 0]").replace(
            "end_s = 0.05", "end_s = 0.5\nend_when_rags_left = true")
        run = self.run_case(self.case(text), 2)
        self.assertEqual(run.summary["rags"][0]["outcome"], "exited")
        self.assertLess(run.summary["simulated_s"], 0.2)

    def test_resume_without_checkpoint(self):
        self.refused(6, ["checkpoint"], self.sheets(), "--resume")

    def test_truncated_checkpoint(self):
        case = self.case(TWO_SHEETS + "[checkpoint]\ninterval_s = 4e-4\n")
        self.run_case(case, 2, "--set", "time.end_s=8e-4")
        slots = sorted((self.work / "out" / "checkpoint").glob("*.h5"))
        self.assertTrue(slots, "a checkpoint must be there")
        for slot in slots:
            slot.write_bytes(slot.read_bytes()[: slot.stat().st_size // 2])
        self.refused(6, ["checkpoint"], case, "--resume", "--set", "time.end_s=8e-4")

    def test_resume_of_another_case(self):
        case = self.case(TWO_SHEETS + "[checkpoint]\ninterval_s = 4e-4\n")
        self.run_case(case, 2, "--set", "time.end_s=8e-4")
        self.refused(2, ["another case"], case, "--resume", "--set", "time.end_s=8e-4", "--set", "rag.0.width_mm=60")

    def test_unknown_command(self):
        run = harness.snag(["rnu"], 2)
        self.assertEqual(run.code, 2)
        self.assertEqual(len(run.messages), 1, run.stderr)
        self.assertTrue(re.search("rnu.*run", run.messages[0]), run.messages)


if __name__ == "__main__":
    harness.main()
