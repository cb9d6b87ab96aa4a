// Main of every fuzz program.
//
//   fuzz_mesh [--mutations N] [--first K] [--only TARGET]     N mutations (default 150) of the seeds of each target, from number K
//   fuzz_mesh --only TARGET FILE...                           these files
//
// The mutation under way lies in the file that is printed first, so that a crash leaves it there. With libFuzzer (preset `fuzz`) the
// coverage-guided main takes the place of this one: the environment variable SNAG_FUZZ_TARGET names the target, and its seeds are put into
// the folder CORPUS.
//
//   SNAG_FUZZ_TARGET=gmsh_41_ascii fuzz_mesh -max_total_time=60 CORPUS
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <memory>
#include <set>
#include <sstream>

#include "base/error.hpp"
#include "base/log.hpp"
#include "parallel/session.hpp"
#include "tests/fuzz/mutation.hpp"
#include "tests/fuzz/target.hpp"

namespace snag::fuzz {

std::vector<Target>& targets() {
  static std::vector<Target> all;
  return all;
}

Registration::Registration(Target target) {
  targets().push_back(std::move(target));
  std::sort(targets().begin(), targets().end(), [](const Target& a, const Target& b) { return a.name < b.name; });
}

std::string source_file(const std::string& path) {
  const char* root = std::getenv("SNAG_SOURCE_DIR");
  std::ostringstream content;
  content << std::ifstream(std::filesystem::path(root ? root : ".") / path, std::ios::binary).rdbuf();
  if (content.str().empty()) throw std::runtime_error(path + ": no seed there; set SNAG_SOURCE_DIR to the source tree");
  return content.str();
}

namespace {

#ifdef SNAG_LIBFUZZER
constexpr unsigned longest_read = 0;  // s; none: libFuzzer has the alarm, and a limit of its own (-timeout)
#else
constexpr unsigned longest_read = 20;  // s
#endif

/// Reads one file; the finding, or "" if all is well.
std::string finding(const Target& target, const std::filesystem::path& file) {
  static const std::set<ExitCode> documented{ExitCode::usage, ExitCode::mesh, ExitCode::diverged, ExitCode::invariant, ExitCode::io};
  alarm(longest_read);
  std::string found;
  try {
    target.read(file);
  } catch (const Error& error) {
    const std::string message = error.what();
    if (!documented.contains(error.code)) found = "undocumented exit code: " + message;
    if (message.starts_with("an input that Snag does not foresee") || message.starts_with("PETSc: "))
      found = "text of a library: " + message;
    if (message.size() > 4000) found = "a message of " + std::to_string(message.size()) + " bytes: " + message.substr(0, 300);
  } catch (const std::exception& error) {
    found = std::string("exception of a library: ") + error.what();
  }
  alarm(0);
  return found;
}

std::filesystem::path scratch_file(const Target& target) {
  return std::filesystem::temp_directory_path() / ("snag_fuzz_" + std::to_string(getpid()) + "_" + target.name + target.ending);
}

void write(const std::filesystem::path& file, const std::string& content) {
  std::ofstream(file, std::ios::binary | std::ios::trunc) << content;
}

#ifdef SNAG_LIBFUZZER
/// The folder that is the last argument, with the seeds of the target.
void add_seeds(const Target& target, const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (!std::filesystem::is_directory(folder, failure)) return;
  int number = 0;
  for (const std::string& seed : target.seeds()) write(folder / ("seed_" + std::to_string(number++)), seed);
}
#else
int replay(const Target& target, std::uint64_t first, std::uint64_t n) {
  const std::filesystem::path file = scratch_file(target);
  std::cout << target.name << ": mutations " << first << " to " << first + n << " in " << file.string() << std::endl;
  const log::Silence silence;  // warnings of what was read
  const std::vector<std::string> seeds = target.seeds();
  int n_findings = 0;
  for (const std::string& seed : seeds) {
    write(file, seed);
    target.read(file);  // a seed is sound
  }
  for (std::uint64_t i = first; i < first + n; ++i) {
    write(file, mutated(seeds, i));
    const std::string found = finding(target, file);
    if (found.empty()) continue;
    ++n_findings;
    const auto kept = file.parent_path() / (target.name + "_" + std::to_string(i) + target.ending);
    std::filesystem::copy_file(file, kept, std::filesystem::copy_options::overwrite_existing);
    std::cout << "  finding, mutation " << i << " (" << kept.string() << "): " << found << std::endl;
  }
  std::filesystem::remove(file);
  return n_findings;
}
#endif

}  // namespace
}  // namespace snag::fuzz

using namespace snag::fuzz;

#ifdef SNAG_LIBFUZZER
namespace {
std::unique_ptr<snag::Session> session;
const Target* chosen = nullptr;
}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  setenv("OMPI_MCA_opal_signal", "", 1);  // Open MPI leaves signals to libFuzzer, which then keeps the input
  session = std::make_unique<snag::Session>(*argc, *argv);
  const char* name = std::getenv("SNAG_FUZZ_TARGET");
  for (const Target& target : targets())
    if (!name || target.name == name) chosen = &target;
  if (!chosen) std::abort();
  const char* last = (*argv)[*argc - 1];
  if (*argc > 1 && last[0] != '-' && !std::filesystem::is_regular_file(last)) add_seeds(*chosen, last);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::filesystem::path file = scratch_file(*chosen);
  write(file, {reinterpret_cast<const char*>(data), size});
  const std::string found = finding(*chosen, file);
  if (found.empty()) return 0;
  std::cerr << found << std::endl;
  std::abort();
}
#else
int main(int argc, char** argv) {
  const snag::Session session(argc, argv);
  std::uint64_t n = 150, first = 0;
  std::string only;
  std::vector<std::string> files;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--mutations" && i + 1 < argc)
      n = std::stoull(argv[++i]);
    else if (word == "--first" && i + 1 < argc)
      first = std::stoull(argv[++i]);
    else if (word == "--only" && i + 1 < argc)
      only = argv[++i];
    else
      files.push_back(word);
  }
  int n_findings = 0, n_targets = 0;
  for (const Target& target : targets()) {
    if (!only.empty() && target.name != only) continue;
    ++n_targets;
    if (files.empty()) n_findings += replay(target, first, n);
    for (const std::string& file : files) {
      const std::string found = finding(target, file);
      std::cout << file << ": " << (found.empty() ? "well" : found) << std::endl;
      n_findings += !found.empty();
    }
  }
  if (n_targets == 0) std::cerr << "no target \"" << only << "\"" << std::endl;
  return n_findings > 0 || n_targets == 0;
}
#endif
