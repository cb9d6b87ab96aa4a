// The case: the parametric single-vane pump at its design flow, k-epsilon, 1200 rpm. Twenty steps in the turning frame give a flow, then
// the mesh slides by 0.72 degrees a step: some steps to settle, then those that are timed.
//
// What is compared is an equal number of outer corrections a step: two, each of one momentum equation, two pressure equations (one repeated
// for the non-orthogonal mesh) and k and epsilon, second order in time, linear-upwind convection with limited gradients. The other program
// reduces its residuals to 0.01 of their first values; that of the pressure to 0.05, in the last correction to 0.01, in each repetition.
// Snag's tolerances are chosen so that each residual drops at least as far. The table has the drops of both programs. k and epsilon are
// solved until they change by 1e-5 in a sweep.
#include "benchmark/speed/flow.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <numbers>
#include <numeric>

#include "base/log.hpp"
#include "base/memory.hpp"
#include "base/words.hpp"
#include "benchmark/speed/bandwidth.hpp"
#include "benchmark/speed/bench_mesh.hpp"
#include "benchmark/speed/peer.hpp"
#include "benchmark/speed/record.hpp"
#include "benchmark/speed/traffic.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"
#include "simulation/output/summary.hpp"
#include "simulation/setup/simulation.hpp"

namespace snag {

namespace {

const MPI_Comm world = MPI_COMM_WORLD;

constexpr double speed_rpm = 1200, design_flow = 0.0268, kinematic_viscosity = 1.0048e-6;  // 1/min, m3/s, m2/s
constexpr double frame_step = 5e-4, frame_ramp = 8e-3, sliding_step = 1e-4;                // s
constexpr int n_frame_steps = 20, n_warm_up = 2;

const char* const compared = "equal outer corrections a step; Snag's residuals are to drop at least as far (flow.*_drop)";

std::string case_text(const std::filesystem::path& mesh, const std::string& motion, double step, double ramp) {
  std::string text = "[case]\nname = \"bench-flow\"\n[mesh]\nfile = \"" + mesh.string() + "\"\n";
  text += "[rotating_zone]\nzone = \"rotor\"\nrotation_speed_rpm = " + number_text(speed_rpm) + "\nramp_s = " + number_text(ramp) +
          "\nmotion = \"" + motion + "\"\n";
  text += "[time]\nend_s = 1\nstep_s = " + number_text(step) + "\n";
  text += "[flow]\nkinematic_viscosity_m2_s = " + number_text(kinematic_viscosity) + R"(
n_outer_correctors = 2
n_non_orthogonal_correctors = 1
momentum_tolerance = 6e-7
pressure_tolerance = 1.6e-3
[turbulence]
model = "k_epsilon"
tolerance = 7e-6
initial_k_m2_s2 = 0.044
initial_epsilon_m2_s3 = 0.21
[[boundary]]
patch = "inlet"
kind = "flow_rate_inlet"
flow_rate_m3_s = )" +
          number_text(design_flow) + "\nramp_s = " + number_text(ramp) + R"(
[[boundary]]
patch = "outlet"
kind = "pressure_outlet"
[[boundary]]
patches = ["impeller_walls", "casing_walls"]
kind = "wall"
)";
  return text;
}

/// Fields of the owned cells.
struct Start {
  std::vector<std::int64_t> cell_id;
  std::vector<Vec3> velocity;
  std::vector<double> pressure, k, epsilon;
};

Start flow_in_the_frame(const std::filesystem::path& mesh) {
  Simulation frame(CaseFile::parse(case_text(mesh, "frame", frame_step, frame_ramp), "bench"), world);
  log::info("bench: " + std::to_string(frame.mesh->n_cells_global) + " cells; " + std::to_string(n_frame_steps) +
            " steps in the turning frame");
  for (int step = 0; step < n_frame_steps; ++step) frame.step();
  const Flow& flow = frame.water->flow;
  return {flow.mesh.cell_id, flow.velocity, flow.pressure, flow.turbulent_kinetic_energy, flow.dissipation_rate};
}

/// Both meshes come from one file on the same ranks, so that cells have the same places.
void begin_with(const Start& start, Flow& flow) {
  const auto n = static_cast<std::ptrdiff_t>(flow.mesh.n_cells);
  on_all_ranks(world, [&] {
    if (!std::equal(flow.mesh.cell_id.begin(), flow.mesh.cell_id.begin() + n, start.cell_id.begin()))
      throw Error(ExitCode::invariant, "bench: the mesh was read in another order the second time; please report this");
  });
  const auto copy = [&](const auto& from, auto& to) { std::copy(from.begin(), from.begin() + n, to.begin()); };
  copy(start.velocity, flow.velocity), copy(start.pressure, flow.pressure);
  copy(start.k, flow.turbulent_kinetic_energy), copy(start.epsilon, flow.dissipation_rate);
}

