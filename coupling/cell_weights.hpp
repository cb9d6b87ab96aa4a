#pragma once
// How a kernel finds cells and weighs them, across ranks. The rank that moves a particle announces it to all ranks that may have cells for
// it; each of these ranks gets the rows of its own cells.
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec3.hpp"
#include "coupling/particle_router.hpp"
#include "mesh/locator.hpp"

namespace snag {

/// Weights of the cells of this rank in compressed rows; particles may share a row. The entries hold places in the list of the cells that
/// are in use, so that what the rows need of a field fits the cache.
class WeightRows {
 public:
  std::vector<int> row;  // of each announced particle
  std::vector<int> start, place;
  std::vector<double> weight;
  int n_rows() const { return static_cast<int>(start.size()) - 1; }
  bool is_empty(int r) const { return start[r] == start[r + 1]; }
  /// Owned cells, each once; some may be in no row.
  const std::vector<int>& cells() const { return cells_; }
  /// Place of a cell in that list, to which it is added if it is new.
  int place_of(int cell);
  void clear();
  /// The places and weights that were appended since the last call become the row of the next particle.
  void close_row();

 private:
  std::vector<int> cells_, place_of_;  // [owned cells] -1: not in use
};

/// Particles of this rank, and those that were announced to it.
struct Announcement {
  const ParticleRouter& router;
  std::span<const int> holder_rank;         // [n_particles] rank of the cell that holds the particle, -1: none
  std::span<const std::int64_t> holder_id;  // [n_particles] and the cell_id
  std::span<const Vec3> places;             // [n_received] of the announced particles, m
  std::span<const int> holder;              // [n_received] owned cell that holds it, -1: none
  std::span<const std::int64_t> number;     // [n_received] the same in the next step, if the particle stays with its rank
};

using RankBoxes = std::vector<CellBox>;  // around the cells of each rank

class CellWeights {
 public:
  virtual ~CellWeights() = default;
  /// A particle is announced to the ranks whose cells lie so near, m.
  virtual double reach() const = 0;
  /// Cells have moved, and before the first use. Collective.
  virtual void mesh_moved(const RankBoxes&) {}
  /// Sets rows(), inside() and unresolved(). Collective.
  virtual void locate(const Announcement& announced) = 0;

  /// True if the kernel is cut off at walls: factors of cells are to be found. Until end_balancing() weights are those near the particle
  /// only.
  virtual bool start_balancing() { return false; }
  virtual void end_balancing() {}
  /// d_c of the owned cells; 1 before.
  virtual void set_cell_factors(const std::vector<double>&) {}

  /// Of the announced particles; normalised over all ranks.
  const WeightRows& rows() const { return rows_; }
  /// Forgets the announced particles for which `keeps` [n_received] is 0.
  void keep(std::span<const char> keeps);
  /// sum V_c d_c G over int G dV of each particle, 1: the share of its kernel that lies in the mesh, where d_c is 1.
  const std::vector<double>& inside() const { return inside_; }
  /// Particles of this rank for which no cell counts.
  const std::vector<int>& unresolved() const { return unresolved_; }
  /// Points, other than the centres of particles, that no cell holds, of this rank's particles.
  virtual std::int64_t n_points_outside() const { return 0; }

 protected:
  WeightRows rows_;
  std::vector<double> inside_;
  std::vector<int> unresolved_;
};

}  // namespace snag
