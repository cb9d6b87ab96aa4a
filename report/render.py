#!/usr/bin/env python3
"""Pictures of a run, without a screen: the rag in its surroundings at several instants, the water's speed on slices; of a rotor the
speed in its middle plane and the pressure on the walls.

    xvfb-run -a /usr/bin/python3 render.py DIR --out DIR/pictures [--film]

Reads fields/water.pvd, rags/rags.pvd and walls/walls.vtp (or walls.pvd) of DIR as far as they exist; writes PNG files and pictures.json, a list of
{file, group, caption}, rewritten after each picture so that what was made before a failure is kept. With --film only film_0001.png and so
on, a picture for each time at which the rags were written, and film.json.

Rags in a pump are seen from its inlet. The impeller stands at its angle: walls are written less often than rags, so those of the rotor
are turned from the nearest time at which they were written, by what monitors/pump.csv says of the shaft.
"""
import argparse
import csv
import json
import pathlib
import sys
import tomllib
import xml.etree.ElementTree as ElementTree

import numpy as np
import vtkmodules.vtkRenderingFreeType  # noqa: F401  (text)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  (the renderer registers itself)
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPlane, vtkPolyData
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkFiltersCore import (vtkArrayCalculator, vtkCellDataToPointData, vtkCleanPolyData, vtkCutter, vtkFeatureEdges,
                                       vtkPolyDataNormals, vtkThreshold)
from vtkmodules.vtkFiltersGeneral import vtkContourTriangulator, vtkTransformPolyDataFilter
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPPolyDataReader, vtkXMLPUnstructuredGridReader, vtkXMLUnstructuredGridReader
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkTextActor, vtkWindowToImageFilter

FONT = pathlib.Path("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf")   # VTK's own font is used without it
VTK_FONT_FILE = 4       # of vtkTextProperty.h
N_INSTANTS = 9
N_EVENTS = 2            # that a picture names
FILM_HOLD = 12          # pictures of a film that an event stays in: half a second
ROOT = None             # folder of the results
BARS, TIME = 76, 40     # pixels at the lower and upper edge of a picture for colour bars and time
# Anchors of two colour scales that print well and do not rely on red and green: light to dark blue, light yellow to dark red.
BLUES = ["#f3f8fd", "#c8dcf0", "#8fbfe0", "#4f9bcb", "#2070b4", "#08306b"]
FIRE = ["#fff6c2", "#fed26a", "#fb9a3c", "#ec5a2b", "#bf1f2e", "#6b0a26"]


def colour_table(anchors, low, high):
    """256 colours between the anchors, for values from low to high."""
    rgb = np.array([[int(a[i:i + 2], 16) / 255 for i in (1, 3, 5)] for a in anchors])
    table = vtkLookupTable()
    table.SetNumberOfTableValues(256)
    for k in range(256):
        at = k / 255 * (len(anchors) - 1)
        table.SetTableValue(k, *(float(np.interp(at, range(len(anchors)), rgb[:, c])) for c in range(3)), 1)
    table.SetRange(low, high if high > low else low + 1e-30 + abs(low) * 1e-6)
    table.Build()
    return table


def is_inside(file):
    """Files name others: of those only what lies in the folder of the results is read."""
    return ROOT is None or file.resolve().is_relative_to(ROOT)


def pieces_of(file):
    """Files that a .pvtu or .pvtp names."""
    return [file.parent / piece.get("Source", "") for piece in ElementTree.parse(file).iter("Piece")] if file.suffix.startswith(".pvt") else []


def read(file):
    """A data set from a VTK XML file, or None if it is not there or cannot be read."""
    readers = {".vtu": vtkXMLUnstructuredGridReader, ".pvtu": vtkXMLPUnstructuredGridReader, ".vtp": vtkXMLPolyDataReader,
               ".pvtp": vtkXMLPPolyDataReader}
    if not file.exists() or file.suffix not in readers or not all(is_inside(f) for f in (file, *pieces_of(file))):
        return None
    reader = readers[file.suffix]()
    reader.SetFileName(str(file))
    reader.Update()
    found = reader.GetOutput()
    return found if reader.GetErrorCode() == 0 and found.GetNumberOfPoints() > 0 else None


class Series:
    """Entries (time, file) of a collection; none if it is not there."""

    def __init__(self, index):
        found = ElementTree.parse(index).iter("DataSet") if index.exists() else []
        self.entries = sorted((float(e.get("timestep")), index.parent / e.get("file")) for e in found)

    @classmethod
    def of_one(cls, file):
        """A file that holds for all times."""
        series = cls(file.with_suffix(".none"))
        series.entries = [(0.0, file)]
        return series

    def nearest(self, time):
        return min(self.entries, key=lambda entry: abs(entry[0] - time)) if self.entries else None

    def spread(self, n):
        """At most n entries, evenly spread, first and last among them."""
        n = min(n, len(self.entries))
        return [self.entries[round(i * (len(self.entries) - 1) / max(1, n - 1))] for i in range(n)]

    def between(self, begin, end, n):
        """At most n entries nearest to times evenly spread from begin to end; all that lie between them where they are fewer."""
        inside = {entry for entry in self.entries if begin <= entry[0] <= end} | {self.nearest(begin), self.nearest(end)}
        spread = inside if len(inside) <= n else {self.nearest(time) for time in np.linspace(begin, end, n)}
        return sorted(spread - {None})


