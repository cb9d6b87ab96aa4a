"""Meshes of hexahedra: fine around the origin and growing from there, for bodies in a wide stream; rings, fine at their walls."""
import numpy

# The patch that write() makes around a hole.
PLATE = """
[[boundary]]
patch = "plate"
kind = "wall"
"""


def free_stream(speed):
    """Boundaries of a stream along x (m/s) between planes of symmetry."""
    return f"""
[[boundary]]
patch = "x0"
kind = "velocity_inlet"
velocity_m_s = [{speed}, 0, 0]
[[boundary]]
patch = "x1"
kind = "pressure_outlet"
[[boundary]]
patches = ["y0", "y1", "z0", "z1"]
kind = "symmetry"
"""


def axis(lower, upper, fine, size, growth):
    """Nodes: steps of `size` in the interval `fine`, growing outwards by `growth`."""

    def outwards(start, end):
        nodes, sign, step = [], numpy.sign(end - start), size
        while True:
            step *= growth
            start += sign * step
            if sign * (end - start) < 0.6 * step:
                return [*nodes, end]
            nodes.append(start)

    middle = numpy.linspace(*fine, round((fine[1] - fine[0]) / size) + 1)
    return numpy.array([*reversed(outwards(fine[0], lower)), *middle, *outwards(fine[1], upper)])


def towards(ends, n, first):
    """Nodes of n steps from ends[0] to ends[1], the first and last about `first` long, growing geometrically to the middle."""
    length, half = ends[1] - ends[0], n // 2
    low, high = 1.0, 10.0
    for _ in range(100):
        q = (low + high) / 2
        low, high = (q, high) if first * (q**half - 1) / (q - 1) < length / 2 else (low, q)
    steps = first * q ** numpy.arange(half)
    steps *= length / 2 / steps.sum()
    return ends[0] + numpy.concatenate([[0], numpy.cumsum(numpy.concatenate([steps, steps[::-1]]))])


def write(file, nodes, hole=None):
    """A mesh in MSH 2.2 of the box between the nodes of the three axes, patches x0, x1, y0, y1, z0, z1. `hole`: three intervals; the cells with their centres in
    all of them are left out, behind the patch plate. Returns the number of cells."""
    shape = [len(n) - 1 for n in nodes]
    inside = [(n[1:] + n[:-1]) / 2 for n in nodes]
    solid = numpy.zeros(shape, bool)
    if hole:
        marks = [(c > lower) & (c < upper) for c, (lower, upper) in zip(inside, hole)]
        solid = marks[0][:, None, None] & marks[1][None, :, None] & marks[2][None, None, :]
    number = 1 + numpy.arange(numpy.prod([len(n) for n in nodes])).reshape([len(n) for n in nodes], order="F")
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    faces = {"x0": (0, 4, 7, 3), "x1": (1, 2, 6, 5), "y0": (0, 1, 5, 4), "y1": (3, 7, 6, 2), "z0": (0, 3, 2, 1), "z1": (4, 5, 6, 7)}
    patches = [*faces, *(["plate"] if hole else [])]
    i, j, k = (index.ravel(order="F") for index in numpy.indices(shape))
    vertices = numpy.stack([number[i + a, j + b, k + c] for a, b, c in corners], axis=1)
    cells = ~solid[i, j, k]
    quads = {patch: [] for patch in patches}
    around = numpy.pad(solid, 1, constant_values=False)
    for side, (name, face) in enumerate(faces.items()):
        step = [0, 0, 0]
        step[side // 2] = 2 * (side % 2) - 1
        beyond = [index + s for index, s in zip((i, j, k), step)]
        at_end = (beyond[side // 2] < 0) | (beyond[side // 2] >= shape[side // 2])
        at_plate = around[beyond[0] + 1, beyond[1] + 1, beyond[2] + 1]
        quads[name].extend(vertices[cells & at_end][:, face])
        if hole:
            quads["plate"].extend(vertices[cells & at_plate][:, face])
    write_cells(file, numpy.stack(numpy.meshgrid(*nodes, indexing="ij"), axis=-1).reshape(-1, 3, order="F"), vertices[cells], quads)
    return int(cells.sum())


def write_ring(file, sectors, radii, heights, disc=0):
    """A mesh in MSH 2.2 of the cells around the z axis between radii and heights (m), patches inner, outer, bottom, top; the bottom within the radius `disc` is the
    patch disc."""
    n_r, n_z = len(radii), len(heights)
    number = 1 + numpy.arange(sectors * n_r * n_z).reshape(sectors, n_r, n_z)
    angle = 2 * numpy.pi * numpy.arange(sectors) / sectors
    r, z = numpy.broadcast_arrays(radii[:, None], heights)
    places = numpy.stack([numpy.outer(numpy.cos(angle), r), numpy.outer(numpy.sin(angle), r), numpy.outer(numpy.ones(sectors), z)], axis=-1).reshape(-1, 3)
    i, j, k = (index.ravel() for index in numpy.indices((sectors, n_r - 1, n_z - 1)))
    corners = [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0), (0, 0, 1), (0, 1, 1), (1, 1, 1), (1, 0, 1)]
    cells = numpy.stack([number[(i + a) % sectors, j + b, k + c] for a, b, c in corners], axis=1)
    on_disc = radii[1:][j] < disc * (1 + 1e-9)
    quads = {"inner": cells[j == 0][:, [0, 4, 7, 3]], "outer": cells[j == n_r - 2][:, [1, 2, 6, 5]], "bottom": cells[(k == 0) & ~on_disc][:, [0, 3, 2, 1]],
             "top": cells[k == n_z - 2][:, [4, 5, 6, 7]]}
    if disc:
        quads["disc"] = cells[(k == 0) & on_disc][:, [0, 3, 2, 1]]
    write_cells(file, places, cells, quads)


def write_cells(file, places, cells, faces):
    """MSH 2.2: places [nodes][3] in m, hexahedra and prisms by their nodes, {patch: quadrangles and triangles}; numbers of nodes from 1 on."""
    patches = list(faces)
    lines = [f"{5 if len(v) == 8 else 6} 2 9 9 {' '.join(map(str, v))}" for v in cells]
    for n, patch in enumerate(patches):
        lines += [f"{len(v) - 1} 2 {n + 1} {n + 1} {' '.join(map(str, v))}" for v in faces[patch]]
    with open(file, "w") as text:
        names = "".join(f'2 {n + 1} "{patch}"\n' for n, patch in enumerate(patches))
        text.write(f'$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{len(patches) + 1}\n{names}3 9 "water"\n$EndPhysicalNames\n$Nodes\n{len(places)}\n')
        text.writelines(f"{n + 1} {x:.12g} {y:.12g} {z:.12g}\n" for n, (x, y, z) in enumerate(places))
        text.write(f"$EndNodes\n$Elements\n{len(lines)}\n")
        text.writelines(f"{n + 1} {line}\n" for n, line in enumerate(lines))
        text.write("$EndElements\n")
