#include "benchmark/speed/bandwidth.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "base/atomic_file.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {

constexpr double unknown_cache = 64e6;  // bytes, where the system does not tell
constexpr int n_passes = 10;

/// Bytes of all last-level caches of this node, each counted once. Source: Linux, Documentation/ABI/testing/sysfs-devices-system-cpu.
double last_level_caches() {
  namespace fs = std::filesystem;
  int last_level = 0;
  std::set<std::string> counted;  // the processors that share one
  double bytes = 0;
  std::error_code failure;
  for (const auto& processor : fs::directory_iterator("/sys/devices/system/cpu", failure)) {
    for (int index = 0; index < 8; ++index) {
      const fs::path cache = processor.path() / "cache" / ("index" + std::to_string(index));
      const auto level = file_text(cache / "level"), size = file_text(cache / "size"), shared = file_text(cache / "shared_cpu_list");
      if (!level || !size || !shared || level->empty() || size->empty()) continue;
      if (std::stoi(*level) > last_level) last_level = std::stoi(*level), counted.clear(), bytes = 0;
      if (std::stoi(*level) < last_level || !counted.insert(*shared).second) continue;
      bytes += std::stod(*size) * (size->find('M') != std::string::npos ? 1048576.0 : 1024.0);
    }
  }
  return bytes > 0 ? bytes : unknown_cache;
}

}  // namespace

double triad_bandwidth(MPI_Comm comm) {
  MPI_Comm node = MPI_COMM_NULL;
  MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node);
  const auto n = static_cast<std::size_t>(4 * last_level_caches() / sizeof(double) / size_of(node)) + 1;
  MPI_Comm_free(&node);
  std::vector<double> a(n, 0.0), b(n, 1.0), c(n, 2.0);
  double best = 0, scale = 3;
  for (int pass = 0; pass < n_passes; ++pass) {
    MPI_Barrier(comm);
    const double begun = MPI_Wtime();
    for (std::size_t i = 0; i < n; ++i) a[i] = b[i] + scale * c[i];
    MPI_Barrier(comm);
    const double seconds = maximum(comm, MPI_Wtime() - begun);
    best = std::max(best, 24 * sum(comm, static_cast<double>(n)) / seconds);
    scale += 1e-9 * a[static_cast<std::size_t>(pass)];  // the passes are not one
  }
  return best;
}

}  // namespace snag
