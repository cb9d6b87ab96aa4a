#include "dem/particles/cut.hpp"

#include <cmath>

#include "dem/particles/rag.hpp"

namespace snag {

bool crosses(const Cut& cut, const Rag& rag, int column, int row, int direction) {
  const double along_x = cut.to[0] - cut.from[0], along_y = cut.to[1] - cut.from[1], length = std::hypot(along_x, along_y);
  if (length == 0) return false;
  const double dx = along_x / length, dy = along_y / length, spacing = 2 * rag.radius, e = 1e-9 * spacing;
  const std::array<double, 2> first = rag.place(column, row);
  const double x = first[0] - cut.from[0], y = first[1] - cut.from[1];                        // P - A
  const double step_x = direction == 0 ? spacing : 0, step_y = direction == 0 ? 0 : spacing;  // Q - P
  const double one = dx * y - dy * x, two = one + dx * step_y - dy * step_x;                  // s(P), s(Q)
  if ((one >= -e) == (two >= -e)) return false;
  const double share = one / (one - two), met = dx * (x + share * step_x) + dy * (y + share * step_y);
  return met >= -e && met <= length + e;
}

bool Rag::has_bond(int column, int row, int direction) const {
  if (!exists(column, row) || !exists(column + (direction == 0), row + (direction == 1))) return false;
  for (const Cut& cut : cuts)
    if (crosses(cut, *this, column, row, direction)) return false;
  return true;
}

}  // namespace snag
