"""Requirement: an include points only down the order of folders, never in a circle between rooms (folders and their subfolders) or headers; heavy headers stay in .cpp files; the tree holds the agreed folders only, and the README lists them."""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
ALLOWED = {
    "base": [],
    "parallel": ["base"],
    "observe": ["base"],
    "mesh": ["parallel", "base"],
    "solver": ["mesh", "parallel", "base"],
    "dem": ["mesh", "parallel", "base"],
    "coupling": ["solver", "dem", "mesh", "parallel", "base"],
    "diagnosis": ["observe", "base"],  # sees measurements and a simulator, never a solver
    "textile": ["dem", "observe", "mesh", "parallel", "base"],
    "simulation": ["coupling", "solver", "dem", "mesh", "observe", "parallel", "base"],
    "casework": ["simulation", "diagnosis", "coupling", "solver", "dem", "mesh", "observe", "parallel", "base"],
    "benchmark": ["casework", "simulation", "diagnosis", "coupling", "solver", "dem", "mesh", "observe", "parallel", "base"],
    "report": ["textile", "simulation", "diagnosis", "observe", "parallel", "base"],
}
ALLOWED["app"] = list(ALLOWED)
HEAVY = re.compile(r"(toml\+\+|spdlog|nlohmann/json.hpp|CLI|petsc|hdf5|gmsh)")
TOP = set(ALLOWED) | {"cases", "tests", "docs", "share", "CMakeLists.txt", "CMakePresets.json", "README.md", "LICENSE", "snag",
                      "CHANGELOG.md", "CITATION.cff", "CODE_OF_CONDUCT.md", "CONTRIBUTING.md", "Containerfile", "MAINTAINERS.md", "SECURITY.md", "build", "results"}

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


def circle(arrows):
    """A circle of a graph {node: nodes}, as a list that begins and ends with the same node; [] if there is none."""
    state, path = {}, []  # 1: on the path, 2: done

    def visit(node):
        state[node] = 1
        path.append(node)
        for other in sorted(arrows.get(node, ())):
            if state.get(other) == 1:
                return path[path.index(other):] + [other]
            if other not in state and (found := visit(other)):
                return found
        state[node] = 2
        path.pop()
        return []

    for node in sorted(arrows):
        if node not in state and (found := visit(node)):
            return found
    return []


headers, rooms, reasons = {}, {}, {}
for path, target, place in includes:
    name, room = path.relative_to(root).as_posix(), path.parent.relative_to(root).as_posix()
    if not (root / target).is_file():
        continue
    if path.suffix == ".hpp":
        headers.setdefault(name, set()).add(target)
    other = target.rsplit("/", 1)[0]
    if other != room:
        rooms.setdefault(room, set()).add(other)
        reasons.setdefault((room, other), f"{place} includes {target}")
if found := circle(headers):
    problems.append("headers include each other in a circle: " + " -> ".join(found))
if found := circle(rooms):
    problems.append("folders include each other in a circle: " + "; ".join(reasons[pair] for pair in zip(found, found[1:])))

# The README's table of folders is the tree.
table = dict(re.findall(r"^\| `(\w+)/` \| (.*) \|$", (root / "README.md").read_text(), re.M))
for folder in ALLOWED:
    if folder not in table:
        problems.append(f"README.md: the table of folders lacks {folder}/")
    for sub in sorted(p.name for p in (root / folder).iterdir() if any(p.rglob("*.[ch]pp"))):
        if f"`{sub}/`" not in table.get(folder, ""):
            problems.append(f"README.md: the row of {folder}/ lacks `{sub}/`")
for folder, text in table.items():
    if not (root / folder).is_dir():
        problems.append(f"README.md: the table of folders has {folder}/, which is not there")
    for sub in re.findall(r"`(\w+)/`", text):
        if not (root / folder / sub).is_dir():
            problems.append(f"README.md: the row of {folder}/ has `{sub}/`, which is not there")
command_line = sum(len(p.read_text().splitlines()) for p in (root / "app").rglob("*.[ch]pp"))
if command_line > 1300:
    problems.append(f"app/ has {command_line} lines, the command line alone at most 1300: what computes, writes or draws has folders of its own")
print("\n".join(problems) or f"{checked} files are layered")
sys.exit(1 if problems or checked < 10 else 0)
