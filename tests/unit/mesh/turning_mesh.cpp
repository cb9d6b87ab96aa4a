// ranks: 1 3
// long ranks: 2 5
#include "mesh/sliding/turning_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <span>

#include "base/error.hpp"
#include "mesh/import/import.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"
#include "sliding_shells.hpp"

namespace {

using namespace snag;
using test::Shells;

constexpr double pi = std::numbers::pi, tiny = 1e-12;

Mesh imported(const Shells& shells, MPI_Comm comm = MPI_COMM_WORLD) {
  const test::TemporaryFile file(test::sample_of(shells), test::Format::ascii22);
  ImportOptions options;
  if (shells.is_periodic) options.periodic = {{"bottom", "top", {0, 0, shells.height}}};
  return import_mesh(file.path(), comm, options);
}

std::span<const int> row(const std::vector<int>& start, const std::vector<int>& entries, int i) {
  return std::span(entries).subspan(start[i], start[i + 1] - start[i]);
}

/// Faces of both sides of the interface that each cell has, [n_all_cells]; of a mesh that has not been joined.
std::vector<int> interface_faces(const Mesh& mesh) {
  std::vector<int> count(mesh.n_all_cells());
  for (const char* name : {"interface_rotor", "interface_stator"})
    for (int f = mesh.patches[mesh.patch_index(name)].first; f < mesh.patches[mesh.patch_index(name)].end(); ++f) ++count[mesh.owner[f]];
  return count;
}

/// Facets whose linear weight, formed anew from the geometry, is not the one in the mesh; each counted once.
std::int64_t other_weights(const Mesh& mesh) {
  std::int64_t n = 0;
  for (int f = mesh.first_facet; f < mesh.n_interior; ++f) {
    if (mesh.owner[f] >= mesh.n_cells) continue;
    const Vec3 to_face = mesh.face_centre[f] - mesh.cell_centre[mesh.owner[f]];
    n += std::abs(1 - dot(mesh.face_vector[f], to_face) / dot(mesh.face_vector[f], mesh.delta[f]) - mesh.weight[f]) > 1e-9;
  }
  return sum(mesh.comm, n);
}

// Cells close, facets cover each interface face once, and nothing is swept out of a cell.
void expect_closed(const Mesh& mesh, const TurningMesh& turning, const std::vector<int>& covered) {
  std::vector<Vec3> total(mesh.n_all_cells());
  std::vector<double> surface(total.size()), share(total.size()), swept(total.size()), sweeping(total.size()), flux;
  turning.set_mesh_flux(100, flux);
  ASSERT_EQ(flux.size(), static_cast<std::size_t>(mesh.n_faces));
  for (int f = 0; f < mesh.n_faces; ++f)
    for (const bool owns : {true, false}) {
      const int c = owns ? mesh.owner[f] : mesh.neighbour[f];
      if (c < 0) continue;
      total[c] += (owns ? 1 : -1) * mesh.face_vector[f], surface[c] += norm(mesh.face_vector[f]);
      swept[c] += (owns ? 1 : -1) * flux[f], sweeping[c] += std::abs(flux[f]);
      if (f >= mesh.first_facet && f < mesh.n_interior)
        share[c] += mesh.facet_share[static_cast<std::size_t>(f - mesh.first_facet)][owns ? 0 : 1];
    }
  double closure = 0;
  for (int c = 0; c < mesh.n_cells; ++c) {
    closure = std::max(closure, norm(total[c]) / surface[c]);
    EXPECT_NEAR(share[c], covered[c], tiny);
    EXPECT_NEAR(swept[c], 0, tiny * sweeping[c]);
  }
  closure = maximum(mesh.comm, closure);
  EXPECT_LT(closure, tiny);
  EXPECT_LT(turning.closure(), tiny);
  for (int f = mesh.first_facet; f < mesh.n_interior; ++f) EXPECT_EQ(flux[f], 0);
}

// Counts, patches and rows fit each other; facets lie between a turning and a standing cell, and nowhere else do zones meet.
void expect_consistent(const Mesh& mesh, const TurningMesh& turning) {
  const auto n_faces = static_cast<std::size_t>(mesh.n_faces);
  for (const std::size_t size : {mesh.owner.size(), mesh.neighbour.size(), mesh.face_vector.size(), mesh.face_centre.size(),
                                 mesh.delta.size(), mesh.weight.size(), mesh.face_node_start.size() - 1})
    ASSERT_EQ(size, n_faces);
  ASSERT_EQ(mesh.facet_share.size(), static_cast<std::size_t>(mesh.n_interior - mesh.first_facet));
  int next = mesh.n_interior;
  for (const Patch& patch : mesh.patches) {
    EXPECT_EQ(patch.first, next) << patch.name;
    EXPECT_EQ(patch.count_global, sum(mesh.comm, std::int64_t{patch.count})) << patch.name;
    next = patch.end();
  }
  EXPECT_EQ(next, mesh.n_faces);

  std::vector<std::vector<int>> faces(mesh.n_cells);
  for (int f = 0; f < mesh.n_faces; ++f) {
    const int P = mesh.owner[f], N = mesh.neighbour[f];
    EXPECT_EQ(N >= 0, f < mesh.n_interior);
    EXPECT_TRUE(P < mesh.n_cells || (N >= 0 && N < mesh.n_cells)) << "no cell of the face is owned";
    for (const int c : {P, N})
      if (c >= 0 && c < mesh.n_cells) faces[c].push_back(f);
    const bool is_facet = f >= mesh.first_facet && f < mesh.n_interior;
    EXPECT_EQ(row(mesh.face_node_start, mesh.face_node, f).empty(), is_facet);
    if (N < 0) {
      EXPECT_LT(norm(mesh.face_centre[f] - mesh.cell_centre[P] - mesh.delta[f]), tiny);
      EXPECT_EQ(mesh.weight[f], 1);
      continue;
    }
    EXPECT_LT(mesh.cell_id[P], mesh.cell_id[N]);
    EXPECT_EQ((mesh.cell_zone[P] == turning.zone()) != (mesh.cell_zone[N] == turning.zone()), is_facet);
    EXPECT_LT(norm(mesh.cell_centre[N] - mesh.cell_centre[P] - mesh.delta[f]), tiny);
    EXPECT_GT(mesh.weight[f], 0);
    EXPECT_LT(mesh.weight[f], 1);
    EXPECT_GT(dot(mesh.face_vector[f], mesh.delta[f]), 0);
  }
  ASSERT_EQ(mesh.cell_face_start.size(), static_cast<std::size_t>(mesh.n_cells) + 1);
  for (int c = 0; c < mesh.n_cells; ++c) {
    const auto listed = row(mesh.cell_face_start, mesh.cell_face, c);
    EXPECT_TRUE(std::equal(listed.begin(), listed.end(), faces[c].begin(), faces[c].end())) << "faces of cell " << mesh.cell_id[c];
  }
}

// The nodes of a boundary face without an edge on the interface span the face vector that the mesh has: rows of nodes moved along with the
// faces, and both turned.
void expect_nodes_follow(const Mesh& mesh, const Shells& shells) {
  const Vec3 axis = unit(shells.axis);
  for (int f = mesh.n_interior; f < mesh.n_faces; ++f) {
    const auto nodes = row(mesh.face_node_start, mesh.face_node, f);
    ASSERT_GE(nodes.size(), 3u);
    bool is_curved = false;
    Vec3 vector;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Vec3 a = mesh.node[nodes[i]] - shells.origin, b = mesh.node[nodes[(i + 1) % nodes.size()]] - shells.origin;
      vector += 0.5 * cross(a, b);
      is_curved =
          is_curved || std::abs(norm(a - dot(a, axis) * axis) - shells.radius) < 1e-9 || std::abs(dot(a, axis) - shells.height) < 1e-9;
    }
    if (!is_curved) {
      EXPECT_LT(norm(vector - mesh.face_vector[f]), 1e-12 * norm(vector) + 1e-17);
    }
  }
}

