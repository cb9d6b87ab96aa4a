"""The pump of `snag bench flow` in OpenFOAM (Debian package openfoam, v1912): mesh, steady start, sliding steps, their times.

    openfoam.py --mesh PUMP.msh --out DIR ...      writes DIR/peer.json

It is told the same case as Snag: mesh, flow rate, speed, step, standard k-epsilon with wall functions, second order in time (backward),
linear-upwind convection with limited gradients, two outer corrections of one momentum equation, one pressure equation and one repetition
of it for the non-orthogonal mesh, k and epsilon. Its default of moving meshes stays on: a correction of the fluxes in each step.
Cells are renumbered first: in gmsh's order they cost cache misses in every sweep.
"""
import argparse
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

SWEEPS = "symGaussSeidel"
STEADY_STEPS = 100  # of simpleFoam in the turning frame
INTERFACE = ("interface_rotor", "interface_stator")
WALLS = ("impeller_walls", "casing_walls")
INLET_DIAMETER, INTENSITY = 0.1, 0.05  # m; 5 % of the mean speed in eddies of 0.07 diameters
C_MU = 0.09


def environment():
    """This process' own, with what OpenFOAM and an MPI job as root or on few cores need."""
    return dict(os.environ, WM_PROJECT_DIR=os.environ.get("WM_PROJECT_DIR", "/usr/share/openfoam"), OMPI_ALLOW_RUN_AS_ROOT="1",
                OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMPI_MCA_rmaps_base_oversubscribe="1",
                OMPI_MCA_hwloc_base_binding_policy="none", OMPI_MCA_btl_base_warn_component_unused="0", OMP_NUM_THREADS="1")


# ------------------------------------------------------------------ dictionaries

def written(value):
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def entries(dictionary, depth=0):
    pad, text = "    " * depth, ""
    for key, value in dictionary.items():
        if isinstance(value, dict):
            text += f"{pad}{key}\n{pad}{{\n{entries(value, depth + 1)}{pad}}}\n"
        else:
            text += f"{pad}{key} {written(value)};\n"
    return text


def write(file, dictionary, kind="dictionary"):
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(f"FoamFile\n{{\n    version 2.0; format ascii; class {kind}; object {file.name};\n}}\n" + entries(dictionary))


