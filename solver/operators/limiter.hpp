#pragma once
// Limiter of velocity gradients: one factor a cell in [0, 1].
#include <span>
#include <vector>

#include "mesh/mesh.hpp"

namespace snag {

enum class Limiter { none, barth_jespersen, venkatakrishnan };

/// Factor of each row of the gradient G of u such that values at the face centres stay between those of the cell and its neighbours; `psi`
/// [n_all_cells], ghosts filled. `reference_speed`, m/s: variations far below it on the scale of a cell are left alone by venkatakrishnan,
/// which keeps second order. Collective.
void limit_gradient(const Mesh& mesh, Limiter limiter, std::span<const Vec3> u, std::span<const Mat3> G, double reference_speed,
                    std::vector<Vec3>& psi);

}  // namespace snag
