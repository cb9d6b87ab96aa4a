"""Shapes of the 13 fibres as in figures D.6 to D.9 of Jensen (2018): draw.py STUDY_DIR OUT.png; prints length of the chord over length and angle."""
import re, sys, glob, os, math
import numpy as np
from vtk import vtkXMLPolyDataReader
from vtk.util.numpy_support import vtk_to_numpy
from PIL import Image, ImageDraw

folder, out = sys.argv[1], sys.argv[2]
runs = sorted((d for d in glob.glob(os.path.join(folder, "*")) if os.path.isdir(os.path.join(d, "rags"))),
              key=lambda d: int(re.search(r"D(\d+)", os.path.basename(d)).group(1)))
def places(file):
    reader = vtkXMLPolyDataReader(); reader.SetFileName(file); reader.Update()
    return vtk_to_numpy(reader.GetOutput().GetPoints().GetData())[:, :2]
cell = 150
image = Image.new("RGB", (11 * cell + 60, len(runs) * cell), "white"); pen = ImageDraw.Draw(image)
print("case  chord/length (angle, degrees) after 0 ... 10 s")
for r, run in enumerate(runs):
    line = []
    for i, file in enumerate(sorted(glob.glob(os.path.join(run, "rags", "particles_*.vtp")))[:11]):
        x = places(file); length = 0.0025 * len(x); x = x - x.mean(0)
        chord = x[-1] - x[0]
        line.append(f"{np.hypot(*chord) / (length - 0.0025):.2f} ({math.degrees(math.atan2(chord[1], chord[0])):.0f})")
        scale = 0.42 * cell / 0.0625
        points = [(60 + (i + 0.5) * cell + scale * p[0], (r + 0.5) * cell - scale * p[1]) for p in x]
        pen.line(points, fill="black", width=2)
    pen.text((5, (r + 0.45) * cell), "case " + str(r + 1), fill="black")
    print(r + 1, "  ", "  ".join(line))
image.save(out)
