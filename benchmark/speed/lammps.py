"""The sheet of `snag bench dem` in LAMMPS (Debian package lammps): spheres with harmonic bonds, angles and dihedrals, Hertz contacts.

    lammps.py --columns 150 --rows 110 --steps 200 --out DIR      writes DIR/peer.json

Bonded particles that turn (package BPM) are not in the Debian version: a bead resists bending through the angles between its neighbours and
does not turn with its bonds, which is less work. Processor time of a run without steps is taken off.
"""
import argparse
import json
import math
import pathlib
import resource
import subprocess

RADIUS, DENSITY = 1e-3, 538.0  # m, kg/m3
INPUT = """
units si
atom_style hybrid sphere molecular
boundary f f f
newton on on
comm_modify vel yes cutoff 6.0e-3
special_bonds lj/coul 0 0 0
read_data sheet.data extra/bond/per/atom 4 extra/special/per/atom 30
neighbor 3.0e-4 bin
neigh_modify delay 0 every 10 check yes
bond_style harmonic
bond_coeff 1 1201.7 2.0e-3
bond_coeff 2 664.5 2.0e-3
angle_style harmonic
angle_coeff 1 1.5e-5 90.0
dihedral_style harmonic
dihedral_coeff 1 1.5e-5 1 1
pair_style gran/hertz/history 1.4e7 1.65e7 100.0 50.0 0.3 1
pair_coeff * *
fix motion all nve/sphere
fix drag all viscous 1e-6
fix weight all gravity 9.81 vector 0 0 -1
timestep 5.0e-7
thermo 500
run {steps}
"""


def sheet(columns, rows):
    """Text of the data file: positions, waves as in Snag's case, bonds, angles of every lattice cell, dihedrals across every edge."""
    def number(i, j):
        return j * columns + i + 1

    atoms, speeds, bonds, angles, dihedrals = [], [], [], [], []
    turn = 2 * math.pi
    for j in range(rows):
        for i in range(columns):
            atoms.append(f"{2 * RADIUS * i:.9g} {2 * RADIUS * j:.9g} 0 {2 * RADIUS:g} {DENSITY:g} 1")
            speeds.append(f"{0.1 * math.sin(turn * j / 30):.6g} {0.1 * math.cos(turn * i / 30):.6g} "
                          f"{0.5 * math.sin(turn * i / 50) * math.cos(turn * j / 37):.6g} 0 0 0")
            right, up = i < columns - 1, j < rows - 1
            if right:
                bonds.append((1, number(i, j), number(i + 1, j)))
            if up:
                bonds.append((2, number(i, j), number(i, j + 1)))
            if right and up:
                angles.append((1, number(i + 1, j), number(i, j), number(i, j + 1)))
                angles.append((1, number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)))
            if 0 < i and right and up:
                dihedrals.append((1, number(i - 1, j), number(i, j), number(i, j + 1), number(i + 1, j + 1)))
            if 0 < j and right and up:
                dihedrals.append((1, number(i, j - 1), number(i, j), number(i + 1, j), number(i + 1, j + 1)))
    low, high = -10 * RADIUS, 10 * RADIUS
    text = f"sheet\n\n{len(atoms)} atoms\n{len(bonds)} bonds\n{len(angles)} angles\n{len(dihedrals)} dihedrals\n"
    text += "1 atom types\n2 bond types\n1 angle types\n1 dihedral types\n"
    text += f"{low:g} {2 * RADIUS * columns + high:g} xlo xhi\n{low:g} {2 * RADIUS * rows + high:g} ylo yhi\n{low:g} {high:g} zlo zhi\n"
    text += "\nAtoms\n\n" + "".join(f"{k + 1} 1 {line}\n" for k, line in enumerate(atoms))
    text += "\nVelocities\n\n" + "".join(f"{k + 1} {line}\n" for k, line in enumerate(speeds))
    for name, entries in (("Bonds", bonds), ("Angles", angles), ("Dihedrals", dihedrals)):
        text += f"\n{name}\n\n" + "".join(f"{k + 1} {' '.join(map(str, entry))}\n" for k, entry in enumerate(entries))
    return text


def user_seconds(folder, steps):
    """Of a run of so many steps on one processor."""
    (folder / "in.sheet").write_text(INPUT.format(steps=steps))
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    with open(folder / f"log.{steps}", "w") as log:
        subprocess.run(["lmp", "-in", "in.sheet", "-log", "none"], cwd=folder, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT, check=True)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--out", type=pathlib.Path, required=True)
    for name in ("columns", "rows", "steps"):
        parser.add_argument(f"--{name}", type=int, required=True)
    settings = parser.parse_args()
    (settings.out / "sheet.data").write_text(sheet(settings.columns, settings.rows))
    repeats = 3
    spent = min(user_seconds(settings.out, settings.steps) for _ in range(repeats)) - min(user_seconds(settings.out, 0) for _ in range(repeats))
    particle_steps = settings.columns * settings.rows * settings.steps
    found = {"program": "LAMMPS, bead sheet without rotation (Debian)", "user_s": spent, "million_particle_steps_per_s": 1e-6 * particle_steps / spent}
    (settings.out / "peer.json").write_text(json.dumps(found, indent=2) + "\n")


if __name__ == "__main__":
    main()
