# labels: long
# timeout: 14400
"""Requirement: whatever a case, mesh, wall, study, experiment, laboratory or camera file holds, the program ends within its time with a documented exit code and, unless it is 0, with a few lines that name the file or the key. SNAG_MUTATIONS damaged files (3000) are tried, from number SNAG_FIRST_MUTATION."""
import collections
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess

import harness
from small_cases import CHANNEL, CHANNEL_MESH, SMALL_SHEETS

COUNT = int(os.environ.get("SNAG_MUTATIONS", 3000))
FIRST = int(os.environ.get("SNAG_FIRST_MUTATION", 0))
DOCUMENTED = (0, 2, 3, 4, 5, 6)
TIME_LIMIT = 60  # s, of a command that only reads and judges
COMPUTES = 4  # s; a command that goes on to compute what it has read is stopped after these
MEMORY = 6 << 30  # bytes of address space: beyond it the program has to say so
MOST_LINES = 12
TRAPS = ["-1", "0", "1", "2147483647", "2147483648", "-2147483648", "4294967296", "9223372036854775807", "1e308", "-1e308", "1e-308", "1e400"]
TRAPS += ["nan", "inf", "-inf", "1000000000", '"', "[", "]", ",", "\n", "=", "{}", '""', "[[1]]", '"1 mm"', "true", "\xff\xfe", "x" * 5000, "../" * 40]
WORD = re.compile(rb"[A-Za-z0-9_.+-]+")

BOX = (
    "solid box\nfacet normal 0 0 1\nouter loop\nvertex -1 -1 0\nvertex 1 -1 0\nvertex -1 1 0\nendloop\nendfacet\n"
    "facet normal 0 0 1\nouter loop\nvertex 1 -1 0\nvertex 1 1 0\nvertex -1 1 0\nendloop\nendfacet\nendsolid box\n"
)
PLANE = 'kind = "plane"\npoint_m = [0, 0, 0]\nnormal = [0, 0, 1]'
STUDY = '[study]\ncase = "sheets.toml"\nset = ["time.end_s=8e-4"]\nresults = ["rags.0.particles"]\n[[vary]]\nkey = "rag.0.radius_mm"\nvalues = [1, 1.25]\n'
CAMERA = (
    "[camera]\npixels = [1088, 432]\npixel_mm = 0.5\ncentre_m = [0.03, 0.05, 0.04]\nright = [1, 0, 0]\nup = [0, 1, 0]\nblur = 1\nnoise = 2\n"
    '[cloth]\nbackground = "background.png"\nthreshold = 70\nsmoothing = 1\nminimum_pixels = 100\n'
)
REPEATS = "group,rag,area [m2],orientation [deg]\nA,1,0.02,10\nA,2,0.03,-80\nB,1,0.025,12\nB,2,0.021,85\n"

Kind = collections.namedtuple("Kind", "file arguments computes")


def changed_once(content, other, chance):
    """One change: of bytes, a word, a line, a part."""
    at = chance.randrange(len(content)) if content else 0
    word = WORD.search(content, at)
    line = (content.rfind(b"\n", 0, at) + 1, content.find(b"\n", at) + 1 or len(content))
    trap = chance.choice(TRAPS).encode("latin1")
    kind = chance.randrange(8)
    if kind == 0 and content:
        return content[:at] + bytes([content[at] ^ (1 << chance.randrange(8))]) + content[at + 1 :]
    if kind in (1, 2, 3) and word:
        text = trap if chance.random() < 0.7 else str(chance.randrange(-4, 40)).encode()
        return content[: word.start()] + text + content[word.end() :]
    if kind == 4:
        return content[: line[0]] + content[line[1] :]
    if kind == 5:
        return content[: line[0]] + content[line[0] : line[1]] + content[line[0] :]
    if kind == 6:
        begin = chance.randrange(len(other)) if other else 0
        return content[:at] + other[begin : begin + chance.randrange(200)] + content[at:]
    return content[:at] if chance.random() < 0.3 else content[:at] + content[at + chance.randrange(1, 200) :]


def mutated(content, number):
    chance = random.Random(number)
    for _ in range(chance.randrange(1, 5)):
        content = changed_once(content, content, chance)
    return content


