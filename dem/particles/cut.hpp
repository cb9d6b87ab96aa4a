#pragma once
// A straight cut in the plane of a piece of cloth: bonds that cross it are never made.
//
// A, B: ends of the cut; P, Q: the two particles of a bond; d = (B - A)/|B - A|;   s(X) = d x (X - A): distance of X on the left of the cut
// The bond crosses the cut if one particle is on the left, s >= -e, and the other is not, and if the point where it meets the line of the
// cut lies between A and B, within e;   e = 1e-9 of the lattice spacing.
// A particle on the line of the cut so belongs to the cloth on the left: a cut through a row of particles is a cut on the right of them.
#include <array>

namespace snag {

struct Rag;

/// Ends from the centre of the lattice: along the rows (lengthwise), across them (crosswise), m.
struct Cut {
  std::array<double, 2> from{}, to{};
};

/// Whether a cut crosses the line from this place of the lattice to the next one of its row (direction 0) or of its column (1).
bool crosses(const Cut& cut, const Rag& rag, int column, int row, int direction);

}  // namespace snag
