# timeout: 600
"""Requirement: Snag as it is installed makes a mesh, checks a case and reads a picture from any folder; the citation is that of
CITATION.cff; the completion of the shell knows every command and option; the revision is that of the sources at the last build."""
import re
import shutil
import subprocess

import harness

# Commands of an installed Snag are not those of the build folder: nothing of it may be in the environment.
PLAIN = {key: value for key, value in harness.ENVIRONMENT.items() if not key.startswith("SNAG_")}


class Installation(harness.CaseTest):
    """Shared with installed_long.py."""

    def call(self, *words, path="", **more):
        run = subprocess.run(list(map(str, words)), capture_output=True, text=True, env=PLAIN | {"PYTHONPATH": str(path)}, **more)
        self.assertEqual(run.returncode, 0, f"{' '.join(map(str, words))}\n{run.stdout}{run.stderr}")
        return run.stdout

    def works(self, prefix):
        elsewhere = self.work / "elsewhere"
        elsewhere.mkdir()
        snag = prefix / "bin" / "snag"
        self.assertIn(f"snag {self.version()} (", self.call(snag, "--version", cwd=elsewhere))
        self.call(snag, "mesh", "channel", "--out", "channel.msh", "--set", "length_mm=100", "--set", "height_mm=40", "--set", "width_mm=40", "--set", "size_mm=20", cwd=elsewhere)
        (elsewhere / "case.toml").write_text(
            '[case]\nname = "c"\n[mesh]\nfile = "channel.msh"\n[time]\nend_ms = 1\nstep_ms = 1\n[flow]\n[[boundary]]\npatch = "inlet"\n'
            'kind = "velocity_inlet"\nvelocity_m_s = [0.1, 0, 0]\n[[boundary]]\npatch = "outlet"\nkind = "pressure_outlet"\n[[boundary]]\n'
            'patches = ["bottom", "top", "side_z0", "side_z1"]\nkind = "wall"\n'
        )
        self.call(snag, "check", "case.toml", cwd=elsewhere)
        (elsewhere / "CAMERA.toml").write_text('[camera]\npixels = [1088, 432]\npixel_mm = 0.5\n[cloth]\nbackground = "background.png"\nthreshold = 70\nminimum_pixels = 100\n')
        picture = prefix / "share" / "snag" / "cases" / "diagnose-jeffery" / "picture.png"
        shutil.copy(picture, elsewhere / "background.png")
        self.call(snag, "observe", picture, "--camera", "CAMERA.toml", "--out", "seen", cwd=elsewhere)
        self.assertTrue((elsewhere / "seen" / "observations.csv").is_file())
        demo = self.call(snag, "study", prefix / "share" / "snag" / "cases" / "pump-demo" / "study.toml", "--dry-run", cwd=elsewhere)
        self.assertIn("run 1 of 2", demo)
        package = prefix / "lib" / "python3" / "dist-packages"
        read = "import snag; print(snag.Case('case.toml')['time.end_ms'], snag.__file__)"
        shown = self.call("/usr/bin/python3", "-B", "-c", read, cwd=elsewhere, path=package)
        self.assertEqual(shown.split(), ["1", str(package / "snag" / "__init__.py")])
        completion = prefix / "share" / "bash-completion" / "completions" / "snag"
        self.assertEqual(completion.read_text(), self.call(snag, "completion"))

    def version(self):
        return re.search(r"project\(snag VERSION (\S+)", (harness.SOURCE_DIR / "CMakeLists.txt").read_text())[1]


class Revision(harness.CaseTest):
    """The revision that a build compiles in is that of the sources at that build."""

    def git(self, *words, folder="tree"):
        run = subprocess.run(["git", "-C", self.work / folder, "-c", "user.name=a", "-c", "user.email=a@b", *words], capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run.stdout.strip()

    def written(self, folder="tree"):
        """Revision and time of the file that the script writes."""
        file = self.work / "version_git.cpp"
        script = harness.SOURCE_DIR / "base" / "version_git.cmake"
        run = subprocess.run(["cmake", "-D", f"SOURCE={self.work / folder}", "-D", f"FILE={file}", "-P", script], capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        return re.search(r'version_git = "(.*)";', file.read_text())[1], file.stat().st_mtime_ns

    def test_revision(self):
        source = self.work / "tree" / "part" / "source.cpp"
        source.parent.mkdir(parents=True)
        source.write_text("1\n")
        self.git("init", "--quiet")
        self.git("add", ".")
        self.git("commit", "--quiet", "-m", "first")
        self.git("tag", "a-tag")
        first = self.written()
        self.assertEqual(first[0], self.git("rev-parse", "--short=12", "HEAD"))
        self.assertEqual(self.written(), first, "the same revision leaves the file as it is")
        source.write_text("2\n")
        self.assertEqual(self.written()[0], first[0] + "-dirty")
        self.git("commit", "--quiet", "-a", "-m", "second")
        second = self.written()[0]
        self.assertNotEqual(second, first[0])
        self.assertEqual(second, self.git("rev-parse", "--short=12", "HEAD"))
        self.git("worktree", "add", "--quiet", self.work / "other", "a-tag")
        self.assertEqual(self.written("other")[0], first[0])
        self.assertEqual(self.written("tree/part")[0], "", "a folder within a repository is none of its own")
        (self.work / "unpacked").mkdir()
        self.assertEqual(self.written("unpacked")[0], "")


class Installed(Installation):
    def test_by_cmake(self):
        self.call("cmake", "--install", harness.BINARY_DIR, "--prefix", self.work / "prefix")
        self.works(self.work / "prefix")

    def test_citation(self):
        """Version and title are the same everywhere."""
        cff = (harness.SOURCE_DIR / "CITATION.cff").read_text()
        title, author = re.search(r'title: "(.*)"', cff)[1], re.search(r"name: (.*)", cff)[1]
        self.assertIn(f"\nversion: {self.version()}\n", cff)
        self.assertIn(f"To cite: {author}, {title}, version {self.version()}", self.call(harness.BINARY_DIR / "snag", "--version"))

    def complete(self, *words):
        script = f'source {harness.SOURCE_DIR}/share/bash-completion/snag; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _snag; printf "%s\\n" "${{COMPREPLY[@]}}"'
        return self.call("bash", "-c", script, "bash", "snag", *words).split()

    def test_completion(self):
        snag = harness.BINARY_DIR / "snag"
        written = (harness.SOURCE_DIR / "share" / "bash-completion" / "snag").read_text()
        self.assertEqual(written, self.call(snag, "completion"), "write it anew: ./snag completion --out share/bash-completion/snag")
        commands = re.findall(r"^  (\w+) ", self.call(snag, "--help").split("Subcommands:")[1], re.M)
        self.assertGreaterEqual(len(commands), 10)
        self.assertEqual(set(self.complete("")) & set(commands), set(commands))
        self.assertEqual(self.complete("obs"), ["observe"])
        for command in commands:
            options = set(re.findall(r"(?<![\w-])--[a-z-]+", re.sub(r"(?m)^.*?Options:", "", self.call(snag, command, "--help"), count=1)))
            self.assertIn("--help", options)
            self.assertLessEqual(set(self.complete(command, "--")), options, command)
        self.assertEqual(self.complete("run", "--res"), ["--resume"])
        self.assertEqual(self.complete("run", "cas"), [], "names of files are completed by the shell")


if __name__ == "__main__":
    harness.main()
