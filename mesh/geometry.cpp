// Equations and symbols: geometry.hpp. Further, per interior face with owner P and neighbour N, x_N taken across the period if any:
//
//   delta = x_N - x_P,   weight w = S.(x_N - x_f) / S.(x_N - x_P)
//   phi_f = w phi_P + (1 - w) phi_N       exact for linear phi where delta meets x_f
#include "mesh/geometry.hpp"

#include "mesh/shapes.hpp"
#include "mesh/skewness.hpp"

namespace snag {

FaceGeometry face_geometry(std::span<const Vec3> nodes) {
  const Vec3 middle = mean(nodes);
  if (nodes.size() == 3) return {0.5 * cross(nodes[1] - nodes[0], nodes[2] - nodes[0]), middle};

  const auto part = [](const Vec3& a, const Vec3& b, const Vec3& m) { return 0.5 * cross(a - m, b - m); };
  Vec3 S, offset;
  for_each_triangle(nodes, [&](const Vec3& a, const Vec3& b, const Vec3& m) { S += part(a, b, m); });
  const double S_squared = norm_squared(S);
  if (S_squared == 0) return {S, middle};  // quality() reports it
  for_each_triangle(nodes, [&](const Vec3& a, const Vec3& b, const Vec3& m) { offset += dot(part(a, b, m), S) * ((a - m) + (b - m)); });
  return {S, middle + offset / (3 * S_squared)};
}

CellGeometry cell_geometry(CellShape shape, std::span<const Vec3> nodes) {
  const Vec3 o = mean(nodes);
  double volume = 0;
  Vec3 moment;
  const auto add_tetrahedron = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const double V_t = dot(a, cross(b, c)) / 6;
    volume += V_t;
    moment += V_t / 4 * (a + b + c);
  };
  for (const ShapeFace& face : faces_of(shape)) {
    const auto corner = [&](int i) { return nodes[static_cast<std::size_t>(face.node[static_cast<std::size_t>(i)])] - o; };
    if (face.n_nodes == 3) {
      add_tetrahedron(corner(0), corner(1), corner(2));
      continue;
    }
    const Vec3 m = 0.25 * (corner(0) + corner(1) + corner(2) + corner(3));
    for (int i = 0; i < 4; ++i) add_tetrahedron(m, corner(i), corner((i + 1) % 4));
  }
  return {volume, volume == 0 ? o : o + moment / volume};
}

void fill_geometry(Mesh& mesh, const std::vector<Vec3>& shift) {
  std::array<Vec3, 8> points;
  mesh.cell_volume.assign(static_cast<std::size_t>(mesh.n_all_cells()), 0);
  mesh.cell_centre.assign(static_cast<std::size_t>(mesh.n_all_cells()), {});
  for (int c = 0; c < mesh.n_cells; ++c) {
    const auto cell = cell_geometry(mesh.cell_shape[c], positions(mesh.node, row(mesh.cell_node_start, mesh.cell_node, c), points));
    mesh.cell_volume[c] = cell.volume;
    mesh.cell_centre[c] = cell.centre;
  }
  mesh.halo.exchange(mesh.cell_volume);
  mesh.halo.exchange(mesh.cell_centre);

  const auto n_faces = static_cast<std::size_t>(mesh.n_faces);
  mesh.face_vector.resize(n_faces), mesh.face_centre.resize(n_faces), mesh.delta.resize(n_faces), mesh.weight.assign(n_faces, 1);
  for (int f = 0; f < mesh.n_faces; ++f) {
    const auto face = face_geometry(positions(mesh.node, row(mesh.face_node_start, mesh.face_node, f), points));
    const Vec3& S = mesh.face_vector[f] = face.vector;
    const Vec3& x_f = mesh.face_centre[f] = face.centre;
    const Vec3& x_P = mesh.cell_centre[mesh.owner[f]];
    if (f >= mesh.n_interior) {
      mesh.delta[f] = x_f - x_P;
      continue;
    }
    const Vec3 x_N = mesh.cell_centre[mesh.neighbour[f]] + shift[f];
    mesh.delta[f] = x_N - x_P;
    mesh.weight[f] = dot(S, x_N - x_f) / dot(S, mesh.delta[f]);
  }
  mesh.skew_share.clear();
  for (int f = 0; f < mesh.n_interior; ++f) mesh.skew_share.push_back(static_cast<float>(skew_share(mesh, f)));
}

}  // namespace snag
