# timeout: 120
"""Requirement: a case with the key names of version 0.1 is the case with the names of today: each old name gets one warning that names line, old and new key, the resolved case has the new names, and the hash is the one that version 0.1 printed."""
import re

import harness

CHANNEL = """
[channel]
cells = "hexahedra"
length_mm = 200
height_mm = 100
width_mm = 100
cells_x = 4
cells_y = 2
cells_z = 2
wall_ratio = 1
"""
BONDS = """
normal_stiffness_lengthwise_N_m3 = 1e9
tangential_stiffness_lengthwise_N_m3 = 1e8
bending_stiffness_lengthwise_N_m3 = 1e8
normal_stiffness_crosswise_N_m3 = 1e9
tangential_stiffness_crosswise_N_m3 = 1e8
bending_stiffness_crosswise_N_m3 = 1e8
"""
WATER = """
[time]
end_s = 0.01
step_s = 1e-3
[mesh]
geometry = "channel"
parameters = "channel.toml"
[flow]
{n_outer_correctors} = 2
{n_non_orthogonal_correctors} = 2
[[boundary]]
patch = "inlet"
kind = "velocity_inlet"
velocity_m_s = [1, 0, 0]
[[boundary]]
patch = "outlet"
kind = "pressure_outlet"
[[boundary]]
patches = ["bottom", "side_z0", "side_z1"]
kind = "wall"
{stationary} = true
[[boundary]]
patch = "top"
kind = "moving_wall"
{rotation_speed}_rpm = 1
axis = [0, 1, 0]
[coupling]
mode = "one_way"
[[rag]]
length_mm = 8
width_mm = 6
radius_mm = 1
{published_density}
{match_flow_velocity} = true
centre_m = [0.05, 0.05, 0.05]
{custom}
""" + BONDS + """
[{initial_flow}]
{map_nearest_cell} = true
[[wall]]
kind = "patches"
patches = ["bottom"]
{stationary} = true
[output]
report = false
"""
FORMULA = """
[time]
end_s = 0.01
step_s = 1e-3
[flow]
kind = "prescribed"
amplitude_m_s = [0.1, 0, 0]
{angular_frequency} = [3, 0, 0]
[[rag]]
length_mm = 8
width_mm = 6
radius_mm = 1
{default_density}
{custom}
""" + BONDS + """
[[wall]]
kind = "plane"
point_m = [0, 0, -0.1]
normal = [0, 0, 1]
axis = [0, 0, 1]
{rotation_speed}_rpm = 60
[{virtual_camera}]
right = [0, 1, 0]
up = [0, 0, 1]
[output]
report = false
"""
FORMER = {
    "n_outer_correctors": "outer_correctors",
    "n_non_orthogonal_correctors": "n_non_orthogonal",
    "stationary": "fixed",
    "rotation_speed": "speed",
    "match_flow_velocity": "with_water",
    "initial_flow": "start",
    "map_nearest_cell": "map",
    "virtual_camera": "observe",
    "angular_frequency": "omega_per_s",
    "custom": 'properties = "given"',
    "published_density": "as_published = true",
    "default_density": "as_published = false",
}
PRESENT = {name: name for name in FORMER} | {
    "angular_frequency": "angular_frequency_rad_s",
    "custom": 'properties = "custom"',
    "published_density": 'density_model = "jensen_2018"',
    "default_density": 'density_model = "mass_per_area"',
}
# By the program of version 0.1 from the former names.
HASHES = {WATER: "232d9ca3dfd799fb9874429230a7950432a13f4fe97174d6c645a0e398917d2f", FORMULA: "613b81a7f57605df10ae9a9ff1d3f495605e894e367a4bbcb29a29d0de2832c6"}


