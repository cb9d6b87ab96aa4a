"""Discs that are cut along many radii, round a rigid hub in a prescribed stream, and single sectors of them: case files, and the drag over that of the rigid disc. Gosselin, de Langre and
Machado-Almeida (2010), J. Fluid Mech. 650, 319-341: R = F/(rho A C_D U^2/2), C = C_D taper rho (R - R_i)^3 U^2/(2 B), taper = R/R_i.

cut_disc.py RADIUS C FILE writes the case of a disc."""
import math
import pathlib
import sys

DENSITY, DRAG, SPEED = 1000.0, 1.17, 1.0  # kg/m3, C_D, m/s
PRESSURE = DRAG * DENSITY * SPEED**2 / 2  # Pa

CASE = """
[case]
name = "disc"
[time]
end_s = {end!r}
step_s = {step!r}
[flow]
kind = "prescribed"
density_kg_m3 = 1000
dynamic_viscosity_Pa_s = 1e-3
velocity_m_s = [0, 0, 1]
[contact]
self_contact = false            # sectors that bend overlap; those of the model do not feel each other
{cloth}
[coupling]
mode = "one_way"
forces = ["free_stream_drag", "sheet_drag"]
[coupling.sheet_drag]
share = 1
normal_coefficient = 1.17
tangential_coefficient = 0
[output]
report = false
"""

CLOTH = """
[[{table}]]
radius_m = {particle!r}
{shape}
mass_per_area_kg_m2 = {mass}
properties = "custom"
{bonds}
{cuts}
[[hold]]
particles = {held}
"""


class Piece:
    """Text of a case, taper of its sectors, and areas in m2: `fixed` of what is held and does not belong to the sectors, `sectors` of all else."""

    def __init__(self, text, taper, fixed, sectors):
        self.text, self.taper, self.fixed, self.sectors = text, taper, fixed, sectors

    def reconfiguration(self, run):
        return (run.monitor("coupling").column("force_on_rags_z")[-1] / PRESSURE - self.fixed) / self.sectors


class Disc:
    """`pressure` C_D rho U^2/2, Pa."""

    def __init__(self, radius, hub=0.009, n_cuts=18, pressure=PRESSURE):
        self.radius, self.hub, self.n_cuts, self.pressure = radius, hub, n_cuts, pressure
        self.length = radius - hub

    def text(self, table, C, taper, particle, shape, cuts, held, mass):
        """Bonds as stiff against a twist as against a bend: a lattice of such bonds bends alike in all directions."""
        bending = 4 * taper * self.pressure * self.length**3 / C / (math.pi * particle**4)
        bonds = {"bending": bending, "tangential": bending / 2, "normal": bending / 2}
        return CLOTH.format(table=table, particle=particle, shape=shape, mass=mass, held=held, bonds="\n".join(f"{kind}_stiffness_{way}wise_N_m3 = {value!r}" for kind, value in bonds.items() for way in ("length", "cross")),
                            cuts="\n".join(f"[[{table}.cut]]\nfrom_m = {list(a)}\nto_m = {list(b)}" for a, b in cuts))

    def places(self, columns):
        """Of the particles of a square, as many on a side, m."""
        spacing = 2 * self.radius / columns
        return [((i - (columns - 1) / 2) * spacing, (j - (columns - 1) / 2) * spacing) for j in range(columns) for i in range(columns)]

    def cloth(self, C, columns, mass, place=""):
        """Text of the disc, as many particles wide; the hub ends half a spacing behind the last particles that are held."""
        particle = self.radius / columns
        held = [k for k, at in enumerate(self.places(columns)) if math.hypot(*at) <= self.hub + particle]
        radii = [(math.cos(a), math.sin(a)) for a in (0.05 + 2 * math.pi * k / self.n_cuts for k in range(self.n_cuts))]
        cuts = [((self.hub * x, self.hub * y), (1.1 * self.radius * x, 1.1 * self.radius * y)) for x, y in radii]
        return self.text("disc", C, self.radius / self.hub, particle, f"diameter_m = {2 * self.radius!r}\n{place}", cuts, held, mass)

    def whole(self, C, columns, end, mass=1):
        """The disc in a prescribed stream."""
        area = (2 * self.radius / columns) ** 2 * sum(math.hypot(*at) <= self.radius * (1 + 1e-12) for at in self.places(columns))
        hub = math.pi * self.hub**2
        text = CASE.format(end=end, step=end / 100, cloth=self.cloth(C, columns, mass))
        return Piece(text, self.radius / self.hub, hub, area - hub)

    def sector(self, C, across, end, mass=1, angle=0):
        """A flap in a cloth that is held: one sector as the model has it, a trapeze of the length R - R_i, at `angle` to the rows of the lattice, with as many particles across it at its clamp.

        Along the rows the particles of the clamp are on its line, its corners midway between two rows, and its tip half a spacing behind the last particles: for that its
        clamp is up to 1 % wider or narrower than the sector of the disc."""
        c, s = math.cos(angle), math.sin(angle)
        slope, width = math.pi / self.n_cuts, 2 * math.pi * self.hub / self.n_cuts
        spacing = self.length / (round(self.length / width * across) + 0.5)
        inner = across * spacing / 2  # half widths
        outer = inner + slope * self.length
        # The first bonds bend from the last particles that are held; on average these are that far before a line along which particles are held.
        before = spacing / 2 * (abs(c) ** 3 + abs(s) ** 3)
        last_held = before if angle else 0

        def turned(u, v):
            return c * u - s * v, s * u + c * v

        corners = [turned(*corner) for corner in ((0, inner), (0, -inner), (self.length, outer), (self.length, -outer))]
        lower, upper = ([side(corner[axis] for corner in corners) for axis in (0, 1)] for side in (min, max))
        columns, rows = (math.ceil((b - a) / spacing) + 4 for a, b in zip(lower, upper))
        rows += (rows - across) % 2
        middle = lower[0] + ((columns - 1) / 2 - 2) * spacing, (lower[1] + upper[1]) / 2

        def bends(column, row):
            x, y = (m + (k - (n - 1) / 2) * spacing for m, k, n in zip(middle, (column, row), (columns, rows)))
            u, v = c * x + s * y, c * y - s * x
            return last_held + 1e-9 < u <= self.length and abs(v) <= inner + slope * u

        held = [row * columns + column for row in range(rows) for column in range(columns) if not bends(column, row)]
        ends = [(corners[0], corners[2]), (corners[1], corners[3]), (corners[2], corners[3])]
        cuts = [[[x - m for x, m in zip(end, middle)] for end in cut] for cut in ends]
        sector = (columns * rows - len(held)) * spacing**2 + 2 * inner * before  # with what belongs to particles of the clamp
        shape = f"length_m = {columns * spacing!r}\nwidth_m = {rows * spacing!r}"
        cloth = self.text("rag", C, outer / inner, spacing / 2, shape, cuts, held, mass)
        return Piece(CASE.format(end=end, step=end / 100, cloth=cloth), outer / inner, columns * rows * spacing**2 - sector, sector)


if __name__ == "__main__":
    radius, C = map(float, sys.argv[1:3])
    end = 0.1 * (radius / 0.037) ** 2
    pathlib.Path(sys.argv[3]).write_text(Disc(radius).whole(C, 149, end).text + f"rags_interval_s = {end!r}\n")
