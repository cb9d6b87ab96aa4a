#include "mesh/import/partition.hpp"

#include <scotch/scotch.h>

#include <cstdint>
#include <cstdio>

#include "base/error.hpp"

namespace snag {

static_assert(sizeof(SCOTCH_Num) == sizeof(int), "graphs are handed to SCOTCH as they are");

std::vector<int> partition_graph(std::vector<int> start, std::vector<int> neighbour, int n_parts) {
  const int n = static_cast<int>(start.size()) - 1;
  std::vector<int> part(static_cast<std::size_t>(n), 0);
  if (n_parts <= 1 || n == 0) return part;
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

}  // namespace snag