void expect_turns(const Shells& shells, std::initializer_list<double> angles) {
  Mesh mesh = imported(shells);
  const std::vector<int> covered = interface_faces(mesh);
  const std::size_t n_patches = mesh.patches.size();
  const int n_others =
      mesh.n_faces - mesh.patches[mesh.patch_index("interface_rotor")].count - mesh.patches[mesh.patch_index("interface_stator")].count;
  TurningMesh turning(mesh, shells.description());
  EXPECT_EQ(mesh.patches.size(), n_patches - 2);
  for (const double angle : angles) {
    SCOPED_TRACE(angle);
    turning.turn(angle);
    EXPECT_EQ(turning.angle(), angle);
    EXPECT_EQ(mesh.n_faces - (mesh.n_interior - mesh.first_facet), n_others);
    expect_closed(mesh, turning, covered);
    if (!shells.is_periodic) expect_consistent(mesh, turning);
    expect_nodes_follow(mesh, shells);
  }
}

// At many angles each cell closes, each interface face is covered once, and the bookkeeping of the mesh is whole.
TEST(TurningMesh, ClosesAtManyAngles) {
  for (const bool tetrahedra : {true, false}) {
    SCOPED_TRACE(tetrahedra);
    expect_turns({.tetrahedra = tetrahedra}, {0, 0.01, 0.1, 0.4, 1, 1.7, pi, -2.2, 20 * pi, 1e4});
  }
}

