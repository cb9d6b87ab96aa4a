"""Outline of the plate at each output, as SVG: draw.py RUN_DIR OUT.svg. The stream comes from the left."""
import pathlib, sys
from vtk import vtkXMLPolyDataReader
from vtk.util.numpy_support import vtk_to_numpy

folder, out = map(pathlib.Path, sys.argv[1:3])
def outline(file):
    reader = vtkXMLPolyDataReader(); reader.SetFileName(str(file)); reader.Update()
    return vtk_to_numpy(reader.GetOutput().GetPoints().GetData())[81:162, :2]  # the middle row

scale, files = 4000, sorted((folder / "rags").glob("particles_*.vtp"))  # pixels per m
lines = []
for file, shade in zip(files, [160 - 160 * i // (len(files) - 1) for i in range(len(files))]):
    points = " ".join(f"{60 + scale * x:.1f},{215 - scale * y:.1f}" for x, y in outline(file))
    lines.append(f'<polyline points="{points}" fill="none" stroke="rgb({shade},{shade},{shade})" stroke-width="2"/>')
arrows = "".join(f'<path d="M5 {y} h35 m-7 -4 l7 4 l-7 4" fill="none" stroke="#2060b0" stroke-width="1.5"/>' for y in range(35, 400, 45))
bar = '<path d="M220 400 h80" stroke="black" stroke-width="2"/><text x="260" y="392" font-family="sans-serif" font-size="14" text-anchor="middle">20 mm</text>'
clamp = '<circle cx="60" cy="215" r="5" fill="#c03020"/>'
out.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" width="320" height="430" viewBox="0 0 320 430"><rect width="320" height="430" fill="white"/>'
               + arrows + "".join(lines) + clamp + bar + "</svg>\n")
