// Every case runs on one rank, the others asleep; the speed-up cases also on all ranks. Speeds are million particle-steps a second of user
// processor time, which other programs on the machine blur less than the clock; the clock stands beside it.
//
// A particle owns two bonds. Limits: operations (a bond 366, counted in the law with damping, friction, breakage and half of its particle's
// two directions, a division or root as one; 130 for the motion of a particle and the sums of its bonds) over the multiply-add rate; bytes
// that a sub-step must move (22 numbers read, 21 written) over the triad bandwidth, which binds only where the cloth outgrows the cache.
#include "benchmark/speed/dem.hpp"

#include <algorithm>
#include <iostream>
#include <optional>

#include "base/log.hpp"
#include "benchmark/speed/arithmetic.hpp"
#include "benchmark/speed/bandwidth.hpp"
#include "benchmark/speed/dem_cases.hpp"
#include "benchmark/speed/dem_timing.hpp"
#include "benchmark/speed/peer.hpp"
#include "benchmark/speed/record.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

const MPI_Comm world = MPI_COMM_WORLD;

constexpr double operations_per_bond = 366, operations_per_particle = 130, bytes_per_particle = 8.0 * (22 + 21);
constexpr int columns = 150, rows = 110;  // a rag of 300 x 220 mm

/// Speeds of other programs on the flat sheet and on the stack, million particle-steps a second of a core: measured once on a machine of
/// the same kind (EPYC, Zen 4), with a step of 0.5 us.
struct Published {
  const char *name, *program;
  double flat, stack;  // 0: not measured
};
constexpr Published published[] = {{"bpm_particle", "LAMMPS 2026 BPM, frame particle (published, other run)", 2.5, 1.95},
                                   {"bpm_default", "LAMMPS 2026 BPM, default (published, other run)", 1.45, 1.57},
                                   {"liggghts_bonds", "LIGGGHTS fork with bonds (published, other run)", 4.7, 0}};

class Findings {
 public:
  explicit Findings(double work) : work_(work) {}

  /// Times a case, adds its speed, the same on the clock and its contacts, and returns the timing.
  DemTiming add(const std::string& name, DemBenchCase bench, double limit, const std::string& note) {
    log::info("bench: " + name);
    const int ranks = size_of(bench.rags->comm());
    const DemTiming found = timed(bench, work_, n_repeats);
    records.push_back({.name = name, .value = found.per_core(), .unit = "M/s", .ranks = ranks, .limit = limit, .note = note});
    records.push_back({.name = name + "_wall",
                       .value = found.on_the_clock(),
                       .unit = "M/s",
                       .ranks = ranks,
                       .limit = limit * ranks,
                       .note = "the same on the clock, all ranks"});
    if (found.contacts_per_particle > 0)
      records.push_back({.name = name + "_contacts",
                         .value = found.contacts_per_particle,
                         .unit = "1",
                         .ranks = ranks,
                         .note = "of a particle with others"});
    return found;
  }
  void add_plain(const std::string& name, double value, const char* unit, std::optional<double> limit, const std::string& note) {
    records.push_back({.name = name, .value = value, .unit = unit, .ranks = size_of(world), .limit = limit, .note = note});
  }

  std::vector<BenchRecord> records;

 private:
  static constexpr int n_repeats = 8;
  double work_;  // particle-steps of a repetition
};

struct Limits {
  double computing = 0, memory = 0;  // million particle-steps a second of a core
};

/// On the first rank alone.
void single_rank(Findings& findings, const Limits& limit, bool quick) {
  const MPI_Comm self = MPI_COMM_SELF;
  const double in_memory = std::min(limit.computing, limit.memory);
  findings.add("dem.flat", flat_sheets(self, 1, columns, rows), limit.computing, "16,500 particles in waves, none in contact; target 35");
  findings.add("dem.flat_whole", flat_sheets(self, 1, columns, rows, false), limit.computing, "the same without breakage, as runs have it");
  findings.add("dem.stack", stacked_sheets(self), limit.computing,
               "four layers between two planes, each above the gaps of the next; target 10");
  findings.add("dem.stack_moving", stacked_sheets(self, 3, 60), limit.computing, "the same carried along at 3 m/s and turned at 60 rad/s");
  findings.add("dem.flat_4k", flat_sheets(self, 1, 75, 55), limit.computing, "4 thousand particles");
  if (quick) return;
  findings.add("dem.flat_66k", flat_sheets(self, 1, 2 * columns, 2 * rows), limit.computing, "66 thousand particles");
  findings.add("dem.flat_264k", flat_sheets(self, 1, 4 * columns, 4 * rows), in_memory, "264 thousand particles");
  findings.add("dem.flat_1600k", flat_sheets(self, 1, 10 * columns, 10 * rows), in_memory, "1.65 million particles in one sheet");
  findings.add("dem.hundred", flat_sheets(self, 100, columns, rows), in_memory, "100 sheets, 1.65 million particles; target 25");
}

