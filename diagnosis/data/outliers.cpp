#include "diagnosis/data/outliers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <tuple>

#include "diagnosis/data/summary.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {

namespace {

constexpr double nats_wanted = 6, far_off = 5, agrees = 4;

constexpr std::size_t fewest_samples = 12;  // of a point, to know its scatter

/// What a sample is expected to be from others, and the sum of the squares of their weights.
struct Prediction {
  double value = 0, square = 0;
};

/// Samples of a series that are judged together, and are not used to predict others.
struct Suspects {
  std::array<std::size_t, 4> index{};
  std::size_t n = 0;
  bool contains(std::size_t i) const {
    return std::find(index.begin(), index.begin() + static_cast<std::ptrdiff_t>(n), i) != index.begin() + static_cast<std::ptrdiff_t>(n);
  }
  void add(std::size_t i) { index[n++] = i; }
  std::span<const std::size_t> indices() const { return std::span(index).first(n); }
};

/// One repeat at one point.
struct Path {
  std::vector<double> time, value;
  std::vector<std::size_t> datum;
  std::vector<bool> left_out;
};

/// The paths of an observable at one point, and how they are predicted.
class PointPaths {
 public:
  /// `period`: of angles; 0: of what has none.
  PointPaths(double noise_u, double period) : noise_u_(noise_u), period_(period) {}

  void add(int replicate, double time, double value, std::size_t datum) {
    Path& path = paths_[replicate];
    path.time.push_back(time), path.value.push_back(value), path.datum.push_back(datum), path.left_out.push_back(false);
  }

  /// When all samples are there.
  void end() {
    for (auto& [replicate, path] : paths_) all_.push_back(&path);
  }

  /// Robust scatter of one sample about its predictions; 0 where there are too few.
  double scatter() const {
    std::vector<double> sizes;
    for (const Path* path : all_)
      for (std::size_t i = 0; i < path->value.size(); ++i)
        if (const auto p = path->left_out[i] ? std::nullopt : predicted(*path, i, {}))
          sizes.push_back(std::abs(difference(path->value[i], p->value)) / std::sqrt(1 + p->square));
    if (sizes.size() < fewest_samples) return 0;
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    constexpr double of_median = 1.4826;  // standard deviation of a normal variable over its median deviation
    return std::max(of_median * *middle, noise_u_);
  }

  /// Leaves out what is far off, round by round: the largest first, for it spoils the predictions of its neighbours. First by the predictor
  /// that scatters less, then by the other one, which may see what hid behind a neighbour.
  void judge(double usual_scatter) {
    by_repeats_ = false;
    const double by_series = scatter_of_series(usual_scatter);
    by_repeats_ = true;
    const double by_repeats = scatter();
    const bool repeats_first = by_repeats > 0 && (by_series == 0 || by_repeats <= by_series);
    for (const bool second : {false, true}) {
      by_repeats_ = repeats_first != second;
      const double before = scale_;
      scale_ = by_repeats_ ? by_repeats : by_series;
      constexpr double comparable = 1.5;  // what scatters more is another thing than noise: repeats that each go their way
      if (second && scale_ > comparable * before) break;
      constexpr int most_rounds = 30;
      for (int round = 0; scale_ > 0 && round < most_rounds && leave_out_largest(); ++round) {
      }
    }
    by_repeats_ = repeats_first, scale_ = repeats_first ? by_repeats : by_series;
  }

  /// z of all samples: of outliers when they were found, of the others as they are now.
  void collect(std::vector<double>& scores, std::vector<std::size_t>& outliers) const {
    if (scale_ == 0) return;
    for (const Path* path : all_)
      for (std::size_t i = 0; i < path->value.size(); ++i)
        if (!path->left_out[i])
          if (const auto z = score(*path, i)) scores.push_back(*z);
    scores.insert(scores.end(), scores_of_outliers_.begin(), scores_of_outliers_.end());
    outliers.insert(outliers.end(), outliers_.begin(), outliers_.end());
  }

