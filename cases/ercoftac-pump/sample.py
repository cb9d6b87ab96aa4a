"""What a run of the pump gives where it was measured, from its fields and monitors; needs numpy, vtk.

The frame of the measurement: y in pitches of the blades, growing with the angle. Its figures show the vanes at Y_VANE and a blade at 0.3 on the circle of the probe. The blade ends 4.2 mm
inside that circle; a particle that leaves its edge with the mean measured velocity relative to the blade (wr = cr, wu = cu - 1.02 U2) reaches the circle WAKE pitches further: the mark 0.3 is
taken as that place. Seven blades and twelve vanes: in one field at most one pair of neighbouring blades has the vanes where they were in a measured instant. The fields of a case whose
step is 1/210 of a revolution have it to 0.01 pitches."""
import pathlib
import sys
import tomllib
import xml.etree.ElementTree

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkProbeFilter, vtkCellDataToPointData
from vtkmodules.vtkIOXML import vtkXMLPUnstructuredGridReader

here = pathlib.Path(__file__).parent
sys.path.insert(0, str(here.parents[1] / "share" / "python"))
from snag.tables import read_columns

BLADES, VANES, R2, SPEED, SPAN = 7, 12, 0.21, 2000 * numpy.pi / 30, 0.0404  # m, rad/s
PIPE, ROD, VANE_OUTLET, AT_CASING = 0.092, 0.009, 0.332, 1e-4  # m; the last: height of the pressure on the casing, in the first cell at it
ACROSS = (numpy.arange(40) + 0.5) / 40  # places over the span
U2, PITCH = R2 * SPEED, 360 / BLADES
PROBE = 1.02 * R2
TRAILING_EDGE, VANE_EDGE = 77.5, 0.1  # degrees: middle of the blade's end, nose of the vane, at start
INSTANTS = ("0.126", "0.226", "0.326", "0.426")
MEAN_CR, MEAN_CU = 0.1304, 0.3829  # over U2, measured, over span, circumference and the instants
WAKE = (1.02 - MEAN_CU) / MEAN_CR * (PROBE - R2) / (1.01 * R2) / numpy.radians(PITCH)
Y_BLADE, Y_VANE = 0.3 - WAKE, {"0.126": 0.02, "0.226": 0.12, "0.326": 0.214, "0.426": 0.322}  # pitches
Y = numpy.arange(0, 2, 0.01)  # pitches