TEST(TurningMesh, ClosesWhereMeshesCoincide) {
  expect_turns({.rotor = {16, 2, 3}, .stator = {16, 2, 3}, .stator_start = 0, .tetrahedra = false}, {0, pi / 8, 1e-9, -pi / 16});
}

TEST(TurningMesh, ClosesAboutAnyAxisAndWhenPeriodic) {
  expect_turns({.origin = {0.3, -0.2, 0.1}, .axis = {1, -2, 0.5}}, {0.3, 4});
  expect_turns({.rotor = {14, 3, 1}, .stator = {17, 3, 1}, .tetrahedra = false, .has_lid = false, .is_periodic = true}, {0, 0.9});
}

// Volumes and the moments of zones are those of a rigid body: nothing but the turning zone moves.
TEST(TurningMesh, MovesTheZoneAsARigidBody) {
  const Shells shells;
  Mesh mesh = imported(shells);
  TurningMesh turning(mesh, shells.description());
  const auto centre = mesh.cell_centre, nodes = mesh.node;
  const auto volume = mesh.cell_volume;
  const double angle = 0.7;
  turning.turn(angle);
  const auto turned = [&](const Vec3& x) {
    return Vec3{x.x * std::cos(angle) - x.y * std::sin(angle), x.x * std::sin(angle) + x.y * std::cos(angle), x.z};
  };
  EXPECT_EQ(volume, mesh.cell_volume);
  for (int c = 0; c < mesh.n_all_cells(); ++c) {
    const bool turns = mesh.cell_zone[c] == turning.zone();
    EXPECT_LT(norm(mesh.cell_centre[c] - (turns ? turned(centre[c]) : centre[c])), 1e-15);
    if (c >= mesh.n_cells) continue;
    for (const int n : row(mesh.cell_node_start, mesh.cell_node, c))
      EXPECT_LT(norm(mesh.node[n] - (turns ? turned(nodes[n]) : nodes[n])), 1e-15);
  }
  // A face sweeps what its centre's velocity says, but for the curvature of its edges.
  std::vector<double> flux;
  turning.set_mesh_flux(3, flux);
  for (int f = 0; f < mesh.n_faces; ++f) {
    const Vec3 &x = mesh.face_centre[f], &S = mesh.face_vector[f];
    const double expected = mesh.cell_zone[mesh.owner[f]] == turning.zone() ? 3 * dot({-x.y, x.x, 0}, S) : 0;
    if (f < mesh.first_facet || f >= mesh.n_interior) {
      EXPECT_NEAR(flux[f], expected, 0.03 * 3 * shells.radius * norm(S));
    }
  }
}

