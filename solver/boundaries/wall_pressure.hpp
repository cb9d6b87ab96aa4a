#pragma once
// What the slope of the pressure at a wall follows from (solver/continuity.hpp): the acceleration of the water there, or with a wall
// function, past which the water slips, the gradients of the pressure around.
#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "solver/boundaries/boundary.hpp"
#include "solver/fields/flow.hpp"

namespace snag {

/// Where a cell lies: at no wall, with a face on a wall, or at an edge: with a node where faces of walls meet at more than 45 degrees.
enum class WallCell : std::uint8_t { inner, at_wall, at_edge };

/// Where each cell lies, [n_all_cells]. Collective.
std::vector<WallCell> wall_cells(const Mesh& mesh, const BoundarySet& boundary);

/// Acceleration of the water at boundary face b (f - n_interior) without a given pressure, m/s2, next to a cell with this velocity: at an
/// inlet as its condition gives it, at a wall that of the wall. Where the water `slips`, at a plane of symmetry that turns and at some
/// walls with a wall function, it is carried round with its own velocity u along that of the wall, v: (u.v/v.v)^2 of the wall's
/// acceleration, exact where the wall is a surface of revolution. At most all of it: water that is faster than a rotor at its start would
/// have a multiple of the wall's acceleration, and the flow would diverge. None where the water runs against the wall.
Vec3 acceleration_at_wall(const Vec3& velocity, const BoundaryValues& values, int b, bool slips);

/// How much of the slope of the pressure the gradients around have at a wall function: nothing in the viscous sublayer, up to y+ 5, where
/// the water in the cell does not slip; all in the logarithmic layer, from y+ 30 on; linear between. Bounds: Pope (2000), Turbulent Flows,
/// table 7.1.
inline double share_of_slip(double y_plus) { return std::clamp((y_plus - 5) / 25, 0.0, 1.0); }

/// Normal slope of the pressure without f~ of the cell, Pa/m, at a wall face with a wall function of an owned cell: that of the mean of
/// grad p - f~ over the neighbours that lie at no wall. `held`: f~, [n_all_cells], or empty without a reaction. None where all lie at
/// walls, as in a layer of one cell between two walls: their gradients follow from the slopes there, also that of the cell itself, and
/// nothing would bound the slope. Cells at edges neither have nor give one: they may lie round the corner, and drove single cells against
/// a wall with 4.5 times the speed of the rotor. Nor do the gradients hold a little way from an edge, where they drove a cell with 3.1
/// times that speed. So the pressures p_N of all neighbours check their mean G: the slope is multiplied by 2 a, within 0 and 1, with a
/// from the least squares of p_N - p_P - a G.d_N. In a linear pressure a is 1, on any mesh.
std::optional<double> slope_at_wall_function(const Mesh& mesh, std::span<const WallCell> wall_cell, const Flow& flow,
                                             std::span<const Vec3> held, int face);

}  // namespace snag
