#pragma once
// What a camera far away sees of the pieces of a run: area and the ellipse with the same second moments.
#include <vector>

#include "dem/rag_measures.hpp"
#include "observe/silhouette.hpp"

namespace snag {

/// Cloth: its silhouette in pixels (observe/silhouette.hpp). Fibres: strips of the fibre's width along their bonds, exact while a fibre
/// does not cover itself, and smooth in the positions, which derivatives of runs by differences need. A sphere: a disc. Of all pieces
/// together the cloths alone where there is one. `sheet` is that of all pieces on this rank.
Silhouette outline_of_all(const RagSheet& sheet, const std::vector<Rag>& rags, const View& view);
std::vector<Silhouette> outlines_of_pieces(const RagSheet& sheet, const std::vector<Rag>& rags, const View& view);  // [rag]

}  // namespace snag