/// All of the mesh that an angle decides.
struct Snapshot {
  std::vector<int> owner, neighbour, cell_face_start, cell_face, face_node_start, face_node, first;
  std::vector<Vec3> cell_centre, face_vector, face_centre, delta, node;
  std::vector<double> weight;
  std::vector<std::array<double, 2>> share;
  explicit Snapshot(const Mesh& m)
      : owner(m.owner),
        neighbour(m.neighbour),
        cell_face_start(m.cell_face_start),
        cell_face(m.cell_face),
        face_node_start(m.face_node_start),
        face_node(m.face_node),
        cell_centre(m.cell_centre),
        face_vector(m.face_vector),
        face_centre(m.face_centre),
        delta(m.delta),
        node(m.node),
        weight(m.weight),
        share(m.facet_share) {
    for (const Patch& patch : m.patches) first.push_back(patch.first);
  }
  bool operator==(const Snapshot&) const = default;
};

// An angle is reached with the same bits whatever came before, and whether the mesh was joined there or turned there.
TEST(TurningMesh, AnAngleHasOneMesh) {
  const Shells shells;
  Mesh mesh = imported(shells);
  TurningMesh turning(mesh, shells.description());
  const Snapshot start(mesh);
  turning.turn(0.83);
  const Snapshot first(mesh);
  EXPECT_FALSE(first == start);
  for (const double elsewhere : {-1.0, 0.830001, 5.0, 1e3}) turning.turn(elsewhere);
  turning.turn(0.83);
  EXPECT_TRUE(Snapshot(mesh) == first);
  turning.turn(0);
  EXPECT_TRUE(Snapshot(mesh) == start);
  Mesh other = imported(shells);
  const TurningMesh at_once(other, shells.description(), 0.83);
  EXPECT_TRUE(Snapshot(other) == first);
}

// On any number of ranks each owned cell has the facets that it has on one rank, to the bit: the ghosts suffice at every angle.
TEST(TurningMesh, FacetsAreThoseOfOneRank) {
  const Shells shells{.rotor = {24, 2, 4}, .stator = {31, 3, 5}, .tetrahedra = false};
  const test::TemporaryFile file(test::sample_of(shells), test::Format::ascii22);
  Mesh mesh = import_mesh(file.path(), MPI_COMM_WORLD), whole = import_mesh(file.path(), MPI_COMM_SELF);
  TurningMesh turning(mesh, shells.description()), reference(whole, shells.description());
  const auto rotor_side = [](const Mesh& m, int f) { return std::pair(m.cell_id[m.owner[f]], m.cell_id[m.neighbour[f]]); };
  for (int step = 0; step < 40; ++step) {
    const double angle = 2 * pi * step / 40 + 0.01 * step;
    SCOPED_TRACE(angle);
    turning.turn(angle), reference.turn(angle);
    EXPECT_EQ(turning.n_facets_global(), reference.n_facets_global());
    std::multimap<std::pair<std::int64_t, std::int64_t>, int> expected;
    for (int f = whole.first_facet; f < whole.n_interior; ++f) expected.emplace(rotor_side(whole, f), f);
    std::vector<int> owned(whole.n_cells), found(mesh.n_cells);
    for (int f = whole.first_facet; f < whole.n_interior; ++f) ++owned[whole.owner[f]], ++owned[whole.neighbour[f]];
    for (int f = mesh.first_facet; f < mesh.n_interior; ++f) {
      for (const int c : {mesh.owner[f], mesh.neighbour[f]})
        if (c < mesh.n_cells) ++found[c];
      const auto [begin, end] = expected.equal_range(rotor_side(mesh, f));
      const auto same = std::find_if(begin, end, [&](const auto& e) { return whole.face_vector[e.second] == mesh.face_vector[f]; });
      ASSERT_NE(same, end) << "a facet of this rank is none of the whole mesh";
      const int g = same->second;
      EXPECT_EQ(mesh.face_centre[f], whole.face_centre[g]);
      EXPECT_LT(norm(mesh.delta[f] - whole.delta[g]), tiny * norm(whole.delta[g]));
      EXPECT_NEAR(mesh.weight[f], whole.weight[g], tiny);
    }
    std::map<std::int64_t, int> on_one_rank;
    for (int c = 0; c < whole.n_cells; ++c) on_one_rank[whole.cell_id[c]] = owned[c];
    for (int c = 0; c < mesh.n_cells; ++c) EXPECT_EQ(found[c], on_one_rank[mesh.cell_id[c]]);
  }
}

