// The case: a rag of 16,500 particles stands across a stream of 1 m/s in a duct of tetrahedra of 9 mm, two-way coupled, steps of 0.4 ms:
// the cloth, the cells and the steps of a pump run without its machine. Each kernel by turns, and the rag by itself with the same drag in a
// stream that is prescribed.
//
// The transfers by themselves: the crumpled rag of 16,500 particles in the mesh of the pump, half of it in the eye of the impeller, a
// kernel of 4 mm: cells and weights of all particles, average of the fields that the recommended forces read, spread of reaction and solid
// fraction.
//
// Coupling is what neither water nor cloth would do alone, but for the drag inside the sub-steps, which belongs to the cloth's time: cells
// of the particles, water at them, reaction of the rag spread by the kernel, exchange between ranks.
#include "benchmark/speed/coupling.hpp"

#include <algorithm>
#include <iostream>
#include <optional>
#include <utility>
#include <vector>

#include "base/flat.hpp"
#include "base/log.hpp"
#include "base/words.hpp"
#include "benchmark/speed/bench_mesh.hpp"
#include "benchmark/speed/record.hpp"
#include "coupling/kernel.hpp"
#include "dem/particles/tile_particles.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"
#include "simulation/setup/simulation.hpp"

namespace snag {

namespace {

const MPI_Comm world = MPI_COMM_WORLD;
constexpr int n_warm_up = 2;
constexpr double transfers_width = 4e-3, transfers_limit = 0.09;  // m, processor seconds a step

/// A rag that stands across the stream along x.
std::string rag_and_time(bool quick) {
  return std::string("[time]\nend_s = 1\nstep_ms = 0.4\n[[rag]]\nradius_mm = ") + (quick ? "2" : "1") + R"(
density_model = "jensen_2018"
pose = "flat"
centre_m = [0.08, 0.13, 0.17]
lengthwise = [0, 0, 1]
crosswise = [0.05, 1, 0]
[coupling]
forces = ["free_stream_drag"]
)";
}

std::string in_a_duct(const std::filesystem::path& mesh, const std::string& kernel, bool quick) {
  return "[mesh]\nfile = \"" + mesh.string() + "\"\n" + rag_and_time(quick) + "mode = \"two_way\"\n" + kernel + R"(
[flow]
initial_velocity_m_s = [1, 0, 0]
pressure_tolerance = 1e-4
momentum_tolerance = 1e-5
[[boundary]]
patch = "inlet"
kind = "velocity_inlet"
velocity_m_s = [1, 0, 0]
[[boundary]]
patch = "outlet"
kind = "pressure_outlet"
[[boundary]]
patches = ["bottom", "top", "side_z0", "side_z1"]
kind = "symmetry"
)";
}

std::string in_a_prescribed_stream(bool quick) {
  return rag_and_time(quick) + "mode = \"one_way\"\n[flow]\nkind = \"prescribed\"\nvelocity_m_s = [1, 0, 0]\n";
}

/// Means over the timed steps, s of the slowest rank.
struct Timed {
  double step = 0, flow = 0, rags = 0, coupling = 0;
  double exchange = 0;  // largest loss of momentum in the exchange, 1
  double n_particles = 0, n_sub_steps = 0, n_cells = 0;
};

Timed timed(const std::string& text, int n_steps) {
  Simulation run(CaseFile::parse(text, "bench"), world);
  run.start();
  Timed found{.n_particles = static_cast<double>(run.rags->n_particles()),
              .n_cells = run.mesh ? static_cast<double>(run.mesh->n_cells_global) : 0};
  Simulation::Seconds before;
  double begun = 0;
  std::int64_t sub_steps = 0;
  for (int step = -n_warm_up; step < n_steps; ++step) {
    if (step == 0) {
      before = run.seconds(), sub_steps = run.rags->n_sub_steps();
      MPI_Barrier(world);
      begun = MPI_Wtime();
    }
    run.step();
    found.exchange = std::max(found.exchange, run.coupled->report().momentum_exchange);
  }
  found.step = maximum(world, MPI_Wtime() - begun) / n_steps;
  const Simulation::Seconds after = run.seconds();
  found.flow = (after.flow - before.flow) / n_steps, found.rags = (after.rags - before.rags) / n_steps;
  found.coupling = (after.coupling - before.coupling) / n_steps;
  found.n_sub_steps = static_cast<double>(run.rags->n_sub_steps() - sub_steps) / n_steps;
  return found;
}

std::string in_a_pump(const std::filesystem::path& mesh, bool quick) {
  return "[mesh]\nfile = \"" + mesh.string() +
         "\"\n[rotating_zone]\nzone = \"rotor\"\nrotation_speed_rpm = 1200\n[time]\nend_s = 1\nstep_ms = 0.1\n[[rag]]\nradius_mm = " +
         (quick ? "2" : "1") + R"(
density_model = "jensen_2018"
pose = "confined"
confine_radius_mm = 25
confine_length_mm = 280
centre_m = [0, 0, 0.19]
lengthwise = [0, 0, 1]
crosswise = [1, 0, 0]
[coupling]
mode = "one_way"
kernel = "cell"
forces = ["free_stream_drag"]
[flow]
[[boundary]]
patch = "inlet"
kind = "flow_rate_inlet"
flow_rate_L_s = 26.8
[[boundary]]
patch = "outlet"
kind = "pressure_outlet"
[[boundary]]
patches = ["impeller_walls", "casing_walls"]
kind = "wall"
)";
}

/// Means over the repetitions, s of the slowest rank.
struct Transfers {
  double locate = 0, average = 0, spread = 0;
  double n_particles = 0, n_cells = 0;
};