def array_named(attributes, name):
    """The array `name` or `name [unit]` of point or cell data, or None."""
    for i in range(attributes.GetNumberOfArrays()):
        label = attributes.GetArrayName(i)
        if label == name or label.startswith(name + " ["):
            return attributes.GetArray(i)
    return None


def bounds_of(box, other=None):
    """Box (xmin, xmax, ymin, ymax, zmin, zmax) around one or two boxes, as an array [3][2]."""
    box = np.array(box, float).reshape(3, 2)
    return box if other is None else np.stack([np.minimum(box[:, 0], other[:, 0]), np.maximum(box[:, 1], other[:, 1])], axis=1)


def slice_of(grid, origin, normal):
    """The water's speed on a plane: poly data with the point array `speed`, or None where the plane misses the water."""
    plane = vtkPlane()
    plane.SetOrigin(*origin)
    plane.SetNormal(*normal)
    cutter = vtkCutter()
    cutter.SetInputData(grid)
    cutter.SetCutFunction(plane)
    cutter.Update()
    velocity = array_named(cutter.GetOutput().GetCellData(), "velocity")
    last = cutter
    if velocity is not None:
        joined = vtkCleanPolyData()             # cells side by side share their corners, over the pieces of all ranks
        joined.SetInputConnection(cutter.GetOutputPort())
        last = vtkCellDataToPointData()
        last.SetInputConnection(joined.GetOutputPort())
    else:
        velocity = array_named(cutter.GetOutput().GetPointData(), "velocity")
    if velocity is None or cutter.GetOutput().GetNumberOfPoints() == 0:
        return None
    speed = vtkArrayCalculator()
    speed.SetInputConnection(last.GetOutputPort())
    speed.SetAttributeTypeToPointData()
    speed.AddVectorVariable("u", velocity.GetName())
    speed.SetFunction("mag(u)")
    speed.SetResultArrayName("speed")
    speed.Update()
    return speed.GetOutput()


class Stage:
    """One off-screen window; `show` draws actors and writes a picture. Rags are drawn over all else: no plane or wall hides them."""

    def __init__(self, out, index="pictures.json"):
        self.out, self.index, self.made = out, index, []
        self.window = vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(4)
        self.window.SetNumberOfLayers(2)

    def show(self, name, group, caption, scene, width=720):
        renderer = vtkRenderer()
        renderer.SetBackground(1, 1, 1)
        view = scene.get("view") or view_along(scene["box"], scene["towards"], scene.get("tilt", True))
        size = look(renderer.GetActiveCamera(), scene["box"], view, width, BARS if scene["bars"] else 0)
        self.window.SetSize(*size)
        front = vtkRenderer()
        front.SetLayer(1)
        front.SetActiveCamera(renderer.GetActiveCamera())
        for layer, actors in ((renderer, scene["surroundings"]), (front, scene["rags"])):
            self.window.AddRenderer(layer)
            for actor in actors:
                layer.AddActor(actor)
        self.add_bars(renderer, scene["bars"], size)
        large = scene.get("large", False)       # for pictures that are shown small
        renderer.AddActor2D(text_actor(scene["text"], 34 if large else 22, (14, size[1] - (46 if large else 36))))
        for k, event in enumerate(scene.get("events", [])):
            renderer.AddActor2D(text_actor(event, 26 if large else 20, (14, size[1] - (84 if large else 64) - (32 if large else 26) * k)))
        camera = renderer.GetActiveCamera()     # far enough for all actors of both layers
        camera.SetClippingRange(1e-3 * camera.GetDistance(), 100 * camera.GetDistance())
        self.write(name)
        self.window.RemoveRenderer(front)
        self.window.RemoveRenderer(renderer)
        self.list(name, group, caption)

    def scale(self, name, bars, width=760):
        """The colour bars alone, for pictures that share them."""
        renderer = vtkRenderer()
        renderer.SetBackground(1, 1, 1)
        size = (width, BARS)
        self.window.SetSize(*size)
        self.window.AddRenderer(renderer)
        self.add_bars(renderer, bars, size)
        self.write(name)
        self.window.RemoveRenderer(renderer)
        self.list(name, "scale", "Colours of the pictures: " + ", ".join(title for title, _ in bars))

    def add_bars(self, renderer, bars, size):
        for k, (title, table) in enumerate(bars):
            centre = (k + 0.5) / len(bars)
            renderer.AddActor2D(colour_bar(table, centre, size))
            renderer.AddActor2D(text_actor(title, 15, (centre * size[0], BARS - 18), centred=True))

    def write(self, name):
        self.window.Render()
        picture = vtkWindowToImageFilter()
        picture.SetInput(self.window)
        picture.ReadFrontBufferOff()
        writer = vtkPNGWriter()
        writer.SetFileName(str(self.out / name))
        writer.SetInputConnection(picture.GetOutputPort())
        writer.Write()

    def list(self, name, group, caption):
        self.made.append({"file": name, "group": group, "caption": caption})
        (self.out / self.index).write_text(json.dumps(self.made, indent=1))


