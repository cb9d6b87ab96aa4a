// What Snag writes for ParaView is read back by VTK itself (python3-vtk9), value by value.
#include "base/vtk_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <sstream>

#include "base/error.hpp"

namespace snag {
namespace {

const char* const reader = R"(
import sys, vtkmodules.vtkIOXML as io
from vtkmodules.util.numpy_support import vtk_to_numpy as numbers
def read(name):
    kind = {'vtu': io.vtkXMLUnstructuredGridReader, 'vtp': io.vtkXMLPolyDataReader,
            'pvtu': io.vtkXMLPUnstructuredGridReader, 'pvtp': io.vtkXMLPPolyDataReader}[name.rsplit('.', 1)[1]]()
    kind.SetFileName(name); kind.Update()
    assert kind.GetErrorCode() == 0, kind.GetErrorCode()
    return kind.GetOutput()
def show(title, array):
    print(title, array.GetDataTypeAsString(), array.GetNumberOfComponents(), *('%.17g' % v for v in numbers(array).ravel()))
)";

class VtkFile : public testing::Test {
 protected:
  std::filesystem::path folder;

  void SetUp() override {
    if (std::system("/usr/bin/python3 -c 'import vtkmodules.vtkIOXML' 2> /dev/null") != 0) GTEST_SKIP() << "python3-vtk9 is not installed";
    folder = std::filesystem::temp_directory_path() / ("snag_vtk_file_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
  }
  void TearDown() override {
    if (!folder.empty()) std::filesystem::remove_all(folder);
  }
  /// What the Python lines print, run in the folder of the files.
  std::string printed(const std::string& lines) {
    std::ofstream(folder / "check.py") << reader << lines;
    const std::string command = "cd " + folder.string() + " && /usr/bin/python3 check.py > printed.txt 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0);
    std::stringstream text;
    text << std::ifstream(folder / "printed.txt").rdbuf();
    return text.str();
  }
};

/// A hexahedron with a pyramid on top, a prism at its side and a tetrahedron on the prism's end.
VtkPiece four_shapes() {
  VtkPiece piece;
  piece.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0},     {0, 1, 0}, {0, 0, 1}, {1, 0, 1},
                  {1, 1, 1}, {0, 1, 1}, {0.5, 0.5, 2}, {2, 0, 0}, {2, 0, 1}, {3, 1, 0}};
  piece.connectivity = {0, 1, 2, 3, 4, 5, 6, 7, 4, 5, 6, 7, 8, 1, 9, 2, 5, 10, 6, 9, 11, 2, 10};
  piece.offsets = {8, 13, 19, 23};
  piece.types = {12, 14, 13, 10};
  piece.point_arrays = {{"height <\"z\"> [m]", 1, {0, 0, 0, 0, 1, 1, 1, 1, 2, 0, 1, 0}}};
  piece.cell_arrays = {{"velocity [m/s]", 3, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 0.5}},
                       {"pressure [Pa]", 1, {0.1, -0.0, 1e300, 5e-324}, false}};
  piece.field_arrays = {{"TimeValue", 1, {0.1}, false}};
  return piece;
}

// A grid of all four cell shapes keeps shapes, points, arrays with their units and precision, and the time.
TEST_F(VtkFile, KeepsAGridOfAllShapes) {
  write_vtk(folder / "grid.vtu", VtkKind::unstructured_grid, four_shapes());
  EXPECT_EQ(printed(R"(
grid = read('grid.vtu')
print(grid.GetNumberOfPoints(), *(grid.GetCellType(c) for c in range(4)), *grid.GetPoint(11))
print(*(grid.GetCell(3).GetPointId(i) for i in range(4)))
for data in grid.GetPointData(), grid.GetCellData(), grid.GetFieldData():
    for i in range(data.GetNumberOfArrays()): show(data.GetArrayName(i), data.GetArray(i))
)"),
            "12 12 14 13 10 3.0 1.0 0.0\n9 11 2 10\n"
            "height <\"z\"> [m] float 1 0 0 0 0 1 1 1 1 2 0 1 0\n"
            "velocity [m/s] float 3 1 2 3 4 5 6 7 8 9 10 11 0.5\n"
            "pressure [Pa] double 1 0.10000000000000001 -0 1.0000000000000001e+300 4.9406564584124654e-324\n"
            "TimeValue double 1 0.10000000000000001\n");
}

// Arrays longer than one compressed block, and exactly one block long, come back whole.
TEST_F(VtkFile, KeepsArraysOfManyBlocks) {
  for (const int n : {32768, 100001}) {  // 8 bytes each: 1 block of 2^18 bytes, and 3.05 blocks
    VtkPiece piece;
    std::vector<double> values(n);
    for (int i = 0; i < n; ++i) values[i] = std::sin(0.37 * i);
    piece.points.resize(n);
    piece.point_arrays = {{"wave", 1, values, false}};
    write_vtk(folder / "cloud.vtp", VtkKind::vertices, piece);
    EXPECT_EQ(printed(R"(
import numpy
cloud = read('cloud.vtp'); wave = numbers(cloud.GetPointData().GetArray('wave')); n = len(wave)
print(n, cloud.GetNumberOfVerts(), abs(wave - numpy.sin(0.37 * numpy.arange(n))).max() < 1e-9)
)"),
              std::to_string(n) + " " + std::to_string(n) + " True\n");
  }
}

