#pragma once
// Halo exchange: values of cells that another rank owns. Arrays are [owned..., ghosts...], components interleaved.
#include <mpi.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/vec3.hpp"

namespace snag {

class Halo {
 public:
  Halo();
  /// `owner_rank[g]`, `owner_index[g]`: rank and local index there of ghost g; ghosts follow the n_owned entries. Collective. Built on
  /// PetscSF.
  Halo(MPI_Comm comm, int n_owned, const std::vector<int>& owner_rank, const std::vector<int>& owner_index);
  ~Halo();
  Halo(Halo&&) noexcept;
  Halo& operator=(Halo&&) noexcept;

  /// Owned -> ghosts. Collective. Throws Error(invariant) if the field does not hold all owned and ghost entries; an empty Halo() does
  /// nothing.
  void exchange(std::span<double> field, int components = 1) const;
  void exchange(std::vector<double>& field) const { exchange(std::span(field), 1); }
  void exchange(std::vector<Vec3>& field) const { exchange(std::span(reinterpret_cast<double*>(field.data()), 3 * field.size()), 3); }
  /// Owned -> ghosts, single precision. Collective.
  void exchange(std::span<float> field) const;
  /// Owned -> ghosts, integers. Collective.
  void exchange(std::span<std::int64_t> field) const;

 private:
  struct Plan;
  std::unique_ptr<Plan> plan_;
};

}  // namespace snag
