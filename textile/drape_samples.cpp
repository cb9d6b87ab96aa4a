#include "textile/drape_samples.hpp"

#include <algorithm>

#include "parallel/session.hpp"

namespace snag {

/// A row of the message: the outline's radii, its area, seed, peaks, time, steps.
std::vector<DrapeSample> drape_samples(MPI_Comm comm, std::size_t n, const std::function<DrapeSample(std::size_t)>& make) {
  const std::size_t n_directions = OutlineSettings{}.n_directions, width = n_directions + 5;
  std::vector<double> rows(n * width, 0.0);
  on_all_ranks(comm, [&] {
    for (std::size_t i = rank_of(comm); i < n; i += size_of(comm)) {
      const DrapeSample sample = make(i);
      double* row = &rows[i * width];
      row = std::copy(sample.outline.radius.begin(), sample.outline.radius.end(), row);
      row[0] = sample.outline.area, row[1] = sample.seed, row[2] = sample.cost.n_peaks, row[3] = sample.cost.time;
      row[4] = static_cast<double>(sample.cost.n_steps);
    }
  });
  MPI_Allreduce(MPI_IN_PLACE, rows.data(), static_cast<int>(rows.size()), MPI_DOUBLE, MPI_SUM, comm);
  std::vector<DrapeSample> samples;
  for (std::size_t i = 0; i < n; ++i) {
    const double *radii = &rows[i * width], *row = radii + n_directions;
    samples.push_back({static_cast<int>(row[1]),
                       outline_from(std::vector<double>(radii, row), row[0], {}),
                       {static_cast<int>(row[2]), row[3], static_cast<std::int64_t>(row[4])}});
  }
  return samples;
}

}  // namespace snag