 private:
  /// a - b, of angles the nearest to zero.
  double difference(double a, double b) const { return period_ > 0 ? wrapped(a - b, period_) : a - b; }

  /// From the samples around i in the same series but for the suspects: the cubic through two on each side, the parabola through three at
  /// an end. Of an angle the turn is taken that is nearest to the other samples used: a false angle does not turn what follows it.
  std::optional<Prediction> from_series(const Path& path, std::size_t i, const Suspects& suspects) const {
    std::array<std::size_t, 3> before{}, after{};
    std::size_t n_before = 0, n_after = 0;
    const auto usable = [&](std::size_t j) { return !path.left_out[j] && !suspects.contains(j); };
    for (std::size_t j = i; j-- > 0 && n_before < 3;)
      if (usable(j)) before[n_before++] = j;
    for (std::size_t j = i + 1; j < path.value.size() && n_after < 3; ++j)
      if (usable(j)) after[n_after++] = j;
    if (n_before + n_after < 3) return {};
    if (n_before >= 2 && n_after >= 2) {
      n_before = n_after = 2;
    } else if (n_before < 2) {
      n_after = 3 - n_before;
    } else {
      n_before = 3 - n_after;
    }
    std::array<std::size_t, 4> chosen{};
    const std::size_t n = n_before + n_after;
    std::copy_n(before.begin(), n_before, chosen.begin());
    std::copy_n(after.begin(), n_after, chosen.begin() + static_cast<std::ptrdiff_t>(n_before));
    Prediction prediction;
    std::array<double, 4> value{};
    for (std::size_t a = 0; a < n; ++a) {
      value[a] = path.value[chosen[a]];
      if (a > 0) {
        double beside = value[a == n_before ? 0 : a - 1];
        if (a == n_before && n_before > 1)  // beyond sample i: at the rate of the two before it
          beside += (value[0] - value[1]) / (path.time[chosen[0]] - path.time[chosen[1]]) * (path.time[chosen[a]] - path.time[chosen[0]]);
        value[a] = beside + difference(value[a], beside);
      }
    }
    for (std::size_t a = 0; a < n; ++a) {
      double weight = 1;
      for (std::size_t b = 0; b < n; ++b)
        if (a != b) weight *= (path.time[i] - path.time[chosen[b]]) / (path.time[chosen[a]] - path.time[chosen[b]]);
      prediction.value += weight * value[a], prediction.square += weight * weight;
    }
    return prediction;
  }

  /// From the other repeats at the same time.
  std::optional<Prediction> from_repeats(const Path& path, std::size_t i) const {
    std::vector<double>& others = others_;
    others.clear();
    for (const Path* other : all_) {
      if (other == &path) continue;
      const auto at = std::lower_bound(other->time.begin(), other->time.end(), path.time[i]);
      if (at == other->time.end() || *at != path.time[i]) continue;
      const auto j = static_cast<std::size_t>(at - other->time.begin());
      if (!other->left_out[j]) others.push_back(others.empty() ? other->value[j] : others[0] + difference(other->value[j], others[0]));
    }
    if (others.size() < 2) return {};
    std::sort(others.begin(), others.end());
    const std::size_t n = others.size();
    // Variance of a median over that of one value: 1/2 of two, about pi/2n of many.
    return Prediction{0.5 * (others[(n - 1) / 2] + others[n / 2]), n == 2 ? 0.5 : std::numbers::pi / (2 * static_cast<double>(n))};
  }

  std::optional<Prediction> predicted(const Path& path, std::size_t i, const Suspects& suspects) const {
    return by_repeats_ ? from_repeats(path, i) : from_series(path, i, suspects);
  }

  /// Scatter without what spoils it, not below what is usual.
  double scatter_of_series(double usual) {
    const double of_all = scatter();
    std::vector<std::vector<std::size_t>> spoilers;
    for (Path* path : all_) spoilers.push_back(leave_out_spoilers(*path));
    const double without = scatter();
    for (std::size_t s = 0; s < all_.size(); ++s)
      for (const std::size_t i : spoilers[s]) all_[s]->left_out[i] = false;
    return std::max(without, std::min(of_all, usual));
  }