def plain(font, size):
    if FONT.exists():
        font.SetFontFamily(VTK_FONT_FILE)
        font.SetFontFile(str(FONT))
    font.SetFontSize(size)
    font.SetColor(0.1, 0.1, 0.1)
    font.BoldOff(), font.ItalicOff(), font.ShadowOff()


def text_actor(words, size, place, centred=False):
    text = vtkTextActor()
    text.SetInput(words)
    plain(text.GetTextProperty(), size)
    if centred:
        text.GetTextProperty().SetJustificationToCentered()
    text.SetPosition(*place)
    return text


def colour_bar(table, centre, size):
    """Bar around `centre` (part of the width) at the lower edge of a picture of `size` pixels."""
    bar = vtkScalarBarActor()
    bar.SetLookupTable(table)
    bar.SetOrientationToHorizontal()
    bar.SetNumberOfLabels(4)
    bar.SetLabelFormat("%.3g")
    bar.SetUnconstrainedFontSize(True)
    bar.SetBarRatio(0.4)
    plain(bar.GetLabelTextProperty(), 14)
    bar.SetPosition(centre - 0.2, 6 / size[1])
    bar.SetPosition2(0.4, (BARS - 32) / size[1])
    return bar


def view_along(box, towards, tilt=True):
    """View along axis `towards`, perhaps tilted a little: directions to the eye and upward, and whether it is tilted."""
    extent = box[:, 1] - box[:, 0]
    up = 2 if towards != 2 else int(np.argmin(extent[:2]))                     # z is up where it can be
    side = 3 - towards - up
    sight = np.eye(3)[towards]
    if np.cross(np.eye(3)[up], sight)[side] < 0:                               # the axis across the picture grows to the right
        sight = -sight
    return sight, np.eye(3)[up], tilt


def look(camera, box, view, width, bars):
    """Parallel view that holds the box, with `bars` pixels left below it; returns the size of the picture in pixels."""
    sight, up, tilt = view
    centre, extent = box.mean(axis=1), box[:, 1] - box[:, 0]
    reach = float(np.linalg.norm(extent)) + 1e-12
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*centre)
    camera.SetPosition(*(centre + 3 * reach * sight))
    camera.SetViewUp(*up)
    if tilt:
        camera.Azimuth(-18)
        camera.Elevation(16)
    camera.OrthogonalizeViewUp()
    above = np.array(camera.GetViewUp())
    right = np.cross(camera.GetDirectionOfProjection(), above)
    corners = np.array([[box[0, i], box[1, j], box[2, k]] for i in (0, 1) for j in (0, 1) for k in (0, 1)]) - centre
    wide, tall = 1.05 * np.ptp(corners @ right), 1.05 * np.ptp(corners @ above)
    drawing = int(np.clip(width * tall / max(wide, 1e-30), 0.25 * width, (1.3 if not tilt else 0.8) * width))   # pixels between time and bars
    height = drawing + bars + TIME
    height += height % 2                                                       # videos want even numbers
    scale = max(tall / drawing, wide / width) * height                         # m over the height of the picture
    camera.SetParallelScale(0.5 * scale)
    shift = 0.5 * (bars - TIME) / height * scale * above
    camera.SetFocalPoint(*(centre - shift))
    camera.SetPosition(*(np.array(camera.GetPosition()) - shift))
    return width, height


def actor_of(poly, colour=(0.6, 0.6, 0.6), opacity=1.0):
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(poly)
    mapper.ScalarVisibilityOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    surface = actor.GetProperty()
    surface.SetColor(*colour)
    surface.SetOpacity(opacity)
    surface.SetPointSize(5)
    surface.SetLineWidth(2)
    return actor


def line_actor(edges, colour, width):
    edges.NonManifoldEdgesOff()
    edges.ColoringOff()
    edges.Update()
    actor = actor_of(edges.GetOutput(), colour)
    actor.GetProperty().SetLineWidth(width)
    return actor


def coloured(actor, array, attributes, table):
    """Colours an actor by an array of its points or cells."""
    mapper = actor.GetMapper()
    mapper.ScalarVisibilityOn()
    (mapper.SetScalarModeToUsePointFieldData if attributes == "points" else mapper.SetScalarModeToUseCellFieldData)()
    mapper.SelectColorArray(array)
    mapper.SetLookupTable(table)
    mapper.UseLookupTableScalarRangeOn()
    return actor