double value_of(const std::vector<BenchRecord>& records, const std::string& name) {
  const auto found = std::find_if(records.begin(), records.end(), [&](const BenchRecord& r) { return r.name == name; });
  return found == records.end() ? 0 : found->value;
}

/// How cost changes with size: the dearest over the cheapest particle-step.
void add_spread(Findings& findings) {
  double low = infinity, high = 0;
  for (const char* name : {"dem.flat", "dem.flat_4k", "dem.flat_66k", "dem.flat_264k", "dem.flat_1600k"})
    if (const double speed = value_of(findings.records, name); speed > 0) low = std::min(low, speed), high = std::max(high, speed);
  findings.add_plain("dem.cost_spread", high / low, "1", {}, "dearest over cheapest particle-step of the flat sheets; target 1.2");
}

void add_peers(Findings& findings, const std::optional<PeerSheet>& lammps) {
  const auto compare = [&](const std::string& name, const char* of, const std::string& program, double peer) {
    if (peer <= 0) return;
    findings.records.push_back({.name = name,
                                .value = value_of(findings.records, of),
                                .unit = "M/s",
                                .peer = program,
                                .peer_value = peer,
                                .note = std::string(of) + " beside it"});
  };
  if (lammps) compare("dem.flat_lammps_beads", "dem.flat", lammps->program, lammps->million_particle_steps_per_s);
  for (const Published& other : published) {
    compare(std::string("dem.flat_") + other.name, "dem.flat", other.program, other.flat);
    compare(std::string("dem.stack_") + other.name, "dem.stack", other.program, other.stack);
  }
}

void all_ranks(Findings& findings, const Limits& limit, bool quick) {
  const std::string on = "_on_" + std::to_string(size_of(world));
  const auto compare = [&](const std::string& name, DemBenchCase bench, double case_limit) {
    const DemTiming many = findings.add(name + on, std::move(bench), case_limit, "on all ranks");
    double alone = value_of(findings.records, name + "_wall");
    MPI_Bcast(&alone, 1, MPI_DOUBLE, 0, world);
    findings.add_plain(name + "_speedup", many.on_the_clock() / alone, "1", size_of(world),
                       "on the clock, over one rank; needs a quiet machine");
  };
  compare("dem.flat", flat_sheets(world, 1, columns, rows), limit.computing);
  if (!quick) compare("dem.hundred", flat_sheets(world, 100, columns, rows), std::min(limit.computing, limit.memory));
}

}  // namespace

ExitCode bench_dem(const DemBenchOptions& options) {
  Findings findings(options.quick ? 1.5e5 : 2e6);
  std::optional<PeerSheet> lammps;
  Limits limit;
  const double bandwidth = triad_bandwidth(MPI_COMM_WORLD), n = size_of(world), rate = multiply_add_rate();
  limit.computing = 1e-6 * rate / (2 * operations_per_bond + operations_per_particle);
  limit.memory = 1e-6 * bandwidth / n / bytes_per_particle;
  first_rank_alone([&] {
    std::error_code failure;
    std::filesystem::create_directories(options.out, failure);
    if (failure)
      throw Error(ExitCode::io,
                  options.out.string() + ": the output folder cannot be made (" + failure.message() + "); choose another --out");
    single_rank(findings, limit, options.quick);
    if (!options.peer) return;
    log::info("bench: LAMMPS");
    lammps = run_peer_sheet(std::filesystem::absolute(options.out) / "peer", columns, rows, 200);
    if (!lammps) log::warning("bench: LAMMPS is not installed (Debian package lammps); published figures only");
  });
  if (n > 1) all_ranks(findings, limit, options.quick);
  if (rank_of(world) == 0) add_spread(findings);
  const double flat = value_of(findings.records, "dem.flat");
  findings.add_plain("dem.bond_operations", operations_per_bond, "1", {}, "of a bond, counted in its law");
  findings.add_plain("dem.bond_bytes", bytes_per_particle / 2, "B", {}, "of a bond, where the cloth outgrows the cache");
  findings.add_plain("dem.operation_rate", 1e-3 * flat * (2 * operations_per_bond + operations_per_particle), "GFlop/s", 1e-9 * rate,
                     "of dem.flat; limit: multiply-adds of one processor");
  findings.add_plain("dem.traffic", 1e-3 * value_of(findings.records, "dem.hundred") * bytes_per_particle, "GB/s", 1e-9 * bandwidth / n,
                     "of dem.hundred; limit: triad, a rank's share");
  if (options.peer) add_peers(findings, lammps);
  on_all_ranks(world, [&] {
    if (rank_of(world) != 0) return;
    write_bench(options.out / "bench.json", findings.records);
    std::cout << bench_table(findings.records) << "M/s: million particle-steps a second of user processor time. ratio: value over peer.\n"
              << (options.out / "bench.json").string() << std::endl;
  });
  return ExitCode::ok;
}

}  // namespace snag