// Ghosts that came with the interface are filled by the halo as all others are.
TEST(TurningMesh, GhostsAreFilled) {
  const Shells shells;
  Mesh mesh = imported(shells);
  TurningMesh turning(mesh, shells.description(), 0.3);
  std::vector<double> field(mesh.n_all_cells(), -1);
  for (int c = 0; c < mesh.n_cells; ++c) field[c] = static_cast<double>(mesh.cell_id[c]);
  mesh.halo.exchange(field);
  for (int c = 0; c < mesh.n_all_cells(); ++c) {
    EXPECT_EQ(field[c], static_cast<double>(mesh.cell_id[c]));
    EXPECT_GT(mesh.cell_volume[c], 0);
  }
}

// Facets come and go; what a field holds on all other faces stays.
TEST(TurningMesh, FieldsFollowTheFacets) {
  const Shells shells;
  Mesh mesh = imported(shells);
  TurningMesh turning(mesh, shells.description());
  std::vector<double> field(mesh.n_faces, 7);
  for (int f = 0; f < mesh.first_facet; ++f) field[f] = f;
  for (int f = mesh.n_interior; f < mesh.n_faces; ++f) field[f] = -(f - mesh.n_interior);
  std::int64_t changes = 0;
  for (const double angle : {0.05, 0.2, 0.0, 2.0}) {
    const int before = mesh.n_interior;
    turning.turn(angle);
    changes += mesh.n_interior != before;
    resize_facets(mesh, field, 5.0);
    ASSERT_EQ(field.size(), static_cast<std::size_t>(mesh.n_faces));
    for (int f = 0; f < mesh.n_faces; ++f) EXPECT_EQ(field[f], f < mesh.first_facet ? f : f < mesh.n_interior ? 5 : -(f - mesh.n_interior));
  }
  EXPECT_GT(sum(mesh.comm, changes), 0) << "the number of facets must change, else the test shows nothing";
}

// Zones that do not touch are an error that names the place.
TEST(TurningMesh, NamesThePlaceWhereZonesDoNotTouch) {
  const Shells apart{.stator_radius = 0.051};
  Mesh mesh = imported(apart);
  try {
    TurningMesh turning(mesh, apart.description());
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::mesh);
    EXPECT_NE(std::string(error.what()).find("side at ("), std::string::npos) << error.what();
  }
}

// Weights that are kept within bounds are counted: some at the rims of coarse tetrahedra, none on hexahedra.
TEST(TurningMesh, CountsBoundedWeights) {
  const auto bounded = [](const Shells& shells) {
    Mesh mesh = imported(shells);
    TurningMesh turning(mesh, shells.description());
    EXPECT_EQ(turning.n_bounded_global(), other_weights(mesh));
    turning.turn(0.5);
    EXPECT_EQ(turning.n_bounded_global(), other_weights(mesh));
    return turning.n_bounded_global();
  };
  EXPECT_GT(bounded({}), 0);
  EXPECT_EQ(bounded({.tetrahedra = false}), 0);
}

}  // namespace