def wall_actors(walls):
    """Walls as a faint veil with their edges."""
    if walls is None:
        return []
    joined = vtkCleanPolyData()
    joined.SetInputData(walls)
    edges = vtkFeatureEdges()
    edges.SetInputConnection(joined.GetOutputPort())
    edges.SetFeatureAngle(35)
    lines = line_actor(edges, (0.25, 0.28, 0.32), 1.2)
    lines.GetProperty().SetOpacity(0.55)
    veil = actor_of(joined.GetOutput(), (0.55, 0.6, 0.66), 0.07)
    veil.GetProperty().LightingOff()
    return [veil, lines]


def cut_of(surface, shaft):
    """The lines in which the middle plane of the rotor cuts a surface."""
    level, cutter = vtkPlane(), vtkCutter()
    level.SetOrigin(*shaft.middle)
    level.SetNormal(*shaft.axis)
    joined = vtkCleanPolyData()
    joined.SetInputData(surface)
    cutter.SetInputConnection(joined.GetOutputPort())
    cutter.SetCutFunction(level)
    cutter.Update()
    return cutter.GetOutput()


def rotor_actors(rotor, shaft):
    """The vane, which stands out, the discs as a veil; and apart from them the edges of all."""
    normals = vtkPolyDataNormals()
    normals.SetInputData(rotor)
    normals.ComputePointNormalsOff()
    normals.ComputeCellNormalsOn()
    normals.ConsistencyOff()
    normals.Update()
    faces = normals.GetOutput()
    flat = numpy_to_vtk((np.abs(vtk_to_numpy(faces.GetCellData().GetNormals()) @ shaft.axis) > 0.9).astype(float), deep=1)
    flat.SetName("flat")
    faces.GetCellData().AddArray(flat)
    vane, discs = part_of(faces, "flat", 0), part_of(faces, "flat", 1)
    actors = []
    if discs is not None:
        actors.append(actor_of(discs, (0.45, 0.55, 0.68), 0.10))
        actors[-1].GetProperty().LightingOff()
    if vane is not None:
        body = vtkContourTriangulator()         # the mesh leaves it out: it is filled where the middle plane cuts it
        body.SetInputData(cut_of(vane, shaft))
        body.Update()
        actors += [actor_of(vane, (0.27, 0.37, 0.50), 0.3), actor_of(body.GetOutput(), (0.33, 0.42, 0.54))]
        actors[-1].GetProperty().LightingOff()
    joined = vtkCleanPolyData()
    joined.SetInputData(rotor)
    edges = vtkFeatureEdges()
    edges.SetInputConnection(joined.GetOutputPort())
    edges.SetFeatureAngle(35)
    return actors, [line_actor(edges, (0.10, 0.16, 0.26), 1.6)]


def rag_actors(rag, tables):
    """The sheets coloured by tension, with their rim; nothing if there is no rag."""
    if rag is None:
        return []
    normals = vtkPolyDataNormals()
    normals.SetInputData(rag)
    normals.SplittingOff()
    normals.Update()
    sheet = normals.GetOutput() if rag.GetNumberOfPolys() > 0 else rag
    actor = actor_of(sheet, (0.78, 0.42, 0.1))
    for attributes, arrays in (("points", sheet.GetPointData()), ("cells", sheet.GetCellData())):
        tension = array_named(arrays, "tension")
        if tension is not None and "tension" in tables:
            coloured(actor, tension.GetName(), attributes, tables["tension"])
            break
    actor.GetProperty().SetAmbient(0.65)
    actor.GetProperty().SetDiffuse(0.4)
    outline = vtkFeatureEdges()
    outline.SetInputData(sheet)
    outline.FeatureEdgesOff()
    return [actor, line_actor(outline, (0.2, 0.02, 0.05), 1.5)]


def part_of(data, name, value):
    """The cells of a grid or surface whose array `name` has this value, as a surface; None if there are none."""
    array = array_named(data.GetCellData(), name)
    if array is None:
        return None
    choice = vtkThreshold()
    choice.SetInputData(data)
    choice.SetInputArrayToProcess(0, 0, 0, 1, array.GetName())
    choice.SetLowerThreshold(value - 0.5)
    choice.SetUpperThreshold(value + 0.5)
    skin = vtkGeometryFilter()
    skin.SetInputConnection(choice.GetOutputPort())
    skin.Update()
    return skin.GetOutput() if skin.GetOutput().GetNumberOfCells() > 0 else None


def turned(surface, origin, axis, degrees):
    """The surface turned about a line."""
    transform = vtkTransform()
    transform.Translate(*origin)
    transform.RotateWXYZ(degrees, *axis)
    transform.Translate(*(-origin))
    turning = vtkTransformPolyDataFilter()
    turning.SetInputData(surface)
    turning.SetTransform(transform)
    turning.Update()
    return turning.GetOutput()


def column(table, name):
    """Numbers of the column `name [unit]` of a monitor read by `monitor`."""
    return next(values for header, values in table.items() if header.split(" [")[0] == name)


def monitor(file):
    """Columns of a CSV file by their headers; {} if it is not there or holds no record."""
    if not file.exists():
        return {}
    header, *rows = csv.reader(file.open())
    values = np.array([row for row in rows if len(row) == len(header)], float)
    return dict(zip(header, values.T)) if len(values) > 0 else {}


