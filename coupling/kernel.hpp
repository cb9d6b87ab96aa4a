#pragma once
// Transfers between particles and cells, across ranks, with one set of weights for both ways.
//
//   average (consistent):   u_b = sum_c w_bc u_c                 fluid -> particles; a constant is returned exactly
//   spread (conservative):  f_c = 1/V_c sum_b w_bc F_b           particles -> fluid; sum_c V_c f_c = sum_b F_b
//
// w_bc: weight of particle b in cell c; sum_c w_bc = 1 also near walls. How a kernel finds and weighs cells is in
// coupling/distance_kernel.hpp, coupling/point_kernel.hpp, coupling/diffusion_weights.hpp.
//
// Near walls particles in a share N of unbounded space would give too little to the cells at the wall: what an even layer of particles
// gives would be ln 2 = 0.69 of the rest there, and more than the rest a width away. A factor of cells,
//
//   d_c N_c = max(1, N_c of d = 1),     N_c = sum_c' V_c' d_c' G(|x_c' - x_c|) / int G dV                                         (2)
//
// makes up for it: it makes the kernel between cells doubly stochastic (Sinkhorn 1967), so that an even layer gives 1 within 0.2 %
// everywhere (1 to 3 % with points in cells). Where cells are wider than the kernel the sum is no integral: N is above 1 in the open, and
// d stays 1. Rounds d <- d (d N)^(-2/3) find it: the logarithm of d N is multiplied by 1 - 2/3 (1 + e) with the eigenvalues e of the
// kernel, 0 to 1.
//
// A particle that no cell holds (overlap with a wall, a gap) and that no kernel reaches takes the nearest centre; it is counted. Ties go to
// the lowest cell_id. Away from walls `average` is second-order accurate in delta, and exact for linear fields on meshes that are symmetric
// about the particle.
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "coupling/cell_weights.hpp"
#include "coupling/kernel_shape.hpp"
#include "coupling/known_factors.hpp"
#include "mesh/locator.hpp"
#include "mesh/mesh.hpp"

namespace snag {

/// A cell field, components interleaved, [at least n_cells][components].
struct CellField {
  const double* values = nullptr;
  int components = 1;
};

/// The same to add to, [n_cells][components].
struct CellSums {
  double* values = nullptr;
  int components = 1;
};

/// What a transfer works with, kept from one to the next: to allocate as much each time costs as much as the work.
struct KernelScratch {
  std::vector<double> of_cells, of_row, answers, entries;
};

class Kernel {
 public:
  /// `shape` and `mesh` must outlive the kernel. `width`: delta, m; any positive number for the cell kernel. `known`: of this mesh, with
  /// what kernels before it have found; the same on all ranks. Collective.
  Kernel(const KernelShape& shape, double width, const Mesh& mesh, KnownFactors* known = nullptr);

  /// Cells have moved (a turning zone). Collective.
  void mesh_moved();
  /// Weights of the particles of this rank at these places. Collective.
  void locate(std::span<const Vec3> points);
  /// Fluid -> particles, consistent: all fields in one message, [n_particles][sum of components]. Collective.
  std::vector<double> average(std::span<const CellField> fields) const;
  std::vector<Vec3> average(std::span<const Vec3> field) const;
  /// Particles -> fluid, conservative: amounts [n_particles][sum of components] are added as amount per m3 to the fields, all in one
  /// message. Collective.
  void spread(std::span<const double> amounts, std::span<const CellSums> fields) const;
  void spread(std::span<const double> amounts, int components, std::span<double> field) const;

  /// Owned cells that average and spread use, at the last locate, each once.
  std::vector<int> cells() const;
  double width() const { return width_; }
  const KernelShape& shape() const { return shape_; }
  int n_particles() const { return n_particles_; }
  /// Particles of all ranks that no cell holds, at the last locate.
  std::int64_t n_outside() const { return n_outside_; }
  /// Whether a cell holds particle b of this rank, at the last locate.
  bool is_inside(std::size_t b) const { return is_inside_[b] != 0; }
  /// Points of all particles of all ranks by which the kernel finds cells and that no cell holds, at the last locate: their centres, and
  /// further points if the kernel has them.
  std::int64_t n_points_outside() const { return n_points_outside_; }
  /// Rank whose cell holds each particle of this rank (or the nearest cell, if none does and the kernel does not reach one).
  const std::vector<int>& holder_rank() const { return holder_rank_; }
  /// Kernel width over the cell size V^(1/3) of the cells that hold particles: least and largest of all ranks; {0, 0} without particles.
  /// Collective.
  std::array<double, 2> width_over_cell_size() const;

 private:
  void weigh_cells(KnownFactors& known);
  std::vector<double> find_factors();
  void warn_of_many_pairs(std::int64_t n_at_boundary) const;
  void locate_in_parts(const std::vector<int>& cells, const std::function<void(std::size_t, std::size_t)>& use);
  void plan_by_boxes(std::span<const Vec3> points);
  void find_holders(std::span<const Vec3> points);
  void drop_empty_rows();
  void take_nearest_cells(std::span<const Vec3> points, const std::vector<int>& unresolved);

  const KernelShape& shape_;
  double width_;
  const Mesh& mesh_;
  CellLocator locator_;
  std::unique_ptr<CellWeights> weights_;
  RankBoxes boxes_;

  int n_particles_ = 0;
  std::int64_t n_outside_ = 0, n_points_outside_ = 0;
  bool some_in_nearest_cell_ = false;  // some particle of some rank took the nearest cell
  std::vector<int> holder_rank_;
  std::vector<std::uint8_t> is_inside_;
  std::vector<std::int64_t> holder_id_;
  std::vector<int> holder_cell_;        // local number of that cell on its rank: the hint of the next search
  ParticleRouter around_;               // to the ranks that may have cells for the particles
  std::vector<Vec3> announced_places_;  // of the particles that were announced to this rank, m
  std::vector<int> announced_holder_;   // the owned cell that holds each of them, or -1
  std::vector<std::int64_t> announced_number_;
  ParticleRouter to_nearest_;  // of the particles for which no cell counts
  WeightRows nearest_;
  mutable KernelScratch scratch_;
};

}  // namespace snag
