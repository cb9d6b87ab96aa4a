#pragma once
// Which rank gets which cell.
#include <vector>

namespace snag {

/// Parts 0 .. n_parts - 1 of equal size with few cut edges, of a graph in compressed rows (neighbours of vertex v:
/// neighbour[start[v]] .. neighbour[start[v + 1] - 1]). Each connected component is cut by itself: every part then has its share of a
/// rotor and of its stator, and the work that only the rotor needs is shared out, too. Sequential SCOTCH with a fixed seed: the same graph
/// always gives the same parts, so that a run repeats to the bit on the same ranks (PT-Scotch cuts differently every time). Throws
/// Error(mesh).
std::vector<int> partition_graph(const std::vector<int>& start, const std::vector<int>& neighbour, int n_parts);

}  // namespace snag