def events_of(file):
    """[(time, what, "0.31 s: what")] of all rags as summary.json tells them, with the rag where there are several."""
    try:
        rags = json.loads(file.read_text()).get("rags") or []
    except (OSError, ValueError):
        return []
    events = []
    for rag in rags:
        whose = f"{rag.get('name') or rag.get('id')}: " if len(rags) > 1 else ""
        for event in rag.get("events") or []:
            if isinstance(event.get("t_s"), (int, float)):
                events.append((event["t_s"], event.get("what", ""), f"{event['t_s']:.3f} s: {whose}{event.get('what', '')}"))
    return sorted(events)


class Rotor:
    """Axis, middle and angle of the zone that turns, from the case, the cells or walls, and the monitor of the shaft; `axis` is None where
    nothing turns."""

    def __init__(self, folder, case, surfaces):
        self.axis, table = None, case.get("rotating_zone")
        skin = next((found for found in (part_of(s, "turning", 1) for s in surfaces if s is not None) if found), None) if table else None
        if skin is None:
            return
        self.axis = np.array(table.get("axis", [0, 0, 1]), float)
        self.axis /= np.linalg.norm(self.axis)
        self.origin = np.array(table.get("origin_m", [0, 0, 0]), float)
        points = vtk_to_numpy(skin.GetPoints().GetData()) - self.origin
        along = points @ self.axis
        self.reach = float(np.linalg.norm(points - np.outer(along, self.axis), axis=1).max())
        self.middle = self.origin + 0.5 * (along.min() + along.max()) * self.axis
        self.box = bounds_of(skin.GetBounds())
        self.towards = int(np.argmax(np.abs(self.axis)))
        self.sense = float(np.sign(table.get("rotation_speed_rad_s", table.get("speed_rad_s", 1)))) if table.get("motion") != "frame" else 0.0
        shaft = monitor(folder / "monitors/pump.csv")
        self.times, self.revolutions = (column(shaft, "time"), column(shaft, "revolutions")) if shaft else (np.zeros(0), np.zeros(0))

    def has_angle(self):
        return self.axis is not None and (self.sense == 0 or len(self.times) > 1)

    def degrees_between(self, begin, end):
        """What the rotor turned from one time to another."""
        return self.sense * 360 * (self.turned_at(end) - self.turned_at(begin)) if self.sense != 0 else 0.0

    def turned_at(self, time):
        if time < self.times[0]:                # before the first step
            slope = (self.revolutions[1] - self.revolutions[0]) / (self.times[1] - self.times[0])
            return self.revolutions[0] + slope * (time - self.times[0])
        return float(np.interp(time, self.times, self.revolutions))


class PumpView:
    """The casing seen from the side of the inlet, the outlet pipe upward."""

    def __init__(self, rotor, passage, domain):
        inlet, outlet = np.array(passage.get("inlet_normal", -rotor.axis), float), np.array(passage.get("outlet_normal", [0, 0, 0]), float)
        sight = rotor.axis if inlet @ rotor.axis <= 0 else -rotor.axis
        across = outlet - (outlet @ rotor.axis) * rotor.axis
        if np.linalg.norm(across) < 1e-6:
            across = np.eye(3)[(rotor.towards + 1) % 3 if rotor.towards != 2 else 1]
        self.view = sight, across / np.linalg.norm(across), False
        reach = 1.75 * rotor.reach              # the casing around the rotor
        box = np.stack([rotor.middle - reach, rotor.middle + reach], axis=1)
        if "outlet_flange_m" in passage:
            flange, radius = np.array(passage["outlet_flange_m"], float), passage.get("outlet_radius_m", 0.0)
            box = bounds_of(np.stack([flange - radius, flange + radius], axis=1), box)
        self.box = np.stack([np.maximum(box[:, 0], domain[:, 0]), np.minimum(box[:, 1], domain[:, 1])], axis=1)


