#include "coupling/particle_router.hpp"

#include <algorithm>
#include <numeric>

#include "parallel/session.hpp"

namespace snag {

namespace {
constexpr int message_tag = 4711;  // of this file's messages
}

void ParticleRouter::plan(const std::vector<std::vector<int>>& particles_for) {
  const int ranks = size_of(comm_);
  particle_.clear();
  rank_.clear();
  std::vector<int> send_count(ranks), receive_count(ranks);
  for (int r = 0; r < ranks; ++r) {
    send_count[r] = static_cast<int>(particles_for[r].size());
    particle_.insert(particle_.end(), particles_for[r].begin(), particles_for[r].end());
    rank_.insert(rank_.end(), particles_for[r].size(), r);
  }
  MPI_Alltoall(send_count.data(), 1, MPI_INT, receive_count.data(), 1, MPI_INT, comm_);
  send_start_.assign(ranks + 1, 0);
  receive_start_.assign(ranks + 1, 0);
  std::partial_sum(send_count.begin(), send_count.end(), send_start_.begin() + 1);
  std::partial_sum(receive_count.begin(), receive_count.end(), receive_start_.begin() + 1);
}

void ParticleRouter::keep(std::span<const char> keeps_entry, std::span<const char> keeps_received) {
  const auto shorten = [](std::vector<int>& start, std::span<const char> keeps) {
    std::vector<int> kept(keeps.size() + 1, 0);  // before each
    for (std::size_t i = 0; i < keeps.size(); ++i) kept[i + 1] = kept[i] + keeps[i];
    for (int& s : start) s = kept[s];
  };
  shorten(send_start_, keeps_entry);
  shorten(receive_start_, keeps_received);
  std::size_t n = 0;
  for (std::size_t e = 0; e < particle_.size(); ++e) {
    if (!keeps_entry[e]) continue;
    particle_[n] = particle_[e], rank_[n] = rank_[e];
    ++n;
  }
  particle_.resize(n), rank_.resize(n);
}

void ParticleRouter::exchange(const double* from, const std::vector<int>& from_start, double* to, const std::vector<int>& to_start,
                              int components) const {
  const int ranks = static_cast<int>(from_start.size()) - 1, me = rank_of(comm_);
  std::vector<MPI_Request> requests;
  for (int r = 0; r < ranks; ++r) {
    const int count = (to_start[r + 1] - to_start[r]) * components;
    if (r == me || count == 0) continue;
    MPI_Irecv(to + static_cast<std::size_t>(to_start[r]) * components, count, MPI_DOUBLE, r, message_tag, comm_, &requests.emplace_back());
  }
  for (int r = 0; r < ranks; ++r) {
    const int count = (from_start[r + 1] - from_start[r]) * components;
    const double* first = from + static_cast<std::size_t>(from_start[r]) * components;
    if (r == me) {
      std::copy_n(first, count, to + static_cast<std::size_t>(to_start[r]) * components);
    } else if (count > 0) {
      MPI_Isend(first, count, MPI_DOUBLE, r, message_tag, comm_, &requests.emplace_back());
    }
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

void ParticleRouter::forward(std::span<const double> entries, int components, std::vector<double>& received) const {
  received.resize(static_cast<std::size_t>(n_received()) * components);
  exchange(entries.data(), send_start_, received.data(), receive_start_, components);
}

void ParticleRouter::forward_particles(std::span<const double> particles, int components, std::vector<double>& received) const {
  std::vector<double> entries(particle_.size() * components);
  for (std::size_t e = 0; e < particle_.size(); ++e)
    std::copy_n(particles.data() + static_cast<std::size_t>(particle_[e]) * components, components, entries.data() + e * components);
  forward(entries, components, received);
}

void ParticleRouter::back(std::span<const double> received, int components, std::vector<double>& entries) const {
  entries.resize(particle_.size() * components);
  exchange(received.data(), receive_start_, entries.data(), send_start_, components);
}

}  // namespace snag
