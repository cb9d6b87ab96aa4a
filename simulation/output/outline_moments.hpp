#pragma once
// What a camera far away sees of the pieces of a run: area and the ellipse with the same second moments.
#include <vector>

#include "dem/rag_measures.hpp"
#include "observe/silhouette.hpp"

namespace snag {

/// Of the piece `rag`, or of all where it is -1. Cloth: its silhouette in pixels (observe/silhouette.hpp). Fibres: strips of the fibre's
/// width along their bonds, exact while a fibre does not cover itself, and smooth in the positions, which derivatives of runs by
/// differences need. A sphere: a disc. Of all pieces the cloths alone where there is one. `sheet` is that of all pieces on this rank.
Silhouette outline_of(const RagSheet& sheet, const std::vector<Rag>& rags, const View& view, int rag = -1);

}  // namespace snag
