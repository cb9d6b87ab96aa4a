#!/usr/bin/env python3
"""Pictures of a run, without a screen: the rag in its surroundings at several instants, the water's speed on slices; of a rotor the
speed in its middle plane and the pressure on the walls.

    xvfb-run -a /usr/bin/python3 render.py DIR --out DIR/pictures

Reads fields/water.pvd, rags/rags.pvd and walls/walls.vtp (or walls.pvd) of DIR as far as they exist; writes PNG files and pictures.json, a list of
{file, group, caption}, rewritten after each picture so that what was made before a failure is kept.
"""
import argparse
import json
import pathlib
import sys
import tomllib
import xml.etree.ElementTree as ElementTree

import numpy as np
import vtkmodules.vtkRenderingFreeType  # noqa: F401  (text)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  (the renderer registers itself)
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkCommonDataModel import vtkPlane
from vtkmodules.vtkFiltersCore import (vtkArrayCalculator, vtkCellDataToPointData, vtkCleanPolyData, vtkCutter, vtkFeatureEdges,
                                       vtkPolyDataNormals, vtkThreshold)
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPPolyDataReader, vtkXMLPUnstructuredGridReader, vtkXMLUnstructuredGridReader
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkTextActor, vtkWindowToImageFilter

N_INSTANTS = 9
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


def read(file):
    """A data set from a VTK XML file, or None if it is not there or cannot be read."""
    readers = {".vtu": vtkXMLUnstructuredGridReader, ".pvtu": vtkXMLPUnstructuredGridReader, ".vtp": vtkXMLPolyDataReader,
               ".pvtp": vtkXMLPPolyDataReader}
    if not file.exists() or file.suffix not in readers:
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

    def __init__(self, out):
        self.out, self.made = out, []
        self.window = vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(4)
        self.window.SetNumberOfLayers(2)

    def show(self, name, group, caption, scene, width=720):
        renderer = vtkRenderer()
        renderer.SetBackground(1, 1, 1)
        size = look(renderer.GetActiveCamera(), scene["box"], scene["towards"], width, scene.get("tilt", True))
        self.window.SetSize(*size)
        front = vtkRenderer()
        front.SetLayer(1)
        front.SetActiveCamera(renderer.GetActiveCamera())
        for layer, actors in ((renderer, scene["surroundings"]), (front, scene["rags"])):
            self.window.AddRenderer(layer)
            for actor in actors:
                layer.AddActor(actor)
        for k, (title, table) in enumerate(scene["bars"]):
            centre = (k + 0.5) / len(scene["bars"])
            renderer.AddActor2D(colour_bar(table, centre, size))
            renderer.AddActor2D(text_actor(title, 15, (centre * size[0], BARS - 18), centred=True))
        renderer.AddActor2D(text_actor(scene["text"], 22, (14, size[1] - 36)))
        camera = renderer.GetActiveCamera()     # far enough for all actors of both layers
        camera.SetClippingRange(1e-3 * camera.GetDistance(), 100 * camera.GetDistance())
        self.window.Render()
        picture = vtkWindowToImageFilter()
        picture.SetInput(self.window)
        picture.ReadFrontBufferOff()
        writer = vtkPNGWriter()
        writer.SetFileName(str(self.out / name))
        writer.SetInputConnection(picture.GetOutputPort())
        writer.Write()
        self.window.RemoveRenderer(front)
        self.window.RemoveRenderer(renderer)
        self.made.append({"file": name, "group": group, "caption": caption})
        (self.out / "pictures.json").write_text(json.dumps(self.made, indent=1))


def plain(font, size):
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


def look(camera, box, towards, width, tilt=True):
    """Parallel view along axis `towards`, perhaps tilted a little, that holds the box; returns the size of the picture in pixels."""
    centre, extent = box.mean(axis=1), box[:, 1] - box[:, 0]
    up = 2 if towards != 2 else int(np.argmin(extent[:2]))                     # z is up where it can be
    side = 3 - towards - up
    sight = np.eye(3)[towards]
    if np.cross(np.eye(3)[up], sight)[side] < 0:                               # the axis across the picture grows to the right
        sight = -sight
    reach = float(np.linalg.norm(extent)) + 1e-12
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*centre)
    camera.SetPosition(*(centre + 3 * reach * sight))
    camera.SetViewUp(*np.eye(3)[up])
    if tilt:
        camera.Azimuth(-18)
        camera.Elevation(16)
    camera.OrthogonalizeViewUp()
    above = np.array(camera.GetViewUp())
    right = np.cross(camera.GetDirectionOfProjection(), above)
    corners = np.array([[box[0, i], box[1, j], box[2, k]] for i in (0, 1) for j in (0, 1) for k in (0, 1)]) - centre
    wide, tall = 1.05 * np.ptp(corners @ right), 1.05 * np.ptp(corners @ above)
    drawing = int(np.clip(width * tall / max(wide, 1e-30), 0.25 * width, 0.8 * width))    # pixels between time and colour bars
    height = drawing + BARS + TIME
    scale = max(tall / drawing, wide / width) * height                         # m over the height of the picture
    camera.SetParallelScale(0.5 * scale)
    shift = 0.5 * (BARS - TIME) / height * scale * above
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


