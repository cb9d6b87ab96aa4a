#pragma once
// The other program that a benchmark is held against: OpenFOAM of the Debian package, by the script benchmark/speed/openfoam.py, which
// travels inside the program.
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace snag {

/// Settings of both programs: SI units, rad/s.
struct PeerFlowCase {
  std::filesystem::path mesh, folder;
  int ranks = 1, n_warm_up = 2, n_steps = 8;
  double time_step = 1e-4, flow_rate = 0, speed = 0, kinematic_viscosity = 0;
};

/// Numbers of one equation in a step.
struct PeerEquation {
  double iterations = 0;  // a step
  double drop = 1;        // final over initial residual, geometric mean
};

struct PeerFlow {
  std::string program;            // "OpenFOAM 1912"
  std::vector<double> wall, cpu;  // s of each step, on the clock and of one rank's processor
  PeerEquation momentum, pressure, k, epsilon;
};

/// The first rank works while the others sleep: a barrier of MPI would keep their processors busy. An error is one of all ranks.
/// Collective.
void first_rank_alone(const std::function<void()>& work);

/// What LAMMPS did with a sheet of bonded spheres, on one processor.
struct PeerSheet {
  std::string program;
  double million_particle_steps_per_s = 0;  // of processor time
};
/// By the script benchmark/speed/lammps.py in `folder`; none where the Debian package lammps is not installed. The first rank only; throws
/// Error(io).
std::optional<PeerSheet> run_peer_sheet(const std::filesystem::path& folder, int n_columns, int n_rows, int n_steps);

/// Throws Error(usage) that names the package where the program is missing. Collective.
void require_peer();
/// Rank 0 runs it, as an MPI job of its own; the others sleep. The same result on every rank. Collective; throws Error(io).
PeerFlow run_peer(const PeerFlowCase& flow_case);

}  // namespace snag