class Run:
    """What there is of a run, and the ranges and views that all its pictures share."""

    def __init__(self, folder):
        self.water, self.rags = Series(folder / "fields/water.pvd"), Series(folder / "rags/rags.pvd")
        moving = Series(folder / "walls/walls.pvd")
        self.walls = moving if moving.entries else Series.of_one(folder / "walls/walls.vtp")
        walls = read(self.walls.entries[-1][1])
        self.grids, self.surfaces = {}, {}
        self.domain = None if walls is None else bounds_of(walls.GetBounds())
        last = self.grid(self.water.entries[-1][1]) if self.water.entries else None
        if last is not None:
            self.domain = bounds_of(last.GetBounds(), self.domain)
        case = folder / "case.resolved.toml"
        case = tomllib.loads(case.read_text()) if case.exists() else {}
        self.rotor = Rotor(folder, case, [last, walls])
        self.rag_path = monitor(folder / "monitors/rags.csv")
        self.passage = case.get("rag_passage", case.get("passage", {}))  # the second: runs of version 0.1
        self.pump = PumpView(self.rotor, self.passage, self.domain) if self.rotor.axis is not None else None
        self.tables = {}
        self.events = events_of(folder / "summary.json")
        self.instants = self.rags.between(*self.passing(), N_INSTANTS)
        if moving.entries and not self.rotor.has_angle():   # walls are known at the times of the fields: rags are shown at these
            self.instants = sorted({self.rags.nearest(time) for time, _ in moving.spread(N_INSTANTS)} - {None})
        self.travel = self.look_at_rags()
        self.domain = self.travel if self.domain is None else self.domain
        if last is not None:
            velocity = array_named(last.GetCellData(), "velocity") or array_named(last.GetPointData(), "velocity")
            if velocity is not None:
                speeds = np.linalg.norm(vtk_to_numpy(velocity), axis=1)
                speeds = speeds[np.isfinite(speeds)]                           # a diverged run is drawn as far as it is a number
                self.tables["speed"] = colour_table(BLUES, 0, float(np.percentile(speeds, 99.5)) if speeds.size else 1)

    def passing(self):
        """When the first rag entered and the last one left; where that is not known, the times at which rags were written, from the first
        one's insertion on."""
        first, last = (self.rags.entries[0][0], self.rags.entries[-1][0]) if self.rags.entries else (0.0, 0.0)
        if self.pump is not None and self.rag_path:
            first = min((time for time, _ in self.rags.entries if time >= column(self.rag_path, "time")[0]), default=first)
        entered = [time for time, what, _ in self.events if what == "entered"]
        exited = [time for time, what, _ in self.events if what == "exited"]
        if not entered:
            return first, last
        return min(entered), max(exited) if len(exited) >= len(entered) else last

    def walls_at(self, time):
        """Actors of the walls: the casing behind the rags, the rotor at its angle; and its edges, which are seen through rags."""
        written, file = self.walls.nearest(time)
        walls = self.surface(file)
        rotor = part_of(walls, "turning", 1) if walls is not None and self.rotor.has_angle() else None
        if rotor is None:
            return wall_actors(walls), []
        behind, edges = rotor_actors(turned(rotor, self.rotor.origin, self.rotor.axis, self.rotor.degrees_between(written, time)), self.rotor)
        casing = part_of(walls, "turning", 0)
        outline = [actor_of(cut_of(casing, self.rotor), (0.25, 0.28, 0.32))] if casing is not None else []
        return wall_actors(casing) + outline + behind, edges

    def surface(self, file):
        if file not in self.surfaces:
            self.surfaces = {file: read(file)}
        return self.surfaces[file]

    def grid(self, file):
        if file not in self.grids:
            self.grids = {file: read(file)}     # one at a time: a field may be large
        return self.grids[file]

    def look_at_rags(self):
        """Box that the rags pass through at the instants shown; sets the range of their tension."""
        box, low, high = None, 0.0, 0.0
        for _, file in self.instants:
            rag = read(file)
            if rag is None or not np.all(np.isfinite(rag.GetBounds())):
                continue
            box = bounds_of(rag.GetBounds(), box)
            tension = array_named(rag.GetPointData(), "tension") or array_named(rag.GetCellData(), "tension")
            if tension is not None and tension.GetNumberOfTuples() > 0:
                low = min(low, float(np.nanpercentile(vtk_to_numpy(tension), 1)))
                high = max(high, float(np.nanpercentile(vtk_to_numpy(tension), 99)))
        if high > low:
            if abs(low) < 1e-3 * high:  # round-off around zero
                low = 0.0
            self.tables["tension"] = colour_table(FIRE, low, high)
        return box

    def view_of_rags(self):
        """The travelled box with room around it, inside the domain."""
        if self.travel is None:
            return self.domain
        room = 0.6 * max(float(np.max(self.travel[:, 1] - self.travel[:, 0])), 1e-9)
        box = self.travel + np.array([-room, room])
        inside = np.stack([np.maximum(box[:, 0], self.domain[:, 0]), np.minimum(box[:, 1], self.domain[:, 1])], axis=1)
        return np.where((inside[:, 1] > inside[:, 0])[:, None], inside, self.domain)

    def bars(self, with_rag):
        names = [("Speed of the water [m/s]", "speed")] + ([("Tension of the bonds [N]", "tension")] if with_rag else [])
        return [(title, self.tables[key]) for title, key in names if key in self.tables]

    def slice_actors(self, file, origin, axis):
        grid = self.grid(file) if "speed" in self.tables else None
        cut = slice_of(grid, origin, np.eye(3)[axis]) if grid is not None else None
        if cut is None:
            return []
        actor = coloured(actor_of(cut), "speed", "points", self.tables["speed"])
        actor.GetProperty().LightingOff()
        return [actor]


def in_kilopascal(surface):
    """Adds the cell array `kPa`; None if there is no pressure."""
    pressure = array_named(surface.GetCellData(), "pressure")
    if pressure is None:
        return None
    array = numpy_to_vtk(1e-3 * vtk_to_numpy(pressure), deep=1)
    array.SetName("kPa")
    surface.GetCellData().AddArray(array)
    return surface


