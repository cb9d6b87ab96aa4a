#include "app/passage.hpp"

#include <algorithm>

#include "parallel/sum.hpp"

namespace snag {

namespace {

constexpr double reach = 1.5;  // of an opening's radius: a rag on its way out may hang over the rim
constexpr int n_kinds = 2;
const char* const kinds[n_kinds] = {"reached the outlet", "exited"};

bool is_out(const Vec3& x, const std::vector<Opening>& openings) {
  return std::any_of(openings.begin(), openings.end(), [&](const Opening& opening) {
    const Vec3 away = x - opening.centre;
    const double beyond = dot(away, opening.normal);
    return beyond > 0 && norm(away - beyond * opening.normal) < reach * opening.radius;
  });
}

}  // namespace

std::vector<Opening> openings(const Mesh& mesh, const BoundarySet& boundary) {
  std::vector<Opening> found;
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    const Patch& patch = mesh.patches[p];
    if (boundary.fixes(static_cast<int>(p)) != Fixes::pressure) continue;
    std::vector<Vec3> vectors, moments;
    std::vector<double> areas;
    for (int f = patch.first; f < patch.end(); ++f) {
      const double area = norm(mesh.face_vector[f]);
      vectors.push_back(mesh.face_vector[f]), moments.push_back(area * mesh.face_centre[f]), areas.push_back(area);
    }
    Opening opening{patch.name, sum(mesh.comm, moments) / sum(mesh.comm, areas), unit(sum(mesh.comm, vectors)), 0};
    double radius = 0;
    for (int f = patch.first; f < patch.end(); ++f) radius = std::max(radius, norm(mesh.face_centre[f] - opening.centre));
    opening.radius = maximum(mesh.comm, radius);
    found.push_back(opening);
  }
  return found;
}

Passage::Passage(MPI_Comm comm, std::vector<Opening> openings, std::size_t n_rags)
    : comm_(comm), openings_(std::move(openings)), events_(n_rags), event_times_(n_rags * n_kinds, -1), n_out_(n_rags) {}

void Passage::observe(const RagSystem& rags, double time) {
  if (openings_.empty()) return;
  std::fill(n_out_.begin(), n_out_.end(), 0);
  for (const Tile& tile : rags.tiles()) {
    for (int j = 0; j < tile.ny; ++j) {
      for (int i = 0; i < tile.nx; ++i) {
        const int k = tile.index(i, j);
        if (tile.exists[k] != 0 && is_out(tile.vector(Tile::x, k), openings_)) ++n_out_[tile.rag];
      }
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, n_out_.data(), static_cast<int>(n_out_.size()), MPI_INT64_T, MPI_SUM, comm_);
  for (std::size_t rag = 0; rag < n_out_.size(); ++rag) {
    if (n_out_[rag] > 0) set_event(rag, 0, time);
    if (n_out_[rag] == rags.rags()[rag].n_particles) set_event(rag, 1, time);
  }
}

void Passage::set_event(std::size_t rag, int which, double time) {
  double& when = event_times_[rag * n_kinds + which];
  if (when >= 0) return;
  when = time;
  events_[rag].push_back({time, kinds[which]});
}

bool Passage::all_exited() const {
  bool all = !events_.empty();
  for (std::size_t rag = 0; rag < events_.size(); ++rag) all = all && event_times_[rag * n_kinds + 1] >= 0;
  return all;
}

std::string Passage::outcome(std::size_t rag) const { return event_times_[rag * n_kinds + 1] >= 0 ? "exited" : "upstream"; }

std::vector<double> Passage::state() const { return event_times_; }

void Passage::restore(const std::vector<double>& state) {
  for (std::size_t rag = 0; rag < events_.size(); ++rag) {
    for (int which = 0; which < n_kinds; ++which) {
      if (state[rag * n_kinds + which] >= 0) set_event(rag, which, state[rag * n_kinds + which]);
    }
  }
}

}  // namespace snag