class Case:
    def __init__(self, settings):
        self.settings = settings
        self.folder = pathlib.Path(settings.out) / "case"

    def run(self, *command, parallel=False, seen=None):
        """A program of OpenFOAM with its output in log.PROGRAM; `seen` is called with each line."""
        program = command[0]
        ranks = self.settings.ranks if parallel else 1
        if ranks > 1:
            command = ("mpirun", "-n", str(ranks), *command, "-parallel")
        print(" ".join(command), flush=True)
        with open(self.folder / f"log.{program}", "w") as log:
            process = subprocess.Popen(command, cwd=self.folder, env=environment(), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                       stderr=subprocess.STDOUT, text=True, errors="replace")
            for line in process.stdout:
                log.write(line)
                if seen:
                    seen(line)
            code = process.wait()
        if code != 0:
            sys.exit(f"{program} ended with code {code}; see {self.folder}/log.{program}")

    # -------------------------------------------------------------- set-up

    def control(self, program, end, step):
        write(self.folder / "system/controlDict", {
            "application": program, "startFrom": "startTime", "startTime": 0, "stopAt": "endTime", "endTime": float(end), "deltaT": float(step),
            "writeControl": "timeStep", "writeInterval": STEADY_STEPS if program == "simpleFoam" else 10**6, "writeFormat": "binary",
            "timePrecision": 8, "runTimeModifiable": False})

    def schemes(self, steady):
        bounded = "bounded " if steady else ""
        write(self.folder / "system/fvSchemes", {
            "ddtSchemes": {"default": "steadyState" if steady else "backward"},
            "gradSchemes": {"default": "Gauss linear", **{f"grad({field})": "cellLimited Gauss linear 1" for field in ("U", "k", "epsilon")}},
            "divSchemes": {"default": "none", "div(phi,U)": f"{bounded}Gauss linearUpwind grad(U)",
                           "div(phi,k)": f"{bounded}Gauss limitedLinear 1", "div(phi,epsilon)": f"{bounded}Gauss limitedLinear 1",
                           "div((nuEff*dev2(T(grad(U)))))": "Gauss linear"},
            "laplacianSchemes": {"default": "Gauss linear limited corrected 0.5"},
            "interpolationSchemes": {"default": "linear"}, "snGradSchemes": {"default": "limited corrected 0.5"},
            "wallDist": {"method": "meshWave"}})

    def solution(self, steady):
        multigrid = {"solver": "GAMG", "smoother": "GaussSeidel", "tolerance": 1e-12, "relTol": 0.01 if steady else 0.05, "nCellsInCoarsestLevel": 100}
        sweeps = {"solver": "smoothSolver", "smoother": SWEEPS, "tolerance": 1e-12, "relTol": 0.01, "maxIter": 50}
        solvers = {"p": multigrid, "pFinal": dict(multigrid, relTol=0.01), '"pcorr.*"': dict(multigrid, tolerance=1e-3, relTol=0.01),
                   '"(U|k|epsilon)(Final)?"': sweeps}
        if steady:
            relaxation = {"fields": {"p": 0.3}, "equations": {"U": 0.7, '"(k|epsilon)"': 0.5}}
            loop = {"SIMPLE": {"nNonOrthogonalCorrectors": 1}}
        else:
            relaxation = {"fields": {"p": 0.7, "pFinal": 1}, "equations": {"U": 0.8, '"(k|epsilon)"': 0.8, '"(U|k|epsilon)Final"': 1}}
            loop = {"PIMPLE": {"nOuterCorrectors": 2, "nCorrectors": 1, "nNonOrthogonalCorrectors": 1, "momentumPredictor": True,
                               "turbOnFinalIterOnly": False, "correctPhi": True, "checkMeshCourantNo": False}}
        write(self.folder / "system/fvSolution", {"solvers": solvers, **loop, "relaxationFactors": relaxation})

    def models(self):
        axis = {"origin": "(0 0 0)", "axis": "(0 0 1)", "omega": self.settings.speed}
        write(self.folder / "constant/transportProperties", {"transportModel": "Newtonian", "nu": self.settings.viscosity})
        write(self.folder / "constant/turbulenceProperties",
              {"simulationType": "RAS", "RAS": {"RASModel": "kEpsilon", "turbulence": True, "printCoeffs": False}})
        # The interface must be named as not rotating: it would be a turning wall otherwise, and let nothing through.
        write(self.folder / "constant/MRFProperties",
              {"MRF": {"cellZone": "rotor", "active": True, "nonRotatingPatches": f"({' '.join(INTERFACE)})", **axis}})

    def slide(self):
        (self.folder / "constant/MRFProperties").unlink()
        write(self.folder / "constant/dynamicMeshDict", {
            "dynamicFvMesh": "dynamicMotionSolverFvMesh", "motionSolverLibs": "(fvMotionSolvers)", "motionSolver": "solidBody", "cellZone": "rotor",
            "solidBodyMotionFunction": "rotatingMotion", "origin": "(0 0 0)", "axis": "(0 0 1)", "omega": self.settings.speed})

    def field(self, name, dimensions, start, conditions, kind="volScalarField"):
        interface = {patch: {"type": "cyclicAMI", "value": f"uniform {start}"} for patch in INTERFACE}
        write(self.folder / "0" / name,
              {"dimensions": dimensions, "internalField": f"uniform {start}", "boundaryField": {**conditions, **interface}}, kind)

    def fields(self):
        speed = self.settings.flow_rate / (math.pi / 4 * INLET_DIAMETER**2)

        def eddies(speed, length):
            k = 1.5 * (INTENSITY * speed)**2
            return k, C_MU**0.75 * k**1.5 / length

        k_in, epsilon_in = eddies(speed, 0.07 * INLET_DIAMETER)
        k, epsilon = eddies(self.settings.speed * 0.1, 0.01)  # inside, of the impeller's speed and a tenth of its radius
        zero, wall_value = "uniform (0 0 0)", lambda kind, value: {patch: {"type": kind, "value": f"uniform {value:.8g}"} for patch in WALLS}
        self.field("U", "[0 1 -1 0 0 0 0]", "(0 0 0)", {
            "inlet": {"type": "flowRateInletVelocity", "volumetricFlowRate": f"constant {self.settings.flow_rate:.12g}", "value": zero},
            "outlet": {"type": "inletOutlet", "inletValue": zero, "value": zero},
            "impeller_walls": {"type": "movingWallVelocity", "value": zero}, "casing_walls": {"type": "noSlip"}}, "volVectorField")
        slope = {"type": "zeroGradient"}
        self.field("p", "[0 2 -2 0 0 0 0]", "0", {"inlet": slope, "outlet": {"type": "fixedValue", "value": "uniform 0"}, **{patch: slope for patch in WALLS}})
        for name, dimensions, inside, entering, law in (("k", "[0 2 -2 0 0 0 0]", k, k_in, "kqRWallFunction"),
                                                        ("epsilon", "[0 2 -3 0 0 0 0]", epsilon, epsilon_in, "epsilonWallFunction")):
            value = f"uniform {entering:.8g}"
            self.field(name, dimensions, f"{inside:.8g}", {"inlet": {"type": "fixedValue", "value": value},
                                                           "outlet": {"type": "inletOutlet", "inletValue": value, "value": value}, **wall_value(law, inside)})
        calculated = {"type": "calculated", "value": "uniform 0"}
        self.field("nut", "[0 2 -1 0 0 0 0]", f"{C_MU * k**2 / epsilon:.8g}", {"inlet": calculated, "outlet": calculated, **wall_value("nutkWallFunction", 0)})

    def patch_types(self):
        """gmshToFoam makes plain patches of all: walls, and the pair of the sliding interface."""
        file = self.folder / "constant/polyMesh/boundary"
        found = re.findall(r"(\w+)\s*\{([^{}]*)\}", file.read_text().split("(", 1)[1])
        patches = {}
        for name, inside in found:
            values = dict(re.findall(r"(nFaces|startFace)\s+(\d+)", inside))
            if values["nFaces"] == "0":
                continue
            if name in INTERFACE:
                other = INTERFACE[1 - INTERFACE.index(name)]
                patches[name] = {"type": "cyclicAMI", **values, "neighbourPatch": other, "transform": "noOrdering", "lowWeightCorrection": 0.1}
            else:
                patches[name] = {"type": "wall" if name in WALLS else "patch", **values}
        missing = {"inlet", "outlet", *WALLS, *INTERFACE} - set(patches)
        if missing:
            sys.exit(f"the converted mesh has no patch {', '.join(sorted(missing))}")
        header = "FoamFile\n{\n    version 2.0; format ascii; class polyBoundaryMesh; object boundary;\n}\n"
        file.write_text(header + f"{len(patches)}\n(\n{entries(patches, 1)})\n")

    def make_mesh(self):
        self.run("gmshToFoam", os.path.abspath(self.settings.mesh))
        self.patch_types()
        write(self.folder / "system/renumberMeshDict", {"writeMaps": False, "orderPoints": False, "method": "CuthillMcKee"})
        self.run("renumberMesh", "-overwrite")

    def decompose(self):
        if self.settings.ranks == 1:
            return
        n = self.settings.ranks
        # scotch is a stub in the Debian package
        write(self.folder / "system/decomposeParDict", {"numberOfSubdomains": n, "method": "simple", "simpleCoeffs": {"n": f"(1 {n} 1)", "delta": 0.001}})
        self.run("decomposePar", "-force")

    def start_from_steady(self):
        """The steady flow becomes time 0; its fluxes, relative to the turning frame, are left out."""
        folders = [self.folder] if self.settings.ranks == 1 else [self.folder / f"processor{i}" for i in range(self.settings.ranks)]
        for folder in folders:
            shutil.rmtree(folder / "0")
            (folder / str(STEADY_STEPS)).rename(folder / "0")
            (folder / "0/phi").unlink(missing_ok=True)
            shutil.rmtree(folder / "0/uniform", ignore_errors=True)

    # -------------------------------------------------------------- the benchmark

    def benchmark(self):
        n_steps = self.settings.warm_up + self.settings.steps
        self.control("simpleFoam", STEADY_STEPS, 1)
        self.schemes(True), self.solution(True), self.models()
        self.make_mesh()
        self.fields()
        self.decompose()
        self.run("simpleFoam", parallel=True)
        self.start_from_steady()
        self.control("pimpleFoam", n_steps * self.settings.time_step, self.settings.time_step)
        self.schemes(False), self.solution(False), self.slide()
        steps = Steps()
        self.run("pimpleFoam", parallel=True, seen=steps.read)
        if len(steps.clock) < n_steps:
            sys.exit(f"pimpleFoam has done {len(steps.clock)} steps of {n_steps}; see {self.folder}/log.pimpleFoam")
        return steps.results(self.settings.warm_up)


