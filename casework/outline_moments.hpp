#pragma once
// What a camera far away sees of all pieces of a run: area and the ellipse with the same second moments.
#include "dem/rag_system.hpp"
#include "observe/silhouette.hpp"

namespace snag {

/// Cloth: its silhouette in pixels (observe/silhouette.hpp). Fibres: strips of the fibre's width along their bonds, exact while a fibre
/// does not cover itself, and smooth in the positions, which derivatives of runs by differences need. A sphere: a disc. For runs on one
/// rank.
Silhouette outline_of(const RagSystem& rags, const View& view);

}  // namespace snag