class Rotor:
    """Axis and middle of the zone that turns, from the case and the cells; `axis` is None where nothing turns."""

    def __init__(self, folder, grid):
        self.axis, case = None, folder / "case.resolved.toml"
        table = tomllib.loads(case.read_text()).get("rotating_zone") if case.exists() else None
        skin = part_of(grid, "turning", 1) if table and grid is not None else None
        if skin is None:
            return
        self.axis = np.array(table.get("axis", [0, 0, 1]), float)
        self.axis /= np.linalg.norm(self.axis)
        origin = np.array(table.get("origin_m", [0, 0, 0]), float)
        points = vtk_to_numpy(skin.GetPoints().GetData()) - origin
        along = points @ self.axis
        self.reach = float(np.linalg.norm(points - np.outer(along, self.axis), axis=1).max())
        self.middle = origin + 0.5 * (along.min() + along.max()) * self.axis
        self.box = bounds_of(skin.GetBounds())
        self.towards = int(np.argmax(np.abs(self.axis)))


class Run:
    """What there is of a run, and the ranges and views that all its pictures share."""

    def __init__(self, folder):
        self.water, self.rags = Series(folder / "fields/water.pvd"), Series(folder / "rags/rags.pvd")
        moving = Series(folder / "walls/walls.pvd")
        self.walls = moving if moving.entries else Series.of_one(folder / "walls/walls.vtp")
        walls = read(self.walls.entries[-1][1])
        self.grids = {}
        self.domain = None if walls is None else bounds_of(walls.GetBounds())
        last = self.grid(self.water.entries[-1][1]) if self.water.entries else None
        if last is not None:
            self.domain = bounds_of(last.GetBounds(), self.domain)
        self.rotor = Rotor(folder, last)
        self.tables = {}
        self.instants = self.rags.spread(N_INSTANTS)
        if moving.entries:                      # walls are known at the times of the fields: rags are shown at these
            self.instants = sorted({self.rags.nearest(time) for time, _ in moving.spread(N_INSTANTS)} - {None})
        self.travel = self.look_at_rags()
        self.domain = self.travel if self.domain is None else self.domain
        if last is not None:
            velocity = array_named(last.GetCellData(), "velocity") or array_named(last.GetPointData(), "velocity")
            if velocity is not None:
                speeds = np.linalg.norm(vtk_to_numpy(velocity), axis=1)
                speeds = speeds[np.isfinite(speeds)]                           # a diverged run is drawn as far as it is a number
                self.tables["speed"] = colour_table(BLUES, 0, float(np.percentile(speeds, 99.5)) if speeds.size else 1)

    def walls_at(self, time):
        return wall_actors(read(self.walls.nearest(time)[1]))

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
        outline = vtkCutter()                   # walls where the plane cuts them
        lines = []
        if walls is not None:
            level = vtkPlane()
            level.SetOrigin(*rotor.middle)
            level.SetNormal(*rotor.axis)
            outline.SetInputData(walls)
            outline.SetCutFunction(level)
            outline.Update()
            lines = [actor_of(outline.GetOutput(), (0.15, 0.17, 0.2))]
        scene = {"surroundings": [plane] + lines, "rags": [], "bars": run.bars(False), "text": f"t = {time:.4g} s", "box": box,
                 "towards": rotor.towards, "tilt": False}
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


def draw(run, stage):
    extent = run.domain[:, 1] - run.domain[:, 0]
    thin = int(np.argmin(extent))
    middle = run.domain.mean(axis=1)
    letter = "xyz"
    shown = run.instants
    for i, (time, file) in enumerate(shown):
        rag = read(file)
        water = run.water.nearest(time)
        note = "" if rag is not None else " (no rag in the domain)"
        surroundings = (run.slice_actors(water[1], middle, thin) if water is not None else []) + run.walls_at(time)
        scene = {"surroundings": surroundings, "rags": rag_actors(rag, run.tables), "bars": run.bars(True),
                 "text": f"t = {time:.4g} s{note}", "box": run.view_of_rags(), "towards": thin}
        stage.show(f"rag_{i + 1}.png", "rag", f"t = {time:.4g} s{note}", scene)
    if not run.water.entries:
        return
    time, file = run.water.entries[-1]
    if run.rotor.axis is not None:
        draw_rotor(run, stage)
    walls = run.walls_at(time)
    last_rag = read(shown[-1][1]) if shown else None
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
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    run = Run(options.folder)
    if run.domain is None:
        sys.exit("no fields, rags or walls to draw")
    draw(run, Stage(options.out))


if __name__ == "__main__":
    main()