class FormerNames(harness.CaseTest):
    def check(self, text, *arguments, code=0):
        (self.work / "channel.toml").write_text(CHANNEL.lstrip())
        run = harness.snag(["check", self.case(text.lstrip()), *arguments])
        self.assertEqual(run.code, code, run.tail())
        return run

    def renamed(self, run):
        return [line for line in run.stdout.splitlines() if "is now called" in line]

    def test_hash_is_that_of_version_0_1(self):
        for text, expected in HASHES.items():
            for names in (FORMER, PRESENT):
                self.assertIn(f"sha256 {expected}", self.check(text.format(**names)).stdout)

    def test_one_warning_for_each_former_name(self):
        for text in (WATER, FORMULA):
            self.assertEqual(self.renamed(self.check(text.format(**PRESENT))), [])
            warnings = self.renamed(self.check(text.format(**FORMER)))
            used = re.findall(r"{(\w+)}", text)
            self.assertEqual(len(warnings), len(used), "\n".join(warnings))
            for name in used:
                former, present = FORMER[name], PRESENT[name]
                found = [line for line in warnings if f"{former}" in line and present in line and "; the old name is read until 1.0" in line]
                self.assertTrue(found, f"{former} -> {present}\n" + "\n".join(warnings))
                self.assertRegex(found[0], r"case\.toml:\d+: \[")

    def test_resolved_case_has_the_present_names(self):
        run = self.run_case(self.case(FORMULA.lstrip().format(**FORMER)), 2)
        resolved = (run.folder / "case.resolved.toml").read_text()
        for line in ("angular_frequency_rad_s = [3.0, 0.0, 0.0]", 'properties = "custom"', 'density_model = "mass_per_area"', "[virtual_camera]"):
            self.assertIn(line, resolved)
        self.assertNotRegex(resolved, r"(?m)^(omega|as_published|speed)|^\[observe\]")
        self.assertEqual(len(self.renamed(run)), len(re.findall(r"{(\w+)}", FORMULA)))
        self.assertEqual(run.summary["case_sha256"], HASHES[FORMULA])

    def test_one_key_that_is_two_now(self):
        former = FORMULA.format(**PRESENT) + "[contact]\nbetween_particles = false\n"
        present = FORMULA.format(**PRESENT) + "[contact]\nself_contact = false\nmutual_contact = false\n"
        by_former, by_present = self.check(former), self.check(present)
        self.assertEqual(len(self.renamed(by_former)), 1, by_former.stdout)
        self.assertRegex(self.renamed(by_former)[0], r"case\.toml:\d+: \[contact\] between_particles is now called self_contact and mutual_contact; ")
        self.assertEqual(self.renamed(by_present), [])
        hashes = [re.search("sha256 [0-9a-f]+", run.stdout).group() for run in (by_former, by_present)]
        self.assertEqual(*hashes)
        override = self.check(present, "--set", "contact.between_particles=true")
        self.assertEqual(len(self.renamed(override)), 1, override.stdout)

    def test_both_names_are_an_error(self):
        both = WATER.replace("{n_outer_correctors} = 2", "n_outer_correctors = 2\nouter_correctors = 2").format(**PRESENT)
        self.assertIn("given twice, as n_outer_correctors and outer_correctors", self.check(both, code=2).stderr)
        tables = FORMULA.format(**PRESENT) + "[observe]\nright = [0, 1, 0]\n"
        self.assertIn("[observe] is the former name of [virtual_camera]", self.check(tables, code=2).stderr)

    def test_overrides_by_either_name(self):
        text = WATER.format(**PRESENT)
        by_present = self.check(text, "--set", "flow.n_outer_correctors=3", "--set", "initial_flow.map_nearest_cell=false")
        by_former = self.check(text, "--set", "flow.outer_correctors=3", "--set", "start.map=false")
        hashes = [re.search("sha256 [0-9a-f]+", run.stdout).group() for run in (by_present, by_former)]
        self.assertEqual(*hashes)
        self.assertEqual(len(self.renamed(by_former)), 3)
        self.assertIn("--set: [flow] outer_correctors is now called n_outer_correctors", by_former.stdout)


if __name__ == "__main__":
    harness.main()