  /// Leaves out what spoils most as long as the path without it is better predicted by 6 nats of Cauchy noise of the stated width; nothing
  /// if that is more than a fifth of the path.
  std::vector<std::size_t> leave_out_spoilers(Path& path) const {
    constexpr double worth = 6, most = 0.2;
    const std::size_t n = path.value.size();
    std::vector<std::size_t> spoilers;
    if (noise_u_ == 0) return spoilers;
    std::vector<double> gain(n);
    const auto set = [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) gain[i] = path.left_out[i] ? 0 : gain_without(path, {&i, 1}, noise_u_);
    };
    for (set(0, n);;) {
      const auto worst = static_cast<std::size_t>(std::max_element(gain.begin(), gain.end()) - gain.begin());
      if (!(gain[worst] > worth)) return spoilers;
      path.left_out[worst] = true, spoilers.push_back(worst);
      if (static_cast<double>(spoilers.size()) > most * static_cast<double>(n)) {
        for (const std::size_t i : spoilers) path.left_out[i] = false;
        return {};
      }
      constexpr std::size_t felt = 2 * predicts;  // how far a sample that is left out is felt
      set(worst > felt ? worst - felt : 0, std::min(worst + felt + 1, n));
    }
  }

  static constexpr std::size_t predicts = 6;  // samples, to either side, whose predictions a sample may be in

  /// Nats of Cauchy noise of this width by which the series is better predicted without some samples.
  double gain_without(Path& path, std::span<const std::size_t> samples, double width) const {
    const std::size_t begin = samples.front() > predicts ? samples.front() - predicts : 0;
    const std::size_t end = std::min(samples.back() + predicts + 1, path.value.size());
    const auto nats = [&] {
      double sum = 0;
      for (std::size_t j = begin; j < end; ++j)
        if (const auto p = path.left_out[j] ? std::nullopt : from_series(path, j, {}))
          sum += std::log1p(std::pow(difference(path.value[j], p->value) / width, 2) / (1 + p->square)) + 0.5 * std::log1p(p->square);
      return sum;
    };
    const double with = nats();
    for (const std::size_t i : samples) path.left_out[i] = true;
    const double without = nats();
    for (const std::size_t i : samples) path.left_out[i] = false;
    return with - without;
  }

  /// z of a sample; none where too few others are there.
  std::optional<double> score(const Path& path, std::size_t i, const Suspects& suspects = {}) const {
    const auto p = predicted(path, i, suspects);
    if (!p) return {};
    return difference(path.value[i], p->value) / (scale_ * std::sqrt(1 + p->square));
  }

  /// Whether most of the other repeats leave the series at this time too, to the same side: then the piece did so.
  bool is_of_other_repeats(const Path& path, std::size_t i, double z) const {
    constexpr double shown = 3;
    int show = 0, others = 0;
    for (const Path* other : all_) {
      if (other == &path) continue;
      const auto at = std::lower_bound(other->time.begin(), other->time.end(), path.time[i]);
      if (at == other->time.end() || *at != path.time[i]) continue;
      const auto same = score(*other, static_cast<std::size_t>(at - other->time.begin()));
      if (!same) continue;
      ++others, show += std::abs(*same) > shown && (*same > 0) == (z > 0);
    }
    return 2 * show > others;
  }