def draw_rotor(run, stage):
    """The water in the middle plane of the rotor, and the pressure on all walls and on those of the rotor."""
    rotor, (time, file) = run.rotor, run.water.entries[-1]
    grid, walls = run.grid(file), read(run.walls.nearest(time)[1])
    cut = slice_of(grid, rotor.middle, rotor.axis) if "speed" in run.tables else None
    if cut is not None:
        plane = coloured(actor_of(cut), "speed", "points", run.tables["speed"])
        plane.GetProperty().LightingOff()
        reach = 1.75 * rotor.reach              # the casing around the rotor
        box = np.stack([rotor.middle - reach, rotor.middle + reach], axis=1)
        box = np.stack([np.maximum(box[:, 0], run.domain[:, 0]), np.minimum(box[:, 1], run.domain[:, 1])], axis=1)
        box[rotor.towards] = rotor.middle[rotor.towards]
        lines = [actor_of(cut_of(walls, rotor), (0.15, 0.17, 0.2))] if walls is not None else []
        scene = {"surroundings": [plane] + lines, "rags": [], "bars": run.bars(False), "text": f"t = {time:.4g} s", "box": box,
                 "view": run.pump.view}
        stage.show("rotor_speed.png", "speed", f"Speed of the water at t = {time:.4g} s in the middle plane of the rotor", scene, 1000)
    if walls is None or in_kilopascal(walls) is None:
        return
    for name, surface, box, towards, words in (
            ("walls", walls, run.domain, rotor.towards, "all walls; those in front are left out"),
            ("rotor_walls", part_of(walls, "turning", 1), rotor.box, rotor.towards, "the walls that turn; those in front are left out")):
        if surface is None:
            continue
        values = vtk_to_numpy(surface.GetCellData().GetArray("kPa"))
        values = values[np.isfinite(values)]
        if values.size == 0:
            continue
        table = colour_table(FIRE, float(np.percentile(values, 0.5)), float(np.percentile(values, 99.5)))
        actor = coloured(actor_of(surface), "kPa", "cells", table)
        actor.GetProperty().SetAmbient(0.8)         # little shade: colours are to be read off the bar
        actor.GetProperty().SetDiffuse(0.25)
        actor.GetProperty().FrontfaceCullingOn()    # walls are oriented out of the water: those between it and the eye are left out
        scene = {"surroundings": [actor], "rags": [], "bars": [("Pressure [kPa]", table)], "text": f"t = {time:.4g} s", "box": box,
                 "towards": towards}
        stage.show(f"pressure_{name}.png", "speed", f"Pressure at t = {time:.4g} s on {words}", scene, 1000)


def instant(run, time, file, middle, thin):
    """The scene of the rags at one time: of a pump from its inlet, elsewhere from the side with the water's speed in the middle."""
    rag = read(file)
    walls, edges = run.walls_at(time)
    note = "" if rag is not None else " (no rag in the domain)"
    scene = {"surroundings": walls, "rags": rag_actors(rag, run.tables) + edges, "bars": run.bars(True), "text": f"t = {time:.3f} s{note}"}
    if run.pump is not None:
        scene.update(bars=scene["bars"][-1:] if "tension" in run.tables else [], box=run.pump.box, view=run.pump.view)
        return scene
    water = run.water.nearest(time)
    if water is not None:
        scene["surroundings"] = run.slice_actors(water[1], middle, thin) + walls
    scene.update(box=run.view_of_rags(), towards=thin)
    return scene


def named(events):
    """The last ones, in words."""
    words = [text for _, _, text in events[-N_EVENTS:]]
    return words if len(events) <= N_EVENTS else words[:-1] + [f"{words[-1]} (and {len(events) - N_EVENTS} before)"]


def draw_instants(run, stage, middle, thin):
    before = -np.inf
    near = 0.01 * (run.instants[-1][0] - run.instants[0][0]) if run.instants else 0.0    # an event that follows at once belongs here
    for i, (time, file) in enumerate(run.instants):
        scene = instant(run, time, file, middle, thin)
        until = time + near if i + 1 < len(run.instants) else np.inf
        bars, scene["bars"], scene["large"] = scene["bars"], [], True
        scene["events"] = named([event for event in run.events if before < event[0] <= until])
        before = until
        stage.show(f"rag_{i + 1}.png", "rag" if run.pump is None else "pump", "; ".join([scene["text"]] + scene["events"]), scene)
    if run.instants and bars:
        stage.scale("rag_scale.png", bars)


def draw_film(run, stage, middle, thin):
    entries = list(run.rags.entries)
    while entries and read(entries[0][1]) is None:      # before the first rag was put in
        entries.pop(0)
    times = [time for time, _ in entries]
    for i, (time, file) in enumerate(entries):
        scene = instant(run, time, file, middle, thin)
        since = times[i - FILM_HOLD] if i >= FILM_HOLD else -np.inf
        scene["events"] = named([event for event in run.events if since < event[0] <= time])
        stage.show(f"film_{i + 1:04d}.png", "film", scene["text"], scene, 1080)