class Mutations(harness.CaseTest):
    def inputs(self):
        """A folder with sound files, and the commands that read one of them each."""
        folder = self.work / "sound"
        folder.mkdir()
        cases = harness.SOURCE_DIR / "cases"
        mesh = self.mesh(*[setting.replace("size_mm=16", "size_mm=50") for setting in CHANNEL_MESH])
        shutil.copy(mesh, folder / "channel.msh")
        shutil.copy(mesh, folder / "judged.msh")
        (folder / "channel.toml").write_text(CHANNEL.format(mesh="channel.msh", kernel="cell"))
        (folder / "sheets.toml").write_text(SMALL_SHEETS)
        (folder / "walls.toml").write_text(SMALL_SHEETS.replace(PLANE, 'kind = "stl"\nfile = "box.stl"'))
        (folder / "box.stl").write_text(BOX)
        (folder / "study.toml").write_text(STUDY)
        (folder / "repeats.csv").write_text(REPEATS)
        for part in ("DIAGNOSIS.toml", "data.csv", "point_*.toml"):
            for file in (cases / "diagnose-sphere").glob(part):
                shutil.copy(file, folder)
        shutil.copy(cases / "textile-aro" / "tests.toml", folder)
        shutil.copy(cases / "textile-aro" / "passport.toml", folder)
        (folder / "passport_case.toml").write_text(SMALL_SHEETS.replace("radius_mm = 1\n", 'radius_mm = 1\npassport = "passport.toml"\n', 1))
        (folder / "CAMERA.toml").write_text(CAMERA)
        shutil.copy(cases / "diagnose-jeffery" / "picture.png", folder / "background.png")
        shutil.copy(cases / "rag-in-channel" / "channel.toml", folder / "parameters.toml")
        shutil.copy(cases / "diagnose-jeffery" / "picture.png", folder / "picture.png")
        return folder, [
            Kind("channel.toml", ["check", "channel.toml"], False),
            Kind("sheets.toml", ["check", "sheets.toml"], False),
            Kind("sheets.toml", ["run", "sheets.toml", "--out", "out"], True),
            Kind("channel.msh", ["check", "channel.toml"], False),
            Kind("judged.msh", ["mesh", "--info", "judged.msh"], False),
            Kind("box.stl", ["check", "walls.toml"], False),
            Kind("passport.toml", ["check", "passport_case.toml"], False),
            Kind("parameters.toml", ["mesh", "channel", "parameters.toml", "--out", "made.msh"], True),
            Kind("study.toml", ["study", "study.toml", "--out", "out"], True),
            Kind("DIAGNOSIS.toml", ["diagnose", "DIAGNOSIS.toml", "--out", "out"], True),
            Kind("data.csv", ["diagnose", "DIAGNOSIS.toml", "--out", "out"], True),
            Kind("point_A.toml", ["diagnose", "DIAGNOSIS.toml", "--out", "out"], True),
            Kind("tests.toml", ["calibrate", "tests.toml", "--out", "out"], True),
            Kind("CAMERA.toml", ["observe", "picture.png", "--camera", "CAMERA.toml", "--out", "out"], True),
            Kind("picture.png", ["observe", "picture.png", "--camera", "CAMERA.toml", "--out", "out"], True),
            Kind("repeats.csv", ["observe", "repeats.csv", "--out", "out"], False),
        ]

    def run_in(self, folder, kind):
        """Exit code (None: stopped while it computed) and stderr. Without mpirun, which would hide a signal and takes most of the time."""
        limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        environment = harness.ENVIRONMENT | {"OMPI_MCA_ess_singleton_isolated": "1"}
        process = subprocess.Popen(
            [harness.BINARY_DIR / "snag", *kind.arguments], cwd=folder, env=environment, preexec_fn=limit, start_new_session=True,
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
        )
        try:
            _, stderr = process.communicate(timeout=COMPUTES if kind.computes else TIME_LIMIT)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, 9)
            process.communicate()
            return (None, "") if kind.computes else (-9, f"more than {TIME_LIMIT} s")
        return process.returncode, stderr.decode(errors="replace")

    def finding(self, kind, content, code, stderr):
        """What is wrong with the end of a run; "" if nothing is."""
        if code is None:
            return ""
        if code not in DOCUMENTED:
            return f"exit code {code}"
        lines = [line for line in stderr.splitlines() if line.strip()]
        if len(lines) > MOST_LINES:
            return f"{len(lines)} lines on stderr"
        if "defect of the program" in stderr:
            return "an error that is not foreseen"
        if code == 0 or (code == 3 and "--info" in kind.arguments):  # a bad mesh: the judgement is on stdout
            return ""
        errors = [line for line in lines if line.startswith("error: ")]
        if not errors or (len(errors) > 1 and kind.arguments[0] != "study"):  # a study has one of each run that failed
            return f"{len(errors)} errors"
        path = errors[0].removeprefix("error: ").split(": ")[0].encode(errors="replace")  # of another file, as this one has it
        named = kind.file in errors[0] or path in content or re.search(r"\[\w+\]|\w+\.\w+|\w+/\w+|\w+_\w+|\"|\brag \d", errors[0])
        return "" if named else "the message names neither file nor key"

    def test_damaged_files(self):
        sound, kinds = self.inputs()
        for kind in kinds:  # a sound file is accepted
            shutil.copytree(sound, self.work / "one")
            code, stderr = self.run_in(self.work / "one", kind)
            self.assertIn(code, (None, 0), f"{kind}: {stderr}")
            shutil.rmtree(self.work / "one")
        codes = collections.Counter()
        kept = pathlib.Path(os.environ.get("SNAG_FINDINGS", self.work / "findings"))
        kept.mkdir(parents=True, exist_ok=True)
        for number in range(FIRST, FIRST + COUNT):
            kind = kinds[number % len(kinds)]
            folder = self.work / "one"
            shutil.copytree(sound, folder)
            content = mutated((sound / kind.file).read_bytes(), number)
            (folder / kind.file).write_bytes(content)
            code, stderr = self.run_in(folder, kind)
            codes[kind.arguments[0], kind.file, "stopped" if code is None else code] += 1
            if found := self.finding(kind, content, code, stderr):
                shutil.copy(folder / kind.file, kept / f"{number}_{kind.file}")
                with self.subTest(number=number, command=" ".join(kind.arguments), file=kind.file):
                    self.fail(f"{found}\n{stderr[:2000]}")
            shutil.rmtree(folder)
        for (command, file, code), n in sorted(codes.items(), key=str):
            print(f"  {command} {file}: {code}: {n}")


if __name__ == "__main__":
    harness.main()
