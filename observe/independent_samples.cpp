#include "observe/independent_samples.hpp"

#include <algorithm>
#include <map>

namespace snag {

namespace {

using Value = std::array<double, 2>;

Value operator-(const Value& a, const Value& b) { return {a[0] - b[0], a[1] - b[1]}; }
double product(const Value& a, const Value& b) { return a[0] * b[0] + a[1] * b[1]; }

struct Cluster {
  double n = 0;
  Value sum{};
  Value mean() const { return {sum[0] / n, sum[1] / n}; }
};

/// Samples of each group, and of each rag of it.
struct Clusters {
  std::vector<Cluster> groups;
  std::vector<std::map<int, Cluster>> rags;  // [n_groups]

  Clusters(std::span<const RagSample> samples, int n_groups) : groups(n_groups), rags(n_groups) {
    for (const RagSample& s : samples)
      for (Cluster* cluster : {&groups[s.group], &rags[s.group][s.rag]})
        cluster->n += 1, cluster->sum[0] += s.value[0], cluster->sum[1] += s.value[1];
  }
  /// m' of a group: how many samples the rag of a sample has, on average.
  double mean_size(int group) const {
    double square = 0;
    for (const auto& [rag, cluster] : rags[group]) square += cluster.n * cluster.n;
    return square / groups[group].n;
  }
};

/// `n_more_rags`: rags beyond the first of each group; `n_repeats`: samples beyond the first of each rag.
double intraclass_correlation(std::span<const RagSample> samples, const Clusters& all, double n_more_rags, double n_repeats) {
  double between = 0, within = 0, size = 0;
  for (std::size_t g = 0; g < all.groups.size(); ++g) {
    for (const auto& [rag, cluster] : all.rags[g]) {
      const Value off = cluster.mean() - all.groups[g].mean();
      between += cluster.n * product(off, off);
    }
    size += all.groups[g].n - all.mean_size(static_cast<int>(g));
  }
  for (const RagSample& s : samples) {
    const Value off = s.value - all.rags[s.group].at(s.rag).mean();
    within += product(off, off);
  }
  const double B = between / n_more_rags, W = within / n_repeats, m_0 = size / n_more_rags;
  return (B - W) / (B + (m_0 - 1) * W);
}

double autocorrelation(std::span<const RagSample> samples, const Clusters& all) {
  std::vector<Value> last(all.groups.size());
  std::vector<bool> has_last(all.groups.size());
  double products = 0, squares = 0;
  for (const RagSample& s : samples) {
    const Value off = s.value - all.groups[s.group].mean();
    if (has_last[s.group]) products += product(last[s.group], off);
    squares += product(off, off);
    last[s.group] = off, has_last[s.group] = true;
  }
  return products / squares;
}

}  // namespace

IndependentSamples independent_samples(std::span<const RagSample> samples, int n_groups) {
  const Clusters all(samples, n_groups);
  const bool rags_known = std::none_of(samples.begin(), samples.end(), [](const RagSample& s) { return s.rag < 0; });
  double n_more_rags = 0, n_repeats = static_cast<double>(samples.size());
  for (const auto& rags : all.rags) {
    n_more_rags += static_cast<double>(rags.size()) - 1;
    n_repeats -= static_cast<double>(rags.size());
  }
  IndependentSamples result;
  if (!rags_known || n_more_rags == 0)
    result.dependence = Dependence::autocorrelation, result.correlation = autocorrelation(samples, all);
  else if (n_repeats > 0)
    result.dependence = Dependence::intraclass, result.correlation = intraclass_correlation(samples, all, n_more_rags, n_repeats);
  const double c = std::max(0.0, result.correlation);
  for (int g = 0; g < n_groups; ++g) {
    const double n = all.groups[g].n;
    const double per_independent = result.dependence == Dependence::autocorrelation ? (1 + c) / (1 - c) : 1 + (all.mean_size(g) - 1) * c;
    result.counts.push_back(std::max(1.0, n / per_independent));
  }
  return result;
}

}  // namespace snag