  /// The least |z| of the suspects where each of them is far off and the series beside them agrees across them; else 0.
  double far_off_by(const Path& path, const Suspects& suspects) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < suspects.n; ++k) {
      const auto z = score(path, suspects.index[k], suspects);
      if (!z || std::abs(*z) < far_off) return 0;
      least = std::min(least, std::abs(*z));
    }
    if (by_repeats_) return least;
    for (std::size_t k = 0; k < suspects.n; ++k) {
      const std::size_t i = suspects.index[k];
      for (const std::size_t beside : {i - 1, i + 1}) {
        if (beside >= path.value.size() || path.left_out[beside] || suspects.contains(beside)) continue;
        if (const auto z = score(path, beside, suspects); z && std::abs(*z) > agrees) return 0;
      }
      if (is_of_other_repeats(path, i, *score(path, i, suspects))) return 0;
    }
    return least;
  }

  /// The fewest suspects from sample i on: up to three in a row, and perhaps one more a little further on.
  std::optional<Suspects> suspects_at(const Path& path, std::size_t i, double& z) const {
    constexpr std::size_t longest_row = 3, reach = 3;
    Suspects row;
    for (std::size_t n = 1; n <= (by_repeats_ ? 1 : longest_row); ++n) {
      const std::size_t last = i + n - 1;
      if (last >= path.value.size() || path.left_out[last]) break;
      row.add(last);
      if ((z = far_off_by(path, row)) > 0) return row;
      for (std::size_t further = last + 2; !by_repeats_ && further <= last + 1 + reach && further < path.value.size(); ++further) {
        if (path.left_out[further]) continue;
        Suspects more = row;
        more.add(further);
        if ((z = far_off_by(path, more)) > 0) return more;
      }
    }
    return {};
  }

  struct Candidate {
    std::size_t path = 0;
    Suspects suspects{};
    double z = 0, gain = 0;  // gain: nats by which the series is better without it
  };

  bool leave_out_largest() {
    constexpr double worth_a_look = 2;
    std::vector<Candidate> candidates;
    for (std::size_t s = 0; s < all_.size(); ++s)
      for (std::size_t i = 0; i < all_[s]->value.size(); ++i) {
        if (all_[s]->left_out[i]) continue;
        const auto alone = score(*all_[s], i);
        if (!alone || std::abs(*alone) < worth_a_look) continue;
        double z = 0;
        if (const auto suspects = suspects_at(*all_[s], i, z))
          candidates.push_back({s, *suspects, z, by_repeats_ ? z : gain_without(*all_[s], suspects->indices(), scale_)});
      }
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
      return std::tuple(a.suspects.n, -a.gain, a.path, a.suspects.index[0]) <
             std::tuple(b.suspects.n, -b.gain, b.path, b.suspects.index[0]);
    });
    std::vector<const Candidate*> taken;
    for (const Candidate& candidate : candidates)
      if (std::none_of(taken.begin(), taken.end(), [&](const Candidate* other) { return spoils(*other, candidate); }))
        taken.push_back(&candidate);
    for (const Candidate* candidate : taken)
      for (std::size_t k = 0; k < candidate->suspects.n; ++k) {
        Path& path = *all_[candidate->path];
        const std::size_t i = candidate->suspects.index[k];
        path.left_out[i] = true;
        outliers_.push_back(path.datum[i]), scores_of_outliers_.push_back(candidate->z);
      }
    return !taken.empty();
  }

  /// Whether one took part in the predictions of the other, which is looked at again without it.
  bool spoils(const Candidate& one, const Candidate& other) const {
    if (by_repeats_) return all_[one.path]->time[one.suspects.index[0]] == all_[other.path]->time[other.suspects.index[0]];
    constexpr std::size_t reach = 4;
    return one.path == other.path && other.suspects.index[0] <= one.suspects.index[one.suspects.n - 1] + reach &&
           one.suspects.index[0] <= other.suspects.index[other.suspects.n - 1] + reach;
  }

  double noise_u_, period_;
  std::map<int, Path> paths_;  // by replicate
  std::vector<Path*> all_;
  mutable std::vector<double> others_;  // room for the repeats of one time
  bool by_repeats_ = false;
  double scale_ = 0;  // of one sample; 0: not known
  std::vector<std::size_t> outliers_;
  std::vector<double> scores_of_outliers_;
};

