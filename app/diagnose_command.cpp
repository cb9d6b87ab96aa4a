// snag diagnose
#include <CLI/CLI.hpp>
#include <memory>

#include "app/command.hpp"
#include "base/atomic_file.hpp"
#include "base/log.hpp"
#include "benchmark/blind/bench.hpp"
#include "casework/diagnose_case.hpp"
#include "parallel/session.hpp"
#include "report/bench_page.hpp"
#include "report/verdict_page.hpp"
#include "report/verdict_words.hpp"

namespace snag {

namespace {

/// A page as report.html of a folder, and lines for the terminal. Collective; rank 0 has the text.
void publish(const std::filesystem::path& folder, const std::function<std::string()>& page, const std::function<std::string()>& lines) {
  on_all_ranks(MPI_COMM_WORLD, [&] {
    if (rank_of(MPI_COMM_WORLD) != 0) return;
    write_atomically(folder / "report.html", page());
    log::info(lines());
  });
}

void diagnose_and_publish(const DiagnoseOptions& options) {
  const Verdict verdict = diagnose_file(options);
  publish(
      options.out, [&] { return verdict_page(verdict); },
      [&] { return verdict_sentence(verdict) + "\n" + verdict_advice(verdict) + "\n" + (options.out / "report.html").string(); });
}

void bench_and_publish(const DiagnoseBenchOptions& options) {
  const BlindScores scores = bench_diagnosis(options);
  publish(
      options.out, [&] { return bench_page(options.twin + ", level " + options.level, scores.rows, scores.card); },
      [&] { return card_text(scores.card); });
}

Action add_diagnose(CLI::App& app) {
  struct Options {
    DiagnoseOptions one;
    DiagnoseBenchOptions bench;
    std::string level;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "diagnose",
      "Find where simulation and measurement differ, which missing effect explains the difference, and how much of it that effect removes");
  auto* file = command->add_option("DIAGNOSIS", options->one.file, "Experiment file (.toml)");
  command->add_option("--out", options->one.out, "Output folder: verdict.json, report.html; runs that are in it are used again")
      ->required();
  auto* bench = command->add_option(
      "--bench", options->level, "Blind benchmark instead of an experiment, on synthetic sets: L1 (other time step) or L2 (other physics)");
  bench->excludes(file);
  command->add_option("--twin", options->bench.twin, "Benchmark: what moves, sphere (default), fibre or rag")->needs(bench);
  command->add_option("--n", options->bench.n, "Benchmark: number of sets (default 60)")->needs(bench)->check(CLI::PositiveNumber);
  command->add_option("--seed", options->bench.seed, "Benchmark: seed of all random draws (default 1)")->needs(bench);
  return [options] {
    if (!options->level.empty()) {
      options->bench.level = options->level, options->bench.out = options->one.out;
      bench_and_publish(options->bench);
      return ExitCode::ok;
    }
    if (options->one.file.empty())
      throw Error(ExitCode::usage, "snag diagnose: no experiment file; give DIAGNOSIS.toml, or --bench L2 for the blind benchmark");
    diagnose_and_publish(options->one);
    return ExitCode::ok;
  };
}
const Command diagnose(90, add_diagnose);

}  // namespace

}  // namespace snag
