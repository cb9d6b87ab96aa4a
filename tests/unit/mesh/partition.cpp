// ranks: 1
// Parts of a graph: equal shares of each component.
#include "mesh/import/partition.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <vector>

using namespace snag;

namespace {

struct Graph {
  std::vector<int> start{0}, neighbour;
};

/// Sheets of squares side by side, not joined; `sides`: squares along each side of a sheet.
Graph sheets(const std::vector<int>& sides) {
  Graph graph;
  int first = 0;
  for (const int n : sides) {
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const int v = first + n * j + i;
        if (j > 0) graph.neighbour.push_back(v - n);
        if (i > 0) graph.neighbour.push_back(v - 1);
        if (i + 1 < n) graph.neighbour.push_back(v + 1);
        if (j + 1 < n) graph.neighbour.push_back(v + n);
        graph.start.push_back(static_cast<int>(graph.neighbour.size()));
      }
    first += n * n;
  }
  return graph;
}

std::vector<int> counts(std::span<const int> part, int n_parts) {
  std::vector<int> count(static_cast<std::size_t>(n_parts));
  for (const int p : part) ++count[static_cast<std::size_t>(p)];
  return count;
}

}  // namespace

TEST(Partition, every_part_has_its_share_of_each_component) {
  constexpr int side = 30, other_side = 40;
  const Graph graph = sheets({side, other_side});
  for (const int n_parts : {2, 3, 5}) {
    const std::vector<int> part = partition_graph(graph.start, graph.neighbour, n_parts);
    const auto small = std::span(part).first(side * side), large = std::span(part).subspan(side * side);
    for (const auto& cells : {small, large})
      for (const int count : counts(cells, n_parts))
        EXPECT_NEAR(count, static_cast<double>(cells.size()) / n_parts, 0.05 * static_cast<double>(cells.size()) / n_parts) << n_parts;
  }
}

TEST(Partition, components_too_small_to_share_out_are_cut_together) {
  const Graph graph = sheets({1, 1, 1, 1});
  const std::vector<int> part = partition_graph(graph.start, graph.neighbour, 2);
  EXPECT_EQ(counts(part, 2), (std::vector<int>{2, 2}));
}

TEST(Partition, nothing_and_one_part) {
  EXPECT_TRUE(partition_graph({0}, {}, 3).empty());
  EXPECT_EQ(partition_graph({0, 1, 2}, {1, 0}, 1), (std::vector<int>{0, 0}));
}
