#include "benchmark/speed/peer.hpp"

#include <unistd.h>

#include <charconv>
#include <exception>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/atomic_file.hpp"
#include "base/child_process.hpp"
#include "base/error.hpp"
#include "base/words.hpp"
#include "benchmark/speed/peer_script.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

const MPI_Comm world = MPI_COMM_WORLD;
constexpr auto nap = std::chrono::milliseconds(100);

std::string written(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

PeerEquation equation(const nlohmann::json& found, const char* name) {
  const auto& one = found.at(name);
  return {.iterations = one.at("iterations"), .drop = one.at("drop")};
}

PeerFlow parsed(const std::string& text, const std::filesystem::path& log) {
  try {
    const auto found = nlohmann::json::parse(text);
    return {.program = found.at("program"),
            .wall = found.at("wall_s"),
            .cpu = found.at("cpu_s"),
            .momentum = equation(found, "momentum"),
            .pressure = equation(found, "pressure"),
            .k = equation(found, "k"),
            .epsilon = equation(found, "epsilon")};
  } catch (const nlohmann::json::exception& wrong) {
    throw Error(ExitCode::io, "the other program has left no result (" + std::string(wrong.what()) + "); " + log.string() + " says more");
  }
}

bool in_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  for (const std::string& folder : split(path ? path : "/usr/bin", ':'))
    if (access((folder + "/" + program).c_str(), X_OK) == 0) return true;
  return false;
}

}  // namespace

void first_rank_alone(const std::function<void()>& work) {
  std::exception_ptr failure;
  if (rank_of(world) == 0) {
    try {
      work();
    } catch (...) {
      failure = std::current_exception();
    }
  }
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibarrier(world, &request);
  for (int done = 0; MPI_Test(&request, &done, MPI_STATUS_IGNORE), !done;) std::this_thread::sleep_for(nap);
  on_all_ranks(world, [&] {
    if (failure) std::rethrow_exception(failure);
  });
}

std::optional<PeerSheet> run_peer_sheet(const std::filesystem::path& folder, int n_columns, int n_rows, int n_steps) {
  if (!in_path("lmp")) return {};
  const auto log = folder / "log.txt";
  std::error_code failure;
  std::filesystem::remove_all(folder, failure);
  std::filesystem::create_directories(folder, failure);
  write_atomically(folder / "lammps.py", lammps_script);
  const int code = run_command({"/usr/bin/python3", (folder / "lammps.py").string(), "--out", folder.string(), "--columns",
                                std::to_string(n_columns), "--rows", std::to_string(n_rows), "--steps", std::to_string(n_steps)},
                               log, "install python3");
  if (code != 0) throw Error(ExitCode::io, "LAMMPS ended with code " + std::to_string(code) + "; " + log.string() + " says more");
  try {
    const auto found = nlohmann::json::parse(file_text(folder / "peer.json").value_or(""));
    return PeerSheet{found.at("program"), found.at("million_particle_steps_per_s")};
  } catch (const nlohmann::json::exception& wrong) {
    throw Error(ExitCode::io, "LAMMPS has left no result (" + std::string(wrong.what()) + "); " + log.string() + " says more");
  }
}

void require_peer() {
  on_all_ranks(world, [] {
    if (rank_of(world) == 0 && !in_path("pimpleFoam"))
      throw Error(ExitCode::usage,
                  "--peer: OpenFOAM is not installed (no pimpleFoam in PATH); install the Debian package openfoam (apt-get install "
                  "openfoam), or leave --peer out");
  });
}

PeerFlow run_peer(const PeerFlowCase& flow_case) {
  const auto result = flow_case.folder / "peer.json", log = flow_case.folder / "log.txt";
  std::string text;
  first_rank_alone([&] {
    std::error_code failure;
    std::filesystem::remove_all(flow_case.folder, failure);
    std::filesystem::create_directories(flow_case.folder, failure);
    write_atomically(flow_case.folder / "openfoam.py", peer_script);
    const int code = run_command({"/usr/bin/python3",
                                  (flow_case.folder / "openfoam.py").string(),
                                  "--mesh",
                                  flow_case.mesh.string(),
                                  "--out",
                                  flow_case.folder.string(),
                                  "--ranks",
                                  std::to_string(flow_case.ranks),
                                  "--warm-up",
                                  std::to_string(flow_case.n_warm_up),
                                  "--steps",
                                  std::to_string(flow_case.n_steps),
                                  "--time-step",
                                  written(flow_case.time_step),
                                  "--flow-rate",
                                  written(flow_case.flow_rate),
                                  "--speed",
                                  written(flow_case.speed),
                                  "--viscosity",
                                  written(flow_case.kinematic_viscosity)},
                                 log, "install python3");
    if (code != 0) throw Error(ExitCode::io, "OpenFOAM ended with code " + std::to_string(code) + "; " + log.string() + " says more");
    text = file_text(result).value_or("");
    parsed(text, log);
  });
  int length = static_cast<int>(text.size());
  MPI_Bcast(&length, 1, MPI_INT, 0, world);
  text.resize(static_cast<std::size_t>(length));
  MPI_Bcast(text.data(), length, MPI_CHAR, 0, world);
  return parsed(text, log);
}

}  // namespace snag