def draw_path(run, stage):
    """The rags' centroids seen from the inlet, over the casing where the middle plane of the rotor cuts it."""
    begin, end = run.passing()
    time, rag = (column(run.rag_path, name) for name in ("time", "rag"))
    place = np.stack([column(run.rag_path, name) for name in "xyz"], axis=1)
    table = colour_table(FIRE[1:], begin, end)
    paths = []
    for number in np.unique(rag):
        shown = (rag == number) & (time >= begin) & (time <= end)
        if np.count_nonzero(shown) < 2:
            continue
        line, points, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
        points.SetData(numpy_to_vtk(place[shown], deep=1))
        cells.InsertNextCell(np.count_nonzero(shown))
        for k in range(np.count_nonzero(shown)):
            cells.InsertCellPoint(k)
        line.SetPoints(points)
        line.SetLines(cells)
        when = numpy_to_vtk(time[shown], deep=1)
        when.SetName("time")
        line.GetPointData().AddArray(when)
        paths.append(coloured(actor_of(line), "time", "points", table))
        paths[-1].GetProperty().SetLineWidth(4)
        paths[-1].GetProperty().LightingOff()
    walls = run.surface(run.walls.nearest(end)[1])
    casing = part_of(walls, "turning", 0) if walls is not None else None
    if not paths or casing is None:
        return
    scene = {"surroundings": [actor_of(cut_of(casing, run.rotor), (0.15, 0.17, 0.2)), circle(run.rotor, run.passage.get("impeller_radius_m", run.rotor.reach))],
             "rags": paths, "bars": [("Time [s]", table)], "text": "", "box": run.pump.box, "view": run.pump.view}
    stage.show("path.png", "path", f"Path of the rag's centroid seen from the inlet, from {begin:.3f} to {end:.3f} s, over the casing in the middle "
               "plane of the impeller; the circle is the impeller's edge", scene, 760)


def circle(rotor, radius):
    """A grey circle about the axis in the middle plane of the rotor."""
    across = np.cross(rotor.axis, np.eye(3)[(rotor.towards + 1) % 3])
    across /= np.linalg.norm(across)
    angles = np.linspace(0, 2 * np.pi, 181)
    places = rotor.middle + radius * (np.outer(np.cos(angles), across) + np.outer(np.sin(angles), np.cross(rotor.axis, across)))
    ring, points, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    points.SetData(numpy_to_vtk(places, deep=1))
    cells.InsertNextCell(len(angles))
    for k in range(len(angles)):
        cells.InsertCellPoint(k)
    ring.SetPoints(points)
    ring.SetLines(cells)
    return actor_of(ring, (0.6, 0.64, 0.7))


def draw(run, stage):
    extent = run.domain[:, 1] - run.domain[:, 0]
    thin = int(np.argmin(extent))
    middle = run.domain.mean(axis=1)
    letter = "xyz"
    draw_instants(run, stage, middle, thin)
    if run.pump is not None and run.rag_path:
        draw_path(run, stage)
    if not run.water.entries:
        return
    time, file = run.water.entries[-1]
    if run.rotor.axis is not None:
        draw_rotor(run, stage)
    walls = wall_actors(run.surface(run.walls.nearest(time)[1]))
    near = run.rags.nearest(time)
    last_rag = read(near[1]) if near is not None else None
    centre = middle if last_rag is None else np.array(last_rag.GetBounds()).reshape(3, 2).mean(axis=1)
    views = [(thin, middle, "the middle of the domain")]
    if last_rag is not None:
        views.append((int(np.argmax(extent)), centre, "the rag's place"))
    for axis, origin, where in views:
        rag = rag_actors(last_rag, run.tables)
        box = run.domain.copy()
        reach = 0.5 * float(np.max(np.delete(extent, axis)))                   # of a long channel the part around the plane
        box[axis] = np.clip(origin[axis] + np.array([-reach, reach]), *run.domain[axis])
        scene = {"surroundings": run.slice_actors(file, origin, axis) + walls, "rags": rag, "bars": run.bars(bool(rag)),
                 "text": f"t = {time:.4g} s", "box": box, "towards": axis}
        caption = f"Speed of the water at t = {time:.4g} s on the plane {letter[axis]} = {origin[axis]:.4g} m, through {where}"
        stage.show(f"speed_{letter[axis]}.png", "speed", caption, scene, 1000)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, help="output folder of a run")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder of the pictures")
    parser.add_argument("--film", action="store_true", help="only the pictures of a film")
    options = parser.parse_args()
    global ROOT
    ROOT = options.folder.resolve()
    options.out.mkdir(parents=True, exist_ok=True)
    run = Run(options.folder)
    if run.domain is None:
        sys.exit("no fields, rags or walls to draw")
    if options.film:
        extent = run.domain[:, 1] - run.domain[:, 0]
        draw_film(run, Stage(options.out, "film.json"), run.domain.mean(axis=1), int(np.argmin(extent)))
    else:
        draw(run, Stage(options.out))


if __name__ == "__main__":
    main()