double processor_seconds() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// Memory that all ranks hold now, bytes; pages that they share, of libraries, count once. Collective.
double memory_held() {
  std::ifstream pages("/proc/self/smaps_rollup");
  double held = 0;  // kB
  for (std::string word; pages >> word;)
    if (word == "Pss:") pages >> held;
  return sum(world, 1024 * held);
}

struct Timed {
  double wall = 0, cpu = 0;  // s, of the slowest rank, of the first
  StepReport did;
};

struct Steps {
  std::vector<Timed> steps;
  double n_cells = 0, n_faces = 0;  // of all ranks, mean over the steps
  double courant_max = 0, courant_mean = 0;
  double import_wall = 0, memory = 0;  // s, bytes
};

Steps sliding_steps(const std::filesystem::path& mesh, int n_steps) {
  Start start = flow_in_the_frame(mesh);
  return_free_memory();  // what is measured below is that of one simulation
  MPI_Barrier(world);
  const double import_begun = MPI_Wtime();
  Simulation sliding(CaseFile::parse(case_text(mesh, "sliding", sliding_step, 0), "bench"), world);
  Steps found;
  found.import_wall = maximum(world, MPI_Wtime() - import_begun);
  FlowSolver& water = *sliding.water;
  begin_with(start, water.flow);
  start = {};
  water.keep_balances(water.flow.rotating_zone->origin(), water.flow.rotating_zone->axis());
  log::info("bench: " + std::to_string(n_warm_up) + " sliding steps to settle, " + std::to_string(n_steps) + " timed");
  found.n_cells = static_cast<double>(sliding.mesh->n_cells_global);
  for (int step = -n_warm_up; step < n_steps; ++step) {
    MPI_Barrier(world);
    const double begun = MPI_Wtime(), cpu_begun = processor_seconds();
    Timed one{.did = water.advance(sliding_step)};
    one.cpu = processor_seconds() - cpu_begun;
    one.wall = maximum(world, MPI_Wtime() - begun);
    MPI_Bcast(&one.cpu, 1, MPI_DOUBLE, 0, world);
    if (step < 0) continue;
    found.steps.push_back(one);
    found.n_faces += sum(world, static_cast<double>(sliding.mesh->n_interior)) / n_steps;
  }
  found.memory = memory_held();
  found.courant_max = found.steps.back().did.courant_max, found.courant_mean = found.steps.back().did.courant_mean;
  return found;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Mean over the steps of a number of a step.
template <class Number>
double mean(const Steps& steps, const Number& number) {
  double total = 0;
  for (const Timed& step : steps.steps) total += number(step);
  return total / static_cast<double>(steps.steps.size());
}

/// The same of a number of each outer correction, summed over a step.
template <class Number>
double mean_of_outer(const Steps& steps, const Number& number) {
  return mean(steps, [&](const Timed& step) {
    double total = 0;
    for (const OuterReport& outer : step.did.outer) total += number(outer);
    return total;
  });
}

/// Geometric mean of final over initial residual of all outer corrections.
template <class Residuals>
double mean_drop(const Steps& steps, const Residuals& residuals) {
  double logarithms = 0;
  int n = 0;
  for (const Timed& step : steps.steps)
    for (const OuterReport& outer : step.did.outer) {
      const auto& [initial, final] = residuals(outer);
      if (initial > 0 && final > 0) logarithms += std::log(final / initial), ++n;
    }
  return n > 0 ? std::exp(logarithms / n) : 1;
}

/// All numbers of the benchmark.
class Findings {
 public:
  Findings(const Steps& steps, double bandwidth, const std::optional<PeerFlow>& peer)
      : steps_(steps), bandwidth_(bandwidth), peer_(peer), ranks_(size_of(world)) {}

  std::vector<BenchRecord> records() {
    clocks();
    equations();
    solves();
    return std::move(records_);
  }

 private:
  /// Adds a record; `of_peer` is a function of PeerFlow, or none.
  template <class OfPeer>
  void add(const char* name, double value, const char* unit, std::optional<double> limit, const char* note, const OfPeer& of_peer) {
    BenchRecord record{.name = name, .value = value, .unit = unit, .ranks = ranks_, .limit = limit, .note = note};
    if constexpr (!std::is_null_pointer_v<OfPeer>)
      if (peer_) record.peer = peer_->program, record.peer_value = of_peer(*peer_);
    records_.push_back(record);
  }

  void clocks() {
    std::vector<double> wall, cpu;
    for (const Timed& step : steps_.steps) wall.push_back(step.wall), cpu.push_back(step.cpu);
    const double per_cell = 1e6 / steps_.n_cells;  // us
    const double limit = mean(steps_, [&](const Timed& step) { return traffic(step).total(); }) / bandwidth_;
    const auto lowest = [](const std::vector<double>& v) { return *std::min_element(v.begin(), v.end()); };
    const auto highest = [](const std::vector<double>& v) { return *std::max_element(v.begin(), v.end()); };
    add("flow.step", median(wall), "s", limit, compared, [](const PeerFlow& peer) { return median(peer.wall); });
    add("flow.step_mean", mean(wall), "s", limit, "with the set-ups of the preconditioner that fell into the timed steps",
        [](const PeerFlow& peer) { return mean(peer.wall); });
    add("flow.step_lowest", lowest(wall), "s", limit, "of the timed steps", [&](const PeerFlow& peer) { return lowest(peer.wall); });
    add("flow.step_highest", highest(wall), "s", limit, "of the timed steps", [&](const PeerFlow& peer) { return highest(peer.wall); });
    add("flow.step_cpu", median(cpu), "s", {}, "processor time of the first rank; to be trusted more on a busy machine",
        [](const PeerFlow& peer) { return median(peer.cpu); });
    add("flow.step_per_cell", median(wall) * per_cell, "us", limit * per_cell, "flow.step over the cells of the mesh",
        [&](const PeerFlow& peer) { return median(peer.wall) * per_cell; });
  }

  void equations() {
    equation(
        "momentum", [](const StepReport& did) { return did.seconds_momentum; }, [](const Traffic& t) { return t.momentum; });
    equation(
        "pressure", [](const StepReport& did) { return did.seconds_pressure; }, [](const Traffic& t) { return t.pressure; });
    equation(
        "turbulence", [](const StepReport& did) { return did.seconds_turbulence; }, [](const Traffic& t) { return t.turbulence; });
    equation(
        "rest", [](const StepReport& did) { return did.seconds_rest - did.seconds_mesh; }, [](const Traffic& t) { return t.rest; });
    add("flow.mesh_motion", seconds([](const StepReport& did) { return did.seconds_mesh; }), "s", {},
        "turning the mesh, its facets, matrices and gradients; bound by computing", nullptr);
    add("machine.bandwidth", 1e-9 * bandwidth_, "GB/s", {}, "triad on all ranks, in this process", nullptr);
  }

  template <class Seconds, class Bytes>
  void equation(const std::string& name, const Seconds& seconds_of, const Bytes& bytes_of) {
    const double spent = seconds(seconds_of), bytes = mean(steps_, [&](const Timed&step) { return bytes_of(traffic(step)); });
    add(("flow." + name).c_str(), spent, "s", bytes / bandwidth_, "a step, mean of the ranks", nullptr);
    add(("flow." + name + "_traffic").c_str(), 1e-6 * bytes, "MB", {}, "a step, estimated from the arrays of each loop", nullptr);
    add(("flow." + name + "_share").c_str(), bytes / bandwidth_ / spent, "1", 1, "of the bandwidth, by that estimate", nullptr);
  }

  static std::pair<double, double> drop_of(const OuterReport& outer, std::string_view symbol) {
    const SweepReport sweeps = outer.turbulence.of(symbol);
    return {sweeps.initial, sweeps.final};
  }
  void solves() {
    const auto number = [&](const auto& of) { return mean_of_outer(steps_, of); };
    add("flow.momentum_sweeps", number([](const OuterReport& outer) { return outer.momentum.sweeps; }), "1", {}, "Gauss-Seidel, a step",
        [](const PeerFlow& peer) { return peer.momentum.iterations; });
    add("flow.pressure_iterations", number([](const OuterReport& outer) { return outer.continuity.iterations; }), "1", {},
        "cycles of multigrid, a step; those of the peer's correction of the fluxes too",
        [](const PeerFlow& peer) { return peer.pressure.iterations; });
    add("flow.pressure_setups", number([](const OuterReport& outer) { return outer.continuity.rebuilt ? 1 : 0; }), "1", {},
        "of the preconditioner, a step", nullptr);
    add("flow.k_sweeps", number([](const OuterReport& outer) { return outer.turbulence.of("k").sweeps; }), "1", {}, "a step",
        [](const PeerFlow& peer) { return peer.k.iterations; });
    add("flow.epsilon_sweeps", number([](const OuterReport& outer) { return outer.turbulence.of("epsilon").sweeps; }), "1", {}, "a step",
        [](const PeerFlow& peer) { return peer.epsilon.iterations; });
    const char* const drop = "final over initial residual of an outer correction, geometric mean";
    add("flow.momentum_drop", mean_drop(steps_, [](const OuterReport& o) { return std::pair(o.momentum.initial, o.momentum.final); }), "1",
        {}, drop, [](const PeerFlow& peer) { return peer.momentum.drop; });
    add("flow.pressure_drop", mean_drop(steps_, [](const OuterReport& o) { return std::pair(o.continuity.initial, o.continuity.final); }),
        "1", {}, drop, [](const PeerFlow& peer) { return peer.pressure.drop; });
    add("flow.k_drop", mean_drop(steps_, [](const OuterReport& o) { return drop_of(o, "k"); }), "1", {}, drop,
        [](const PeerFlow& peer) { return peer.k.drop; });
    add("flow.epsilon_drop", mean_drop(steps_, [](const OuterReport& o) { return drop_of(o, "epsilon"); }), "1", {}, drop,
        [](const PeerFlow& peer) { return peer.epsilon.drop; });
    add("flow.courant_max", steps_.courant_max, "1", {}, "of the last step", nullptr);
    add("flow.courant_mean", steps_.courant_mean, "1", {}, "of the last step", nullptr);
    add("flow.cells", steps_.n_cells, "1", {}, "", nullptr);
    add("flow.import", steps_.import_wall, "s", {}, "reading the mesh, distributing it and setting up", nullptr);
    add("flow.memory", 1e-3 * steps_.memory / steps_.n_cells, "kB", {}, "of all ranks for a cell, after the last step", nullptr);
    add("flow.memory_peak", 1e-3 * static_cast<double>(peak_memory()) / steps_.n_cells, "kB", {},
        "of all ranks for a cell, in the whole run", nullptr);
  }

  Traffic traffic(const Timed& step) const { return traffic_of(step.did, steps_.n_cells, steps_.n_faces); }
  template <class Seconds>
  double seconds(const Seconds& of) const {
    return sum(world, mean(steps_, [&](const Timed& step) { return of(step.did); })) / ranks_;
  }

  const Steps& steps_;
  double bandwidth_;
  const std::optional<PeerFlow>& peer_;
  int ranks_;
  std::vector<BenchRecord> records_;
};

void check(const FlowBenchOptions& options) {
  if (options.level != "coarse" && options.level != "medium" && options.level != "fine")
    throw Error(ExitCode::usage, "--level \"" + options.level + "\": unknown; known: coarse, medium, fine");
  if (options.n_steps < 1) throw Error(ExitCode::usage, "--steps " + std::to_string(options.n_steps) + ": at least 1 is needed");
  if (options.peer) require_peer();
}

}  // namespace

