#include "benchmark/blind/bench.hpp"

#include <mpi.h>
#include <sys/resource.h>

#include <fstream>
#include <memory>
#include <sstream>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/progress.hpp"
#include "base/sha256.hpp"
#include "base/words.hpp"
#include "casework/diagnose_case.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {

const MPI_Comm world = MPI_COMM_WORLD;

double processor_seconds() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return static_cast<double>(used.ru_utime.tv_sec) + 1e-6 * static_cast<double>(used.ru_utime.tv_usec);
}

/// The rows of an earlier start; a line that was cut off is not one.
std::vector<ScoreRow> rows_of(const std::filesystem::path& file) {
  std::vector<ScoreRow> rows;
  std::istringstream text(file_text(file).value_or(""));
  std::string line;
  std::getline(text, line);
  while (std::getline(text, line))
    if (!text.eof()) rows.push_back(score_row(line));
  return rows;
}

std::string content_of(const std::vector<ScoreRow>& rows) {
  std::string text = score_header() + "\n";
  for (const ScoreRow& row : rows) text += score_line(row) + "\n";
  return text;
}

/// Does not tell the number of the set.
std::string name_of(const DiagnoseBenchOptions& options, int number) {
  return "set_" + sha256(options.twin + options.level + "|" + std::to_string(options.seed) + "|" + std::to_string(number)).substr(0, 12);
}

/// One set: made and sealed, judged without its truth, opened and scored. Collective; the row counts on rank 0.
ScoreRow judged(const DiagnoseBenchOptions& options, int number) {
  const std::string name = name_of(options, number);
  const auto folder = options.out / "sets" / name, sealed = options.out / "sealed" / (name + ".json");
  std::string fingerprint;
  on_all_ranks(world, [&] {
    if (rank_of(world) != 0) return;
    fingerprint = seal(make_twin(options, number, folder), sealed);
    std::ofstream(options.out / "sealed.log", std::ios::app) << name << " sha256 " << fingerprint << "\n" << std::flush;
  });
  const double begun = processor_seconds();
  const Verdict verdict = diagnose_file({.file = folder / "DIAGNOSIS.toml", .out = folder, .keep_runs = false, .quiet = true});
  const double seconds = sum(world, processor_seconds() - begun);
  ScoreRow row;
  on_all_ranks(world, [&] {
    if (rank_of(world) == 0) row = scored(opened(sealed, fingerprint), verdict, seconds, fingerprint);
  });
  return row;
}

}  // namespace

BlindScores bench_diagnosis(const DiagnoseBenchOptions& options) {
  const bool first = rank_of(world) == 0;
  const auto file = options.out / "rows.csv";
  std::vector<ScoreRow> rows;
  on_all_ranks(world, [&] {
    rows = rows_of(file);
    if (first) std::filesystem::create_directories(options.out);
  });
  std::vector<char> done(static_cast<std::size_t>(options.n), 0);
  for (const ScoreRow& row : rows)
    if (row.number < options.n) done[static_cast<std::size_t>(row.number)] = 1;
  std::unique_ptr<Progress> progress;
  if (first) progress = std::make_unique<Progress>(options.twin + " " + options.level, options.n, static_cast<double>(rows.size()));
  for (int number = 0; number < options.n; ++number) {
    if (done[static_cast<std::size_t>(number)]) continue;
    rows.push_back(judged(options, number));
    on_all_ranks(world, [&] {
      if (first) write_atomically(file, content_of(rows));
    });
    if (progress) progress->update(static_cast<double>(rows.size()), rows.back().kind);
  }
  if (progress) progress->finish();
  ScoreCard card;
  on_all_ranks(world, [&] {
    if (!first) return;
    card = score_card(rows, options.twin == "sphere");
    write_atomically(options.out / "score.json", score_json(card));
  });
  return {rows, card};
}

}  // namespace snag
