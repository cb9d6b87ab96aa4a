#pragma once
// A pressure inlet and an outlet whose pressure floats until the flow is the one that is asked for.
#include <gtest/gtest.h>

#include "solver/monitors.hpp"
#include "tests/verification/solver/channel.hpp"

namespace snag::test::tank_and_outlet {

inline constexpr double dt = 0.02, target = 0.8;

/// A channel between a tank and an outlet; `outlet`: more keys of the outlet.
inline std::string from_tank(const std::string& outlet) { return channel("kind = \"pressure_inlet\"\npressure_Pa = 3", outlet); }

inline Mesh tetrahedra() { return channel_mesh(3); }

inline FlowSettings settings() { return channel_settings(0.02); }

/// Flow through x1 over its target after each of `steps` steps.
inline std::vector<double> share_of_target(FlowSolver& solver, int steps) {
  std::vector<double> share;
  for (int i = 0; i < steps; ++i) {
    solver.advance(dt);
    share.push_back(flow_rate(solver.flow, solver.flow.mesh.patch_index("x1")) / target);
  }
  return share;
}

inline double largest(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }
inline double smallest(const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); }

inline void print(const char* what, const std::vector<double>& share, double end) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank > 0) return;
  std::size_t settled = share.size();
  while (settled > 0 && std::abs(share[settled - 1] - end) < 1e-2) --settled;
  std::printf("%s: lowest %.4f, highest %.4f, within 1 %% from step %zu on, last %.3e off\n", what, smallest(share), largest(share),
              settled + 1, share.back() - end);
}

}  // namespace snag::test::tank_and_outlet