ExitCode bench_flow(const FlowBenchOptions& options) {
  check(options);
  const auto mesh = bench_mesh(options.out, "pump_" + options.level, {"pump", "--set", "resolution=\"" + options.level + "\""});
  const double bandwidth = triad_bandwidth(world);
  const Steps steps = sliding_steps(mesh, options.n_steps);
  std::optional<PeerFlow> peer;
  if (options.peer) {
    log::info("bench: OpenFOAM on the same mesh and ranks");
    peer = run_peer({.mesh = mesh,
                     .folder = std::filesystem::absolute(options.out) / "peer",
                     .ranks = size_of(world),
                     .n_warm_up = n_warm_up,
                     .n_steps = options.n_steps,
                     .time_step = sliding_step,
                     .flow_rate = design_flow,
                     .speed = speed_rpm * 2 * std::numbers::pi / 60,
                     .kinematic_viscosity = kinematic_viscosity});
  }
  const auto records = Findings(steps, bandwidth, peer).records();
  on_all_ranks(world, [&] {
    if (rank_of(world) != 0) return;
    write_bench(options.out / "bench.json", records);
    std::cout << bench_table(records) << "Compared: " << compared << ". limit: memory bandwidth. ratio: value over peer.\n"
              << (options.out / "bench.json").string() << std::endl;
  });
  return ExitCode::ok;
}

}  // namespace snag