def circles(field, radius, n, heights):
    """Velocity and pressure at n places of a circle at each height: arrays [height, place]."""
    angle, z = numpy.meshgrid(2 * numpy.pi * numpy.arange(n) / n, heights)
    points = vtkPoints()
    points.SetData(numpy_to_vtk(numpy.stack([radius * numpy.cos(angle), radius * numpy.sin(angle), z], axis=-1).reshape(-1, 3), deep=True))
    places = vtkPolyData()
    places.SetPoints(points)
    probe = vtkProbeFilter()
    probe.SetInputData(places)
    probe.SetSourceData(field)
    probe.Update()
    data = probe.GetOutput().GetPointData()
    arrays = {data.GetArrayName(i).split(" ")[0]: vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
    inside = arrays["vtkValidPointMask"].reshape(angle.shape) > 0
    u, v, w = (arrays["velocity"][:, i].reshape(angle.shape) for i in range(3))
    cr, ct = u * numpy.cos(angle) + v * numpy.sin(angle), v * numpy.cos(angle) - u * numpy.sin(angle)
    return inside, cr / U2, -ct / U2, w / U2, arrays["pressure"].reshape(angle.shape)  # cu is positive in the direction of rotation


def interpolated(inside, values):
    """Values along circles where the probe found no cell, which happens between the curved faces of a few hexahedra: by those of the neighbours."""
    places = numpy.arange(values.shape[1])
    return numpy.array([numpy.interp(places, places[found], v[found], period=len(places)) for found, v in zip(inside, values)])


def over_span(z_over_b, values):
    """Mean over the span by the trapezoidal rule, end values extended to the walls, as of the measured points."""
    return numpy.trapz(numpy.concatenate([values[:1], values, values[-1:]]), numpy.concatenate([[0], z_over_b, [1]]))


def fields(folder, start, end):
    """(time, grid with values at its nodes) of the fields written from `start` to `end`, s."""
    for entry in xml.etree.ElementTree.parse(folder / "fields" / "water.pvd").iter("DataSet"):
        time = float(entry.get("timestep"))
        if start <= time <= end:
            reader = vtkXMLPUnstructuredGridReader()
            reader.SetFileName(str(folder / "fields" / entry.get("file")))
            to_points = vtkCellDataToPointData()
            to_points.SetInputConnection(reader.GetOutputPort())
            to_points.Update()
            yield time, to_points.GetOutput()


class Sampled:
    """Means over the fields of a run from `start` on: `mean_cu`, `mean_cr` and their profiles over y at four instants at 1.02 R2, `cp` at `radii`, and integrals.

    A run in three dimensions has the profiles at mid-span, `cp` on the front casing, `span_cr` and `span_cu` at the measured places of the span, of which mean_cr and mean_cu are the means,
    and `psi_vanes`: total pressure at the outlet of the vanes, weighted by the flow, less that in the inlet."""

    def __init__(self, folder, start, end=numpy.inf, radii=(), profiles=True):
        folder = pathlib.Path(folder)
        case = tomllib.loads((folder / "case.resolved.toml").read_text())
        pump = read_columns(folder / "monitors" / "pump.csv")
        names, values = pump[0], pump[2]
        of = lambda name: values[:, names.index(name)]
        time, density = of("time"), case["flow"]["density_kg_m3"]
        pressure = density * U2**2 / 2
        last = (time > start) & (time <= end)
        mean = lambda name: of(name)[last].mean()
        n, self.n_fields = 4200, 0
        profile = {instant: [] for instant in INSTANTS}
        cu, cr, p, leaving = [], [], [[] for _ in radii], []
        z_over_b = measured_span()[0]
        for t, grid in fields(folder, start, end):
            bounds = grid.GetBounds()
            self.is_plane = bounds[5] - bounds[4] < SPAN / 2
            heights = [(bounds[4] + bounds[5]) / 2] if self.is_plane else [SPAN / 2, *SPAN * (1 - z_over_b)]
            inside, a, b, _, _ = circles(grid, PROBE, n, heights)
            assert inside.mean() > 0.99
            a, b = (interpolated(inside, c) for c in (a, b))
            cr.append(a.mean(axis=1)), cu.append(b.mean(axis=1))
            a, b = a[0], b[0]
            for k, r in enumerate(radii):
                within, _, _, _, values_p = circles(grid, r * R2, 720, heights if self.is_plane else [AT_CASING])
                p[k].append(values_p[within].mean())
            if not self.is_plane:
                within, *velocity, values_p = circles(grid, VANE_OUTLET, n // 2, SPAN * ACROSS)
                total = values_p + pressure * sum(c**2 for c in velocity)
                leaving.append((total * velocity[0])[within].sum() / velocity[0][within].sum())
            self.n_fields += 1
            turned = -numpy.interp(t, time, of("revolutions")) * 360  # towards negative angles
            if not profiles:
                continue
            for instant in INSTANTS:
                # Offset of a vane from a blade, in pitches: (VANE_EDGE + 30 j - TRAILING_EDGE - turned - PITCH i)/PITCH = Y_VANE - Y_BLADE + whole vane pitches
                blades = TRAILING_EDGE + turned + PITCH * numpy.arange(BLADES)
                off = (VANE_EDGE - blades) / PITCH - (Y_VANE[instant] - Y_BLADE)
                off = (off + 3.5 / 12) % (7 / 12) - 3.5 / 12
                best = numpy.abs(off).argmin()
                if abs(off[best]) < 0.01:
                    angle = blades[best] + (Y - Y_BLADE) * PITCH
                    at = lambda q: numpy.interp(angle % 360, 360 * numpy.arange(n + 1) / n, numpy.append(q, q[0]))
                    profile[instant].append((at(a), at(b)))
        height = bounds[5] - bounds[4] if self.is_plane else SPAN
        self.mean_cr, self.mean_cu = (numpy.mean(c, axis=0)[0] for c in (cr, cu))
        if not self.is_plane:
            self.midspan_cr, self.midspan_cu = self.mean_cr, self.mean_cu
            self.span_cr, self.span_cu = (numpy.mean(c, axis=0)[1:] for c in (cr, cu))
            self.mean_cr, self.mean_cu = (over_span(z_over_b, c) for c in (self.span_cr, self.span_cu))
        self.p = [numpy.mean(q) for q in p]
        self.profile = {instant: (numpy.mean(list_, axis=0), len(list_)) for instant, list_ in profile.items() if list_}
        patches = read_columns(folder / "monitors" / "patches.csv")
        late = (patches[2][:, 0] > start) & (patches[2][:, 0] <= end)
        inlet = patches[2][late, patches[0].index("inlet_pressure")].mean()
        speed = mean("flow_in") / (2 * numpy.pi * 0.1 * height if self.is_plane else numpy.pi * (PIPE**2 - ROD**2))
        self.inlet_total = inlet + density * speed**2 / 2
        self.cp = (numpy.array(self.p) - self.inlet_total) / pressure
        self.psi = 2 * 9.81 * mean("head_total") / U2**2  # of density times gravity times head_total
        self.psi_static = 2 * 9.81 * mean("head") / U2**2
        if not self.is_plane:
            self.psi_vanes = (numpy.mean(leaving) - self.inlet_total) / pressure
        self.torque = mean("torque") * SPAN / height
        self.flow = mean("flow_in") * SPAN / height
        self.psi_euler = 2 * mean("torque") * SPEED / (density * mean("flow_in") * U2**2)


def rms_of_profiles(sampled, measured, component=1):
    """rms over the four instants and two pitches of the difference of cu (component 1) or cr (0) at mid-span; `measured`: {instant: (y, cr, cu)}."""
    differences = []
    for instant, (y, *m) in measured.items():
        differences.append(numpy.interp(y, Y, sampled.profile[instant][0][component], period=2) - m[component])
    return numpy.sqrt(numpy.mean(numpy.concatenate(differences) ** 2))


def measured_midspan(file=here / "midspan.csv"):
    """{instant: (y, cr/U2, cu/U2)} at mid-span."""
    lines = [line.split(",") for line in file.read_text().splitlines() if line[0].isdigit()]
    return {instant: tuple(numpy.array([[float(w) for w in line[1:]] for line in lines if line[0] == instant]).T) for instant in INSTANTS}


def measured_casing(file=here / "casing.csv"):
    """r/R2 and the mean cp on the casing."""
    return numpy.loadtxt(file, delimiter=",", skiprows=2)[:, :2].T


def casing_difference(sampled, cp):
    """cp of a run at the measured radii less the measured one, and the reference pressure that is fitted (least squares)."""
    reference = numpy.mean(sampled.cp - cp)
    return sampled.cp - cp - reference, reference


def measured_span(file=here / "span.csv"):
    """z/b from the hub on, cr/U2 and cu/U2, means over the circumference and four instants."""
    return numpy.loadtxt(file, delimiter=",", skiprows=2).T
