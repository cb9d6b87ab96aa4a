#include "coupling/force_places.hpp"

#include <vector>

#include "parallel/sum.hpp"

namespace snag {

namespace {

/// X of each rag, m.
std::vector<Vec3> centres_of_force(MPI_Comm comm, std::span<const Vec3> places, std::span<const Vec3> impulses, std::span<const int> rag_of,
                                   std::size_t n_rags) {
  std::vector<double> sums(4 * n_rags);  // sum |J| x, sum |J| of each rag
  for (std::size_t b = 0; b < places.size(); ++b) {
    double* of_rag = &sums[4 * static_cast<std::size_t>(rag_of[b])];
    const double weight = norm(impulses[b]);
    for (int i = 0; i < 3; ++i) of_rag[i] += weight * places[b][i];
    of_rag[3] += weight;
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, comm);
  std::vector<Vec3> centres(n_rags);
  for (std::size_t r = 0; r < n_rags; ++r)
    if (sums[4 * r + 3] > 0) centres[r] = Vec3{sums[4 * r], sums[4 * r + 1], sums[4 * r + 2]} / sums[4 * r + 3];
  return centres;
}

}  // namespace

ForcePlaces force_places(MPI_Comm comm, std::span<const Vec3> places, std::span<const Vec3> mean_places, std::span<const Vec3> impulses,
                         std::span<const int> rag_of, std::size_t n_rags) {
  const std::vector<Vec3> centres = centres_of_force(comm, places, impulses, rag_of, n_rags);
  const std::size_t n = places.size();
  std::vector<double> impulse(n), displaced(n), turning(n);
  std::vector<Vec3> couple(n);
  for (std::size_t b = 0; b < n; ++b) {
    const Vec3 displacement = mean_places[b] - places[b];
    impulse[b] = norm(impulses[b]), displaced[b] = norm(displacement) * impulse[b];
    couple[b] = cross(displacement, impulses[b]);
    turning[b] = norm(cross(places[b] - centres[static_cast<std::size_t>(rag_of[b])], impulses[b]));
  }
  const auto total = [&](const std::vector<double>& terms) { return sum(comm, std::span<const double>(terms)); };
  ForcePlaces found{.impulse = total(impulse), .couple_lost = norm(sum(comm, std::span<const Vec3>(couple))), .couple = total(turning)};
  if (found.impulse > 0) found.displacement = total(displaced) / found.impulse;
  return found;
}

}  // namespace snag