class Steps:
    """What pimpleFoam prints: when each step ended, and its linear solves."""

    def __init__(self):
        self.clock, self.cpu, self.solves, self.version = [], [], [[]], ""

    def read(self, line):
        if found := re.match(r"(\w+):  Solving for (\w+), Initial residual = (\S+), Final residual = (\S+), No Iterations (\d+)", line):
            _, name, initial, final, n = found.groups()
            self.solves[-1].append((name, float(initial), float(final), int(n)))
        elif found := re.match(r"Build +: (?:OPENFOAM=)?(\S+)", line):
            self.version = found.group(1)
        elif found := re.match(r"ExecutionTime = (\S+) s", line):
            self.clock.append(time.monotonic())
            self.cpu.append(float(found.group(1)))
            self.solves.append([])

    def results(self, first):
        """Of the steps from `first` on; each lasts from the end of the one before to its own."""
        difference = lambda values: [b - a for a, b in zip(values[first - 1:], values[first:])]
        return {"program": f"OpenFOAM {self.version}".strip(), "wall_s": difference(self.clock), "cpu_s": difference(self.cpu),
                "momentum": self.equation(first, ("Ux",), 1), "pressure": self.equation(first, ("p",), 2, also=("pcorr",)),
                "k": self.equation(first, ("k",), 1), "epsilon": self.equation(first, ("epsilon",), 1)}

    def equation(self, first, names, n_solves, also=()):
        """Iterations a step; drop of the residual over each `n_solves` solves, those of an outer correction."""
        steps = self.solves[first:len(self.clock)]
        iterations = sum(n for step in steps for name, _, _, n in step if name in (*names, *also)) / len(steps)
        logarithms = []
        for step in steps:
            solves = [(initial, final) for name, initial, final, _ in step if name in names]
            for one in range(0, len(solves), n_solves):
                initial, final = solves[one][0], solves[min(one + n_solves, len(solves)) - 1][1]
                if initial > 0 and final > 0:
                    logarithms.append(math.log(final / initial))
        return {"iterations": iterations, "drop": math.exp(sum(logarithms) / len(logarithms)) if logarithms else 1}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mesh", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--warm-up", type=int, default=2)
    parser.add_argument("--steps", type=int, default=8)
    parser.add_argument("--time-step", type=float, required=True, help="s")
    parser.add_argument("--flow-rate", type=float, required=True, help="m3/s")
    parser.add_argument("--speed", type=float, required=True, help="rad/s")
    parser.add_argument("--viscosity", type=float, required=True, help="m2/s")
    settings = parser.parse_args()
    results = Case(settings).benchmark()
    (pathlib.Path(settings.out) / "peer.json").write_text(json.dumps(results, indent=2) + "\n")


if __name__ == "__main__":
    main()
