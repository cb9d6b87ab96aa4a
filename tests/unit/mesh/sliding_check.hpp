#pragma once
// What holds for the facets of any sliding interface at any angle.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "mesh/sliding/sliding_interface.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"

namespace snag::test {

/// Worst relative errors over all ranks.
struct InterfaceErrors {
  double tiling = 0;    // facets of a face against its vector
  double coverage = 0;  // against its area on the surface
  double closure = 0;   // face vectors and facets of a cell, over its surface
  double area = 0;      // of all facets, m2
  std::int64_t facets = 0;
};

/// `mesh`: curved, rotor at angle 0.
inline InterfaceErrors interface_errors(const Mesh& mesh, const SlidingInterface& interface, double angle) {
  const int rank = rank_of(mesh.comm);
  const Mat3 rotation = interface.rotation(angle);
  const auto turns = [&](int cell) { return mesh.zones[mesh.cell_zone[cell]] == interface.description().rotor_zone; };
  const auto vector_of = [&](int f) { return turns(mesh.owner[f]) ? rotation * mesh.face_vector[f] : mesh.face_vector[f]; };
  std::vector<Vec3> total(mesh.n_all_cells());
  std::vector<double> surface(total.size(), 0);
  const auto add = [&](int cell, const Vec3& S) { total[cell] += S, surface[cell] += norm(S); };
  std::map<int, Vec3> left;  // of interface faces
  std::map<int, double> open;
  for (const std::string& name : {interface.description().rotor_patch, interface.description().stator_patch}) {
    const Patch& patch = mesh.patches[mesh.patch_index(name)];
    for (int f = patch.first; f < patch.end(); ++f) left[f] = vector_of(f);
  }
  for (const RevolvedSide* side : {&interface.surface().rotor, &interface.surface().stator})
    for (const RevolvedFace& face : side->face)
      if (face.rank == rank) open[face.face] = face.area;
  const std::map<int, double> whole = open;
  for (int f = 0; f < mesh.n_faces; ++f) {
    if (left.contains(f)) continue;
    add(mesh.owner[f], vector_of(f));
    if (mesh.neighbour[f] >= 0) add(mesh.neighbour[f], -1 * vector_of(f));
  }
  InterfaceErrors errors;
  double area = 0;
  for (const Facet& facet : interface.facets(angle)) {
    EXPECT_TRUE(facet.rotor.rank == rank || facet.stator.rank == rank);
    EXPECT_GT(facet.area, 0);
    EXPECT_LE(norm(facet.vector), facet.area * (1 + 1e-2));  // slivers know their direction and size to a per cent
    for (const bool is_rotor : {true, false}) {
      const FacetSide& side = is_rotor ? facet.rotor : facet.stator;
      if (side.rank != rank) continue;
      EXPECT_EQ(mesh.cell_id[side.cell], side.cell_id);
      EXPECT_EQ(mesh.owner[side.face], side.cell);
      EXPECT_EQ(turns(side.cell), is_rotor);
      const Vec3 S = is_rotor ? facet.vector : -1 * facet.vector;
      left.at(side.face) -= S, open.at(side.face) -= facet.area;
      add(side.cell, S);
    }
    if (facet.rotor.rank == rank) area += facet.area, ++errors.facets;
  }
  for (const auto& [f, S] : left) errors.tiling = std::max(errors.tiling, norm(S) / whole.at(f));
  for (const auto& [f, A] : open) errors.coverage = std::max(errors.coverage, std::abs(A) / whole.at(f));
  for (int c = 0; c < mesh.n_cells; ++c) errors.closure = std::max(errors.closure, norm(total[c]) / surface[c]);
  for (double* error : {&errors.tiling, &errors.coverage, &errors.closure}) *error = maximum(mesh.comm, *error);
  errors.area = sum(mesh.comm, area), errors.facets = sum(mesh.comm, errors.facets);
  return errors;
}

/// Largest sum of the mesh fluxes over a cell, over the sum of their sizes.
inline double swept_by_cells(const Mesh& mesh, const SlidingInterface& interface) {
  const std::vector<double> flux = interface.mesh_flux(mesh, 100);
  std::vector<double> total(mesh.n_all_cells(), 0), size(total.size(), 0);
  for (int f = 0; f < mesh.n_faces; ++f) {
    total[mesh.owner[f]] += flux[f], size[mesh.owner[f]] += std::abs(flux[f]);
    if (mesh.neighbour[f] >= 0) total[mesh.neighbour[f]] -= flux[f], size[mesh.neighbour[f]] += std::abs(flux[f]);
  }
  double worst = 0;
  for (int c = 0; c < mesh.n_cells; ++c) worst = std::max(worst, size[c] > 0 ? std::abs(total[c]) / size[c] : 0);
  return maximum(mesh.comm, worst);
}

}  // namespace snag::test