Transfers transfers(const std::string& text, int n_steps) {
  Simulation run(CaseFile::parse(text, "bench"), world);
  run.start();
  run.step();  // brings the particles to the ranks of their cells
  std::vector<Vec3> places;
  for (const Tile& tile : run.rags->tiles()) for_particles(tile, [&](int k, int, int) { places.push_back(tile.vector(Tile::x, k)); });
  const auto shape = kernel_shapes().make("gaussian", "bench");
  Kernel kernel(*shape, transfers_width, *run.mesh);
  Flow& flow = run.water->flow;
  std::vector<double> amounts(4 * places.size(), 1.0), fraction(run.mesh->n_cells, 0.0);
  std::vector<Vec3> reaction(run.mesh->n_cells);
  const std::vector<CellField> fields{{flat(flow.velocity).data(), 3},
                                      {flat(flow.velocity).data(), 3},
                                      {flat(flow.velocity).data(), 3},
                                      {flat(flow.pressure_gradient).data(), 3},
                                      {flat(run.mesh->cell_centre).data(), 3},
                                      {fraction.data(), 1},
                                      {fraction.data(), 1},
                                      {flat(flow.velocity_gradient).data(), 9}};
  const std::vector<CellSums> sums{{fraction.data(), 1}, {flat(reaction).data(), 3}};
  Transfers found{.n_particles = static_cast<double>(run.rags->n_particles()), .n_cells = static_cast<double>(run.mesh->n_cells_global)};
  const auto add = [&](double& seconds, const auto& work) {
    MPI_Barrier(world);
    const double begun = MPI_Wtime();
    work();
    seconds += maximum(world, MPI_Wtime() - begun) / n_steps;
  };
  kernel.locate(places);
  for (int step = 0; step < n_steps; ++step) {
    add(found.locate, [&] { kernel.locate(places); });
    add(found.average, [&] { kernel.average(fields); });
    add(found.spread, [&] { kernel.spread(amounts, sums); });
  }
  return found;
}

class Findings {
 public:
  void add(const std::string& name, double value, const char* unit, const std::string& note, std::optional<double> limit = {}) {
    records.push_back({.name = "coupling." + name, .value = value, .unit = unit, .ranks = size_of(world), .limit = limit, .note = note});
  }

  void add_kernel(const std::string& name, const Timed& t) {
    add(name + "_step", t.step, "s",
        "coupled step: water of " + number_text(t.n_cells) + " cells, rag of " + number_text(t.n_particles) + " particles");
    add(name + "_flow", t.flow, "s", "of it the water");
    add(name + "_rags", t.rags, "s", "of it the cloth with its drag, " + number_text(t.n_sub_steps) + " sub-steps");
    add(name + "_coupling", t.coupling, "s", "of it the coupling");
    add(name + "_share", t.coupling / t.step, "1", "of the coupling in the step");
    add(name + "_per_particle", 1e6 * t.coupling / t.n_particles, "us", "coupling, a particle and step");
    add(name + "_exchange", t.exchange, "1", "momentum lost in the exchange over what was exchanged, largest", 1e-10);
  }

  void add_transfers(const Transfers& t) {
    add("transfers_locate", t.locate, "s",
        "cells and weights of " + number_text(t.n_particles) + " particles, Gaussian of " + number_text(1e3 * transfers_width) +
            " mm, pump of " + number_text(t.n_cells) + " cells");
    add("transfers_average", t.average, "s", "26 components, water -> particles");
    add("transfers_spread", t.spread, "s", "4 components, particles -> water");
    add("transfers", (t.locate + t.average + t.spread) * size_of(world), "s", "the three, all ranks", transfers_limit);
  }

  std::vector<BenchRecord> records;
};

}  // namespace

ExitCode bench_coupling(const CouplingBenchOptions& options) {
  if (options.n_steps < 1) throw Error(ExitCode::usage, "--steps " + std::to_string(options.n_steps) + ": at least 1 is needed");
  if (options.peer && rank_of(world) == 0)
    log::warning("bench: no program of Debian couples bonded cloth and unresolved water; Snag alone is timed");
  const auto mesh = bench_mesh(options.out, options.quick ? "small_duct" : "duct",
                               {"channel", "--set", "length_mm=200", "height_mm=260", "width_mm=340", "cells=\"tetrahedra\"",
                                options.quick ? "size_mm=15" : "size_mm=9", "wall_ratio=1"});
  Findings findings;
  const std::pair<const char*, const char*> kernels[] = {{"cell", "kernel = \"cell\""},
                                                         {"gaussian", "kernel = \"gaussian\"\nkernel_width_mm = 6"},
                                                         {"wendland", "kernel = \"wendland\"\nkernel_width_mm = 6"}};
  for (const auto& [name, settings] : kernels) {
    log::info("bench: kernel " + std::string(name));
    findings.add_kernel(name, timed(in_a_duct(mesh, settings, options.quick), options.n_steps));
  }
  log::info("bench: transfers in a pump");
  const std::string level = options.quick ? "coarse" : "medium";
  findings.add_transfers(
      transfers(in_a_pump(bench_mesh(options.out, "pump_" + level, {"pump", "--set", "resolution=\"" + level + "\""}), options.quick),
                options.n_steps));
  log::info("bench: rag in a prescribed stream");
  const Timed alone = timed(in_a_prescribed_stream(options.quick), options.n_steps);
  findings.add("rag_in_prescribed_flow", 1e-6 * alone.n_particles * alone.n_sub_steps / alone.step, "M/s",
               "million particle-steps a second with drag, on the clock, all ranks");
  on_all_ranks(world, [&] {
    if (rank_of(world) != 0) return;
    write_bench(options.out / "bench.json", findings.records);
    std::cout << bench_table(findings.records) << (options.out / "bench.json").string() << std::endl;
  });
  return ExitCode::ok;
}

}  // namespace snag
