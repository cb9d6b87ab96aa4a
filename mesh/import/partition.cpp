#include "mesh/import/partition.hpp"

#include <scotch/scotch.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <numeric>

#include "base/error.hpp"

namespace snag {

static_assert(sizeof(SCOTCH_Num) == sizeof(int), "graphs are handed to SCOTCH as they are");

namespace {

/// Vertices of each connected part of the graph, rising; those of the whole if a part has fewer than `n_parts`, too few to share out.
std::vector<std::vector<int>> components_of(const std::vector<int>& start, const std::vector<int>& neighbour, int n_parts) {
  std::vector<std::vector<int>> components;
  std::vector<bool> seen(start.size() - 1);
  for (std::size_t first = 0; first < seen.size(); ++first) {
    if (seen[first]) continue;
    std::vector<int> vertices{static_cast<int>(first)};
    seen[first] = true;
    for (std::size_t i = 0; i < vertices.size(); ++i)
      for (int k = start[vertices[i]]; k < start[vertices[i] + 1]; ++k)
        if (const int other = neighbour[k]; !seen[other]) seen[other] = true, vertices.push_back(other);
    std::ranges::sort(vertices);
    components.push_back(std::move(vertices));
  }
  if (std::ranges::any_of(components, [n_parts](const auto& vertices) { return static_cast<int>(vertices.size()) < n_parts; })) {
    components.assign(1, std::vector<int>(seen.size()));
    std::iota(components[0].begin(), components[0].end(), 0);
  }
  return components;
}

std::vector<int> cut(std::vector<int> start, std::vector<int> neighbour, int n_parts) {
  const int n = static_cast<int>(start.size()) - 1;
  std::vector<int> part(static_cast<std::size_t>(n), 0);
  constexpr SCOTCH_Num seed = 1;
  SCOTCH_Context context;
  SCOTCH_Graph graph, bound;
  SCOTCH_Strat strategy;
  SCOTCH_contextInit(&context);
  SCOTCH_contextOptionSetNum(&context, SCOTCH_OPTIONNUMDETERMINISTIC, 1);
  SCOTCH_contextRandomSeed(&context, seed);
  SCOTCH_contextRandomReset(&context);
  SCOTCH_graphInit(&graph), SCOTCH_graphInit(&bound);
  SCOTCH_stratInit(&strategy);
  const bool failed = SCOTCH_graphBuild(&graph, 0, n, start.data(), nullptr, nullptr, nullptr, start[n], neighbour.data(), nullptr) != 0 ||
                      SCOTCH_contextBindGraph(&context, &graph, &bound) != 0 ||
                      SCOTCH_graphPart(&bound, n_parts, &strategy, part.data()) != 0;
  SCOTCH_stratExit(&strategy);
  SCOTCH_graphExit(&bound), SCOTCH_graphExit(&graph);
  SCOTCH_contextExit(&context);
  if (failed)
    throw Error(ExitCode::mesh,
                "mesh: SCOTCH could not cut " + std::to_string(n) + " cells into " + std::to_string(n_parts) + " parts; use fewer ranks");
  return part;
}

}  // namespace

std::vector<int> partition_graph(const std::vector<int>& start, const std::vector<int>& neighbour, int n_parts) {
  const std::size_t n = start.size() - 1;
  std::vector<int> part(n, 0), place(n);
  if (n_parts <= 1 || n == 0) return part;
  for (const std::vector<int>& vertices : components_of(start, neighbour, n_parts)) {
    std::vector<int> its_start{0}, its_neighbour;
    for (std::size_t i = 0; i < vertices.size(); ++i) place[vertices[i]] = static_cast<int>(i);
    for (const int v : vertices) {
      for (int k = start[v]; k < start[v + 1]; ++k) its_neighbour.push_back(place[neighbour[k]]);
      its_start.push_back(static_cast<int>(its_neighbour.size()));
    }
    const std::vector<int> its_part = cut(std::move(its_start), std::move(its_neighbour), n_parts);
    for (std::size_t i = 0; i < vertices.size(); ++i) part[vertices[i]] = its_part[i];
  }
  return part;
}

}  // namespace snag