// Polygons and lines keep their corners and the values of points and cells.
TEST_F(VtkFile, KeepsPolygonsAndLines) {
  VtkPiece piece;
  piece.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.1, 0.2, 0.3}};
  piece.connectivity = {0, 1, 2, 3, 2, 3, 4};
  piece.offsets = {4, 7};
  piece.point_arrays = {{"tension [N]", 1, {1, 2, 3, 4, 5}}};
  piece.cell_arrays = {{"part", 1, {7, 8}}};
  write_vtk(folder / "polygons.vtp", VtkKind::polygons, piece);
  write_vtk(folder / "lines.vtp", VtkKind::lines, piece);
  EXPECT_EQ(printed(R"(
for name, n in ('polygons.vtp', lambda p: p.GetNumberOfPolys()), ('lines.vtp', lambda p: p.GetNumberOfLines()):
    p = read(name); print(n(p), p.GetNumberOfCells(), *(p.GetCell(1).GetPointId(i) for i in range(3)), *p.GetPoint(4))
    show('tension', p.GetPointData().GetArray('tension [N]')); show('part', p.GetCellData().GetArray('part'))
)"),
            "2 2 2 3 4 0.1 0.2 0.3\ntension float 1 1 2 3 4 5\npart float 1 7 8\n"
            "2 2 2 3 4 0.1 0.2 0.3\ntension float 1 1 2 3 4 5\npart float 1 7 8\n");
}

// The index over the pieces of several ranks, one of them empty, reads as one data set.
TEST_F(VtkFile, JoinsThePiecesOfRanks) {
  auto piece = four_shapes(), empty = VtkPiece{};
  empty.point_arrays = {{piece.point_arrays[0].name, 1, {}}};
  empty.cell_arrays = {{"velocity [m/s]", 3, {}}, {"pressure [Pa]", 1, {}, false}};
  write_vtk(folder / "p0.vtu", VtkKind::unstructured_grid, piece);
  write_vtk(folder / "p1.vtu", VtkKind::unstructured_grid, empty);
  write_parallel_vtk(folder / "all.pvtu", VtkKind::unstructured_grid, empty, {"p0.vtu", "p1.vtu", "p0.vtu"});
  VtkPiece points;
  points.points = {{1, 2, 3}, {4, 5, 6}};
  points.point_arrays = {{"id", 1, {3, 4}, false}};
  write_vtk(folder / "q0.vtp", VtkKind::vertices, points);
  write_parallel_vtk(folder / "all.pvtp", VtkKind::vertices, points, {"q0.vtp", "q0.vtp"});
  EXPECT_EQ(printed(R"(
grid, points = read('all.pvtu'), read('all.pvtp')
print(grid.GetNumberOfCells(), points.GetNumberOfVerts()); show('p', grid.GetCellData().GetArray('pressure [Pa]')); show('id', points.GetPointData().GetArray('id'))
)"),
            "8 4\np double 1 0.10000000000000001 -0 1.0000000000000001e+300 4.9406564584124654e-324 0.10000000000000001 -0 "
            "1.0000000000000001e+300 4.9406564584124654e-324\nid double 1 3 4 3 4\n");
}

// A piece whose sizes contradict each other is refused with the name of the array, and leaves no file.
TEST_F(VtkFile, RefusesWrongSizes) {
  auto piece = four_shapes();
  piece.cell_arrays[0].values.pop_back();
  try {
    write_vtk(folder / "bad.vtu", VtkKind::unstructured_grid, piece);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::io);
    EXPECT_NE(std::string(error.what()).find("velocity [m/s]"), std::string::npos) << error.what();
  }
  piece = four_shapes();
  piece.connectivity[0] = 12;
  EXPECT_THROW(write_vtk(folder / "bad.vtu", VtkKind::unstructured_grid, piece), Error);
  piece = four_shapes();
  piece.types.pop_back();
  EXPECT_THROW(write_vtk(folder / "bad.vtu", VtkKind::unstructured_grid, piece), Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "bad.vtu"));
}

// A file that cannot be written is an input/output error and the old one stays.
TEST_F(VtkFile, ReportsAMissingFolder) {
  try {
    write_vtk(folder / "absent" / "grid.vtu", VtkKind::unstructured_grid, four_shapes());
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::io);
    EXPECT_NE(std::string(error.what()).find("grid.vtu"), std::string::npos);
  }
}

// A collection keeps times to the last bit; on a resume it keeps what was written up to then, and what is written again is there once.
TEST_F(VtkFile, CollectionDropsWhatIsWrittenAgain) {
  const auto file = folder / "water.pvd";
  const double third = 1.0 / 3;
  {
    VtkCollection series(file, false);
    series.add(0, "a & b.vtu");
    series.add(0.1, "b.vtu");
    series.add(third, "c.vtu");
    series.add(0.5, "d.vtu");
  }
  { VtkCollection(file, true, third * (1 - 1e-14)).add(0.4, "e.vtu"); }  // two clocks may differ by round-off
  const std::string entries = R"(
import xml.etree.ElementTree as tree
for entry in tree.parse('water.pvd').iter('DataSet'): print(entry.get('file'), entry.get('timestep'))
)";
  EXPECT_EQ(printed(entries), "a & b.vtu 0\nb.vtu 0.10000000000000001\nc.vtu 0.33333333333333331\ne.vtu 0.40000000000000002\n");
  VtkCollection(file, true, third).add(third * (1 - 1e-14), "c2.vtu");
  EXPECT_EQ(printed(entries), "a & b.vtu 0\nb.vtu 0.10000000000000001\nc2.vtu 0.33333333333332998\n");
}

}  // namespace
}  // namespace snag