/// Nats of the mixture over normal noise.
double nats_for_outliers(const std::vector<double>& scores) {
  constexpr std::array shares{0.001, 0.003, 0.01, 0.03, 0.1};
  constexpr std::array widths{5.0, 15.0, 50.0, 150.0, 500.0};
  std::vector<double> terms;
  for (const double share : shares)
    for (const double width : widths) {
      double sum = 0;
      for (const double z : scores) {
        const double over = std::log(share / width) + 0.5 * z * z * (1 - 1 / (width * width)), rest = std::log1p(-share);
        sum += std::max(over, rest) + std::log1p(std::exp(-std::abs(over - rest)));
      }
      terms.push_back(sum);
    }
  return log_sum_exp(terms) - std::log(static_cast<double>(terms.size()));
}

/// Median of the scatters of the other points; infinity where there is none.
double usual_elsewhere(const std::map<int, double>& scatters, int point) {
  std::vector<double> others;
  for (const auto& [other, scatter] : scatters)
    if (other != point) others.push_back(scatter);
  if (others.empty()) return std::numeric_limits<double>::infinity();
  const auto middle = others.begin() + static_cast<std::ptrdiff_t>((others.size() - 1) / 2);
  std::nth_element(others.begin(), middle, others.end());
  return *middle;
}

OutliersFound outliers_of(const Experiment& experiment, int o, bool withheld) {
  const Observable& observable = experiment.observables[static_cast<std::size_t>(o)];
  const bool logarithm = observable.kind == Observable::Kind::lognormal;
  const double period = observable.kind == Observable::Kind::angle ? angle_period(observable) : 0;
  std::map<int, PointPaths> points;
  std::size_t n = 0;
  for (std::size_t i = 0; i < experiment.data.size(); ++i) {
    const Datum& d = experiment.data[i];
    if (d.observable != o || std::isnan(d.time) || d.n > 1 || experiment.points[static_cast<std::size_t>(d.point)].withheld != withheld)
      continue;
    points.try_emplace(d.point, observable.noise_u, period)
        .first->second.add(d.replicate, d.time, logarithm ? std::log(d.value) : d.value, i);
    ++n;
  }
  OutliersFound found;
  std::vector<double> scores;
  std::map<int, double> scatters;
  for (auto& [point, paths] : points) {
    paths.end();
    if (const double scatter = paths.scatter(); scatter > 0) scatters.emplace(point, scatter);
  }
  for (auto& [point, paths] : points) paths.judge(usual_elsewhere(scatters, point)), paths.collect(scores, found.samples);
  if (found.samples.empty()) return {};
  found.nats = nats_for_outliers(scores), found.share = static_cast<double>(found.samples.size()) / static_cast<double>(n);
  // More than a fifth is no blunder here and there: the paths are rougher than a cubic, or the noise is another one.
  constexpr double most = 0.2;
  if (found.nats < nats_wanted || found.share > most) return {};
  std::sort(found.samples.begin(), found.samples.end());
  return found;
}

}  // namespace

std::vector<OutliersFound> find_outliers(const Experiment& experiment) {
  std::vector<OutliersFound> all;
  for (int o = 0; o < static_cast<int>(experiment.observables.size()); ++o) {
    OutliersFound training = outliers_of(experiment, o, false);
    const OutliersFound withheld = outliers_of(experiment, o, true);
    std::vector<std::size_t> both;
    std::merge(training.samples.begin(), training.samples.end(), withheld.samples.begin(), withheld.samples.end(),
               std::back_inserter(both));
    if (training.samples.empty()) training = withheld;
    training.samples = std::move(both);
    all.push_back(std::move(training));
  }
  return all;
}

Experiment without(const Experiment& experiment, const std::vector<OutliersFound>& outliers) {
  std::vector<bool> left_out(experiment.data.size(), false);
  for (const OutliersFound& found : outliers)
    for (const std::size_t i : found.samples) left_out[i] = true;
  Experiment rest = experiment;
  rest.data.clear();
  for (std::size_t i = 0; i < experiment.data.size(); ++i)
    if (!left_out[i]) rest.data.push_back(experiment.data[i]);
  return rest;
}

}  // namespace snag
