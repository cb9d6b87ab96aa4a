// ranks: 1 3
// long ranks: 2 5
#include <cstdio>
#include <cstdlib>

#include "base/error.hpp"
#include "check.hpp"
#include "mesh/import/import.hpp"
#include "sliding_check.hpp"
#include "sliding_shells.hpp"

namespace {

using namespace snag;
using test::Shells;

constexpr double pi = std::numbers::pi;

Mesh imported(const Shells& shells) {
  const test::TemporaryFile file(test::sample_of(shells), test::Format::ascii22);
  ImportOptions options;
  if (shells.is_periodic) options.periodic = {{"bottom", "top", {0, 0, shells.height}}};
  return import_mesh(file.path(), MPI_COMM_WORLD, options);
}

double exact_area(const Shells& s) {
  return 2 * pi * s.radius * s.height + (s.has_lid ? pi * (s.radius * s.radius - s.inner * s.inner) : 0);
}

void expect_exact(const Shells& shells, std::initializer_list<double> angles) {
  Mesh mesh = imported(shells);
  const SlidingInterface interface(mesh, shells.description());
  interface.curve(mesh);
  for (const double angle : angles) {
    SCOPED_TRACE(angle);
    const auto errors = test::interface_errors(mesh, interface, angle);
    EXPECT_LT(errors.tiling, 1e-12);
    EXPECT_LT(errors.coverage, 1e-12);
    EXPECT_LT(errors.closure, 1e-12);
    EXPECT_NEAR(errors.area, exact_area(shells), 1e-12 * exact_area(shells));
  }
  EXPECT_LT(test::swept_by_cells(mesh, interface), 1e-12);
}

// Facets tile every face of both sides and cells close at any angle, cylinder and disc with both rims in one interface, for both shapes.
TEST(Sliding, FacetsTileBothSidesAndCellsClose) {
  for (const bool tetrahedra : {true, false}) {
    SCOPED_TRACE(tetrahedra);
    expect_exact({.tetrahedra = tetrahedra}, {0, 0.05, 0.7, -2.9, pi, 1e4});
  }
}

// It does not matter where the axis points nor where it lies.
TEST(Sliding, WorksAboutAnyAxis) { expect_exact({.origin = {0.3, -0.2, 0.1}, .axis = {1, -2, 0.5}}, {0.3, 4}); }

// The turning zone may as well lie outside the standing one.
TEST(Sliding, TurnsEitherSide) {
  const Shells shells;
  Mesh mesh = imported(shells);
  SlidingDescription outside = shells.description();
  outside.rotor_zone = "stator";
  std::swap(outside.rotor_patch, outside.stator_patch);
  const SlidingInterface interface(mesh, outside);
  interface.curve(mesh);
  const auto errors = test::interface_errors(mesh, interface, 0.4);
  EXPECT_LT(errors.tiling, 1e-12);
  EXPECT_LT(errors.closure, 1e-12);
  EXPECT_LT(test::swept_by_cells(mesh, interface), 1e-12);
}

// A cylinder may be periodic along its axis, one cell long too: cells close and have the volume of the ring.
TEST(Sliding, MayBePeriodicAlongTheAxis) {
  for (const int n_z : {1, 2, 4})
    for (const bool tetrahedra : {true, false}) {
      if (tetrahedra && n_z == 1) continue;  // two tetrahedra would share two faces
      SCOPED_TRACE(n_z);
      const Shells s{.rotor = {14, 3, n_z}, .stator = {17, 4, n_z}, .tetrahedra = tetrahedra, .has_lid = false, .is_periodic = true};
      expect_exact(s, {0, 0.9});
      Mesh mesh = imported(s);
      SlidingInterface(mesh, s.description()).curve(mesh);
      double volume = 0;
      for (int c = 0; c < mesh.n_cells; ++c) volume += mesh.cell_zone[c] == 0 ? mesh.cell_volume[c] : 0;
      const double inner = 0.5 * 14 * s.inner * s.inner * std::sin(2 * pi / 14);
      EXPECT_NEAR(sum(mesh.comm, volume), s.height * (pi * s.radius * s.radius - inner), 1e-12 * s.height * pi * s.radius * s.radius);
    }
}

// Three faces around are the coarsest circle.
TEST(Sliding, WorksOnVeryCoarseAndVeryDifferentMeshes) {
  expect_exact({.rotor = {3, 1, 1}, .stator = {40, 6, 9}, .tetrahedra = false}, {0, 0.4, 2});
  expect_exact({.rotor = {64, 5, 20}, .stator = {5, 1, 1}, .tetrahedra = false}, {0, 0.4, 2});
  expect_exact({.rotor = {64, 5, 20}, .stator = {11, 1, 1}}, {0, 0.4, 2});
}

// Where the meshes coincide, each face is one facet with the face opposite, and no sliver comes of round-off; one face further the same.
TEST(Sliding, CoincidingFacesAreSingleFacets) {
  for (const bool tetrahedra : {true, false}) {
    Shells shells{.rotor = {24, 3, 4}, .stator = {24, 3, 4}, .stator_start = 0, .tetrahedra = tetrahedra};
    Mesh mesh = imported(shells);
    const SlidingInterface interface(mesh, shells.description());
    interface.curve(mesh);
    for (const int steps : {0, 1, -5, 24}) {
      const auto errors = test::interface_errors(mesh, interface, steps * 2 * pi / 24);
      EXPECT_EQ(errors.facets, mesh.patches[mesh.patch_index("interface_rotor")].count_global) << steps;
      EXPECT_LT(errors.tiling, 1e-12);
    }
  }
}

// A sliver between nearly coinciding edges is kept: its area is that of the shift.
TEST(Sliding, KeepsSlivers) {
  Shells shells{.rotor = {24, 3, 4}, .stator = {24, 3, 4}, .stator_start = 0, .tetrahedra = false, .has_lid = false};
  Mesh mesh = imported(shells);
  const SlidingInterface interface(mesh, shells.description());
  interface.curve(mesh);
  for (const double shift : {1e-3, 1e-6, 1e-9, 1e-12}) {
    double slivers = 0;
    std::int64_t n_slivers = 0;
    for (const Facet& facet : interface.facets(shift)) {
      if (facet.rotor.rank != rank_of(mesh.comm)) continue;
      const double r = std::hypot(facet.centre.x, facet.centre.y);
      EXPECT_NEAR(r, shells.radius, 0.01 * shells.radius);
      if (facet.area < 0.2 * exact_area(shells) / 96) slivers += facet.area, ++n_slivers;
    }
    EXPECT_EQ(sum(mesh.comm, n_slivers), 96) << shift;
    EXPECT_NEAR(sum(mesh.comm, slivers), 24 * shift * shells.radius * shells.height, 1e-3 * 24 * shift * shells.radius * shells.height);
  }
}

// Volumes with curved edges fill the zones exactly: up to the interface the rings are round, at the inner and outer walls polygons.
TEST(Sliding, VolumesFillTheZones) {
  const auto polygon = [](double r, int n) { return 0.5 * n * r * r * std::sin(2 * pi / n); };
  for (const bool tetrahedra : {true, false}) {
    SCOPED_TRACE(tetrahedra);
    const Shells s{.tetrahedra = tetrahedra};
    Mesh mesh = imported(s);
    const SlidingInterface interface(mesh, s.description());
    interface.curve(mesh);
    std::array<double, 2> volume{};
    Vec3 moment;
    for (int c = 0; c < mesh.n_cells; ++c) {
      volume[static_cast<std::size_t>(mesh.cell_zone[c])] += mesh.cell_volume[c];
      if (mesh.cell_zone[c] == 0) moment += mesh.cell_volume[c] * mesh.cell_centre[c];
    }
    for (double& V : volume) V = sum(mesh.comm, V);
    const double circle = pi * s.radius * s.radius, lid = polygon(s.radius, s.stator[0]) - polygon(s.inner, s.stator[0]);
    EXPECT_NEAR(volume[0], s.height * (circle - polygon(s.inner, s.rotor[0])), 1e-12 * volume[0]);
    EXPECT_NEAR(volume[1], s.height * (polygon(s.outer, s.stator[0]) - circle) + (s.top - s.height) * lid, 1e-12 * volume[1]);
    const Vec3 centre = sum(mesh.comm, std::span(&moment, 1)) / volume[0];
    EXPECT_LT(norm(centre - Vec3{0, 0, s.height / 2}), 1e-5);
  }
}

// Facets do not depend on the number of ranks, to the bit, and come in the same order on both ranks of a facet.
TEST(Sliding, FacetsAreTheSameOnAnyNumberOfRanks) {
  const Shells shells;
  const test::TemporaryFile file(test::sample_of(shells), test::Format::ascii22);
  const Mesh mesh = import_mesh(file.path(), MPI_COMM_WORLD), whole = import_mesh(file.path(), MPI_COMM_SELF);
  const SlidingInterface interface(mesh, shells.description()), reference(whole, shells.description());
  const int rank = rank_of(MPI_COMM_WORLD);
  std::map<std::int64_t, int> mine;
  for (int c = 0; c < mesh.n_cells; ++c) mine[mesh.cell_id[c]] = c;
  for (const double angle : {0.0, 0.37}) {
    const std::vector<Facet> facets = interface.facets(angle);
    std::size_t next = 0;
    for (const Facet& expected : reference.facets(angle)) {
      const auto rotor = mine.find(expected.rotor.cell_id), stator = mine.find(expected.stator.cell_id);
      if (rotor == mine.end() && stator == mine.end()) continue;
      ASSERT_LT(next, facets.size());
      const Facet& facet = facets[next++];
      EXPECT_EQ(facet.rotor.cell_id, expected.rotor.cell_id);
      EXPECT_EQ(facet.stator.cell_id, expected.stator.cell_id);
      EXPECT_EQ(facet.rotor.rank == rank, rotor != mine.end());
      EXPECT_EQ(facet.stator.rank == rank, stator != mine.end());
      EXPECT_EQ(facet.vector, expected.vector);
      EXPECT_EQ(facet.centre, expected.centre);
      EXPECT_EQ(facet.area, expected.area);
    }
    EXPECT_EQ(next, facets.size());
  }
}

/// The message of the error that work ends with, the same code on every rank.
template <class Work>
std::string failure(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::mesh);
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

// Zones that do not touch are an error that names the place.
TEST(Sliding, NamesThePlaceWhereZonesDoNotTouch) {
  const Shells apart{.stator_radius = 0.051};
  const Mesh mesh = imported(apart);
  const SlidingInterface interface(mesh, apart.description());
  const std::string message = failure([&] { interface.facets(0); });
  EXPECT_NE(message.find("covered by the other side to 0 %"), std::string::npos) << message;
  EXPECT_NE(message.find("side at ("), std::string::npos) << message;
  EXPECT_EQ(message.find("drawn"), std::string::npos) << message;
}

// Zones that are shifted against each other along the axis are told and drawn where they do not meet: the faces of all ranks, no other.
TEST(Sliding, DrawsWhereZonesDoNotMeet) {
  const Shells shells{.tetrahedra = false, .has_lid = false};  // rows of 10 mm on 14 faces, of 8 mm on 17 faces
  test::Sample sample = test::sample_of(shells);
  for (int n = shells.rotor[0] * (shells.rotor[1] + 1) * (shells.rotor[2] + 1); n < static_cast<int>(sample.node.size()); ++n)
    sample.node[static_cast<std::size_t>(n)].z += 0.004;
  const test::TemporaryFile file(sample, test::Format::ascii22);
  const Mesh mesh = import_mesh(file.path(), MPI_COMM_WORLD);
  SlidingDescription description = shells.description();
  description.gap_picture = file.path().string() + ".gap.vtp";
  const SlidingInterface interface(mesh, description);
  const std::string message = failure([&] { interface.facets(0.3); });
  for (const char* expected : {"14 faces of the turning side (all round the axis, radius 0.05 m, 0 m to 0.01 m along the axis)",
                               "17 faces of the stationary side (all round the axis, radius 0.05 m, 0.036 m to 0.044 m",
                               "is covered by the other side to 50 %", description.gap_picture.c_str()})
    EXPECT_NE(message.find(expected), std::string::npos) << expected << "\n" << message;
  if (rank_of(mesh.comm) == 0) {
    const std::string read_back = R"(/usr/bin/python3 - << END
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
reader = vtkXMLPolyDataReader()
reader.SetFileName(')" + description.gap_picture.string() +
                                  R"(')
reader.Update()
picture = reader.GetOutput()
covered, turning = (vtk_to_numpy(picture.GetCellData().GetArray(name)) for name in ("covered [1]", "turning [1]"))
assert picture.GetNumberOfPolys() == 31 and sum(turning == 1) == 14 and sum(turning == 0) == 17
assert abs(covered[turning == 1] - 0.6).max() < 1e-6 and abs(covered[turning == 0] - 0.5).max() < 1e-6
for i in range(31):
    box = picture.GetCell(i).GetBounds()
    assert abs(box[4] - (0 if turning[i] else 0.036)) < 1e-7 and abs(box[5] - (0.01 if turning[i] else 0.044)) < 1e-7
END
)";
    EXPECT_EQ(std::system(read_back.c_str()), 0);
    std::filesystem::remove(description.gap_picture);
  }
}

// Where one side is folded the place is told by its angle too: where it is, not where the mesh file has it.
TEST(Sliding, TellsTheAnglesOfAFold) {
  const Shells shells{.has_lid = false};
  test::Sample sample = test::sample_of(shells);
  const auto node = [&](int around, int along) {
    const int first = shells.rotor[0] * (shells.rotor[1] + 1) * (shells.rotor[2] + 1);
    return static_cast<std::size_t>(first + around + shells.stator[0] * (shells.stator[1] + 1) * along);
  };
  const Vec3 a = sample.node[node(4, 2)], b = sample.node[node(5, 2)];
  sample.node[node(3, 2)] = shells.radius / norm(Vec3{a.x + b.x, a.y + b.y, 0}) * Vec3{a.x + b.x, a.y + b.y, 0} + Vec3{0, 0, a.z};
  const test::TemporaryFile file(sample, test::Format::ascii22);
  const Mesh mesh = import_mesh(file.path(), MPI_COMM_WORLD);
  const SlidingInterface interface(mesh, shells.description());
  for (const double angle : {0.0, 0.3}) {
    const std::string message = failure([&] { interface.facets(angle); });
    const auto at = message.find(" of the stationary side (");
    ASSERT_NE(at, std::string::npos) << message;
    int lowest = 0, highest = 0;
    ASSERT_EQ(std::sscanf(message.c_str() + at, " of the stationary side (%d deg to %d deg about the axis", &lowest, &highest), 2)
        << message;
    // The faces about the node were between nodes 2 and 4, and reach to 4.5; angle 0 of the shells is at -y.
    EXPECT_GE(lowest, std::floor((shells.stator_start + 2 * 2 * pi / 17) * 180 / pi - 90)) << message;
    EXPECT_LE(highest, std::ceil((shells.stator_start + 4.5 * 2 * pi / 17) * 180 / pi - 90)) << message;
    EXPECT_GT(highest - lowest, 20) << message;
  }
}

// A wrong axis, and patches exchanged, are errors.
TEST(Sliding, RejectsSurfacesThatDoNotRevolve) {
  const Shells shells;
  const Mesh mesh = imported(shells);
  SlidingDescription shifted = shells.description(), exchanged = shifted, unknown = shifted;
  shifted.origin = {0.01, 0, 0};
  std::swap(exchanged.rotor_patch, exchanged.stator_patch);
  unknown.rotor_zone = "impeller";
  const Shells coarse{.rotor = {5, 1, 1}};
  const Mesh crossing = imported(coarse);
  EXPECT_NE(failure([&] { SlidingInterface(crossing, coarse.description()); }).find("cuts the circle of the inner rim"), std::string::npos);
  EXPECT_NE(failure([&] { SlidingInterface(mesh, shifted); }).find("neither a cylinder nor a disc"), std::string::npos);
  EXPECT_NE(failure([&] { SlidingInterface(mesh, exchanged); }).find("belongs to zone"), std::string::npos);
  EXPECT_NE(failure([&] { SlidingInterface(mesh, unknown); }).find("\"impeller\" is not in the mesh"), std::string::npos);
}

// The area of a polygon inside a circle is exact, whichever vertices lie inside.
TEST(SlidingClip, CutsPolygonsAtCircles) {
  Polygon square;
  for (const Point2 x : {Point2{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) square.add(x);
  EXPECT_NEAR(moments_inside(square, {}, 1.5).area, 4, 1e-15);
  const double R = 1.2, half = std::acos(1 / R);
  EXPECT_NEAR(moments_inside(square, {}, R).area, pi * R * R - 4 * R * R * (half - std::sin(half) * std::cos(half)), 1e-14);
  EXPECT_NEAR(moments_inside(square, {1, 1}, 1).area, pi / 4, 1e-15);
  EXPECT_NEAR(moments_inside(square, {3, 0}, 1).area, 0, 1e-15);
  const Moments quarter = moments_inside(square, {-1, 1}, 1);
  EXPECT_NEAR(quarter.first.x / quarter.area, -1 + 4 / (3 * pi), 0.01);
}

// The intersection of convex polygons has the area and the middle it should, and none where they only touch.
TEST(SlidingClip, CutsPolygonsAtPolygons) {
  Polygon square, diamond, beside;
  for (const Point2 x : {Point2{0, 0}, {2, 0}, {2, 2}, {0, 2}}) square.add(x), beside.add(x + Point2{2, 0});
  for (const Point2 x : {Point2{2, 0.5}, {3, 1.5}, {2, 2.5}, {1, 1.5}}) diamond.add(x);
  const Polygon common = intersection(square, diamond);
  EXPECT_NEAR(moments(common).area, 0.875, 1e-15);
  EXPECT_NEAR(moments(intersection(diamond, square)).area, 0.875, 1e-15);
  EXPECT_NEAR(moments(intersection(square, square)).area, 4, 0);
  EXPECT_EQ(moments(intersection(square, beside)).area, 0);
  const Moments m = moments(common);
  EXPECT_NEAR(middle(common).x, m.first.x / m.area, 1e-15);
  EXPECT_TRUE(is_convex(square));
  std::swap(square.point[0], square.point[1]);
  EXPECT_FALSE(is_convex(square));
}

}  // namespace
