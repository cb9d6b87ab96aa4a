"""Requirement: an include points only to the right of the folder order, heavy headers stay in .cpp files, and the tree holds the agreed folders only."""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
ALLOWED = {
    "base": [],
    "parallel": ["base"],
    "mesh": ["parallel", "base"],
    "solver": ["mesh", "parallel", "base"],
    "dem": ["observe", "mesh", "parallel", "base"],
    "observe": ["base"],
    "diagnosis": ["observe", "base"],
    "coupling": ["solver", "dem", "mesh", "parallel", "base"],
    "app": ["diagnosis", "coupling", "observe", "solver", "dem", "mesh", "parallel", "base"],
}
HEAVY = re.compile(r"(toml\+\+|spdlog|nlohmann/json.hpp|CLI|petsc|hdf5|gmsh)")
TOP = set(ALLOWED) | {"cases", "tests", "docs", "share", "CMakeLists.txt", "CMakePresets.json", "README.md", "LICENSE", "snag",
                      "CHANGELOG.md", "CITATION.cff", "CODE_OF_CONDUCT.md", "CONTRIBUTING.md", "Containerfile", "build", "results"}

problems = []
for path in root.iterdir():
    if path.name not in TOP and not path.name.startswith("."):
        problems.append(f"{path.name}: not a part of the tree's top level; put it into one of its folders")
checked = 0
heavy = {}     # headers that include a heavy one
includes = []
for folder, allowed in ALLOWED.items():
    for path in sorted((root / folder).rglob("*.[ch]pp")):
        checked += 1
        generator = "mesh/generate" in path.as_posix()
        for number, line in enumerate(path.read_text().splitlines(), 1):
            include = re.match(r'\s*#include\s+(["<])([^">]+)[">]', line)
            if not include:
                continue
            quoted, target = include.group(1) == '"', include.group(2)
            place = f"{path.relative_to(root)}:{number}"
            first = target.split("/")[0]
            if quoted and first in ALLOWED:
                if generator and first != "base" and not target.startswith("mesh/generate/"):
                    problems.append(f"{place}: the mesh generator includes {target}; it may include base/ only")
                elif first != folder and first not in allowed:
                    problems.append(f"{place}: {folder}/ includes {target}; it may include {', '.join(allowed) or 'nothing'} only")
            if path.suffix == ".hpp" and HEAVY.match(target):
                heavy[path.relative_to(root).as_posix()] = f"{place}: {target} in a header"
            includes.append((path, target, place))
            if target.startswith("gmsh") and not generator:
                problems.append(f"{place}: gmsh is linked to the mesh generator only")
# Such headers, and headers that include them, may serve their own folder only.
grown = True
while grown:
    grown = False
    for path, target, place in includes:
        name = path.relative_to(root).as_posix()
        if target in heavy and path.suffix == ".hpp" and name not in heavy:
            heavy[name] = heavy[target]
            grown = True
for path, target, place in includes:
    if target in heavy and path.relative_to(root).parts[0] != target.split("/")[0]:
        problems.append(f"{heavy[target]}, which {place} includes; only files of the same folder may")
print("\n".join(problems) or f"{checked} files are layered")
sys.exit(1 if problems or checked < 10 else 0)
