#include "coupling/force_places.hpp"

#include <vector>

#include "parallel/sum.hpp"

namespace snag {

namespace {

/// Of a rag, over all ranks.
struct ForceCentre {
  Vec3 place;  // X, m
  bool has_couple = false;
};

std::vector<ForceCentre> centres_of_force(MPI_Comm comm, std::span<const Vec3> places, std::span<const Vec3> impulses,
                                          std::span<const int> rag_of, std::size_t n_rags) {
  std::vector<double> sums(5 * n_rags);  // sum |J| x, sum |J|, number of particles of each rag
  for (std::size_t b = 0; b < places.size(); ++b) {
    double* of_rag = &sums[5 * static_cast<std::size_t>(rag_of[b])];
    const double weight = norm(impulses[b]);
    for (int i = 0; i < 3; ++i) of_rag[i] += weight * places[b][i];
    of_rag[3] += weight, of_rag[4] += 1;
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, comm);
  std::vector<ForceCentre> centres(n_rags);
  for (std::size_t r = 0; r < n_rags; ++r)
    if (const double* of_rag = &sums[5 * r]; of_rag[3] > 0) centres[r] = {Vec3{of_rag[0], of_rag[1], of_rag[2]} / of_rag[3], of_rag[4] > 1};
  return centres;
}

}  // namespace

ForcePlaces force_places(MPI_Comm comm, std::span<const Vec3> places, std::span<const Vec3> mean_places, std::span<const Vec3> impulses,
                         std::span<const int> rag_of, std::size_t n_rags) {
  const std::vector<ForceCentre> centres = centres_of_force(comm, places, impulses, rag_of, n_rags);
  const std::size_t n = places.size();
  std::vector<double> impulse(n), displaced(n), turning(n);
  std::vector<Vec3> couple(n);
  for (std::size_t b = 0; b < n; ++b) {
    const Vec3 displacement = mean_places[b] - places[b];
    impulse[b] = norm(impulses[b]), displaced[b] = norm(displacement) * impulse[b];
    const ForceCentre& centre = centres[static_cast<std::size_t>(rag_of[b])];
    if (!centre.has_couple) continue;
    couple[b] = cross(displacement, impulses[b]);
    turning[b] = norm(cross(places[b] - centre.place, impulses[b]));
  }
  const auto total = [&](const std::vector<double>& terms) { return sum(comm, std::span<const double>(terms)); };
  ForcePlaces found{.impulse = total(impulse), .couple_lost = norm(sum(comm, std::span<const Vec3>(couple))), .couple = total(turning)};
  if (found.impulse > 0) found.displacement = total(displaced) / found.impulse;
  return found;
}

}  // namespace snag
