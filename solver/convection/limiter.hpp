#pragma once
// Limiters of the velocity gradient: one limiter, one file in solver/convection/limiters/, chosen by [flow] limiter = "..." for the
// convection schemes that take one. Which limiter it is, is decided once for all cells, never once a face
// (solver/convection/cell_limiter.hpp).
#include <span>
#include <string>
#include <vector>

#include "base/registry.hpp"
#include "mesh/mesh.hpp"
#include "solver/convection/velocity_range.hpp"

namespace snag {

/// What a limiter is, for the manual.
struct LimiterDescription {
  std::string equation, source;
};

/// What a limiter reads.
struct LimiterInputs {
  const Mesh& mesh;
  bool has_periods;          // faces of this rank are joined across a period
  std::span<const Vec3> u;   // [n_all_cells], m/s
  std::span<const Mat3> G;   // its gradient, [n_all_cells], 1/s
  double reference_speed;    // m/s; a limiter may leave alone variations far below it on the scale of a cell
  TetrahedronRanges ranges;  // for limiters of components
};

class Limiter {
 public:
  virtual ~Limiter() = default;
  virtual LimiterDescription description() const = 0;
  /// True if the velocity at the face centres stays between that of the cell and its neighbours, each component or along its change; in a
  /// tetrahedron also where it stays in its wider range.
  virtual bool bounds() const { return true; }
  /// Factor in [0, 1] of each row of the gradient, `psi` [n_all_cells], ghosts filled. Collective.
  virtual void limit(const LimiterInputs& inputs, std::vector<Vec3>& psi) const = 0;
};

Registry<Limiter>& limiters();
/// Meaning of the key `limiter`, with what each limiter is.
std::string limiter_meaning();

}  // namespace snag
