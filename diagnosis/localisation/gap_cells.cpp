#include "diagnosis/localisation/gap_cells.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numeric>

#include "diagnosis/statistics/statistics.hpp"

namespace snag {

namespace {

constexpr int n_windows = 4, least_of_distribution = 5;
constexpr double not_there = std::numeric_limits<double>::quiet_NaN();

struct CellOfRows {
  GapCell cell;
  std::vector<int> rows;  // of its point; then over all training points
};

// One cell's rows of a point's linearization.
class PointCells {
 public:
  PointCells(Responses& model, const Linearization& base, std::size_t p)
      : model_(model), base_(base), p_(p), point_(model.points()[model.training()[p]]) {}

  std::vector<CellOfRows> cells() {
    std::vector<CellOfRows> cells;
    const int n = static_cast<int>(point_.rows.size());
    for (int begin = 0, end = 0; begin < n; begin = end) {
      const Row& first = point_.rows[begin];
      const std::string region = region_of(first);
      for (end = begin; end < n && point_.rows[end].observable == first.observable && point_.rows[end].kind == first.kind &&
                        region_of(point_.rows[end]) == region;)
        ++end;
      const int windows = std::min(n_windows, end - begin);
      if (first.kind == Row::Kind::spread) continue;
      for (int w = 0; w < windows; ++w) {
        const int from = begin + w * (end - begin) / windows, to = begin + (w + 1) * (end - begin) / windows;
        cells.push_back({cell(from, to), std::vector<int>(static_cast<std::size_t>(to - from))});
        cells.back().cell.region = region;
        std::iota(cells.back().rows.begin(), cells.back().rows.end(), from);
      }
    }
    return cells;
  }

 private:
  // The first region that holds the place measured at the time of a row; a coordinate that is not measured is in all of them.
  std::string region_of(const Row& row) const {
    const auto& regions = model_.experiment().regions;
    if (regions.empty() || row.kind != Row::Kind::path) return "all";
    const double time = 0.5 * (row.begin + row.end);
    for (const Region& region : regions) {
      bool inside = true;
      for (int axis = 0; axis < 3; ++axis) {
        const Row* place = row_at(std::string(1, "xyz"[axis]), time);
        inside = inside && (!place || (place->value >= region.lower[axis] && place->value <= region.upper[axis]));
      }
      if (inside) return region.id;
    }
    return "elsewhere";
  }

  // Of a path of that name the row nearest in time; null if there is none.
  const Row* row_at(const std::string& name, double time) const {
    const Row* nearest = nullptr;
    for (const Row& row : point_.rows) {
      if (row.kind != Row::Kind::path || model_.experiment().observables[row.observable].id != name) continue;
      const auto off = [&](const Row& r) { return std::abs(0.5 * (r.begin + r.end) - time); };
      if (!nearest || off(row) < off(*nearest)) nearest = &row;
    }
    return nearest;
  }

  GapCell cell(int begin, int end) {
    const Row& row = point_.rows[begin];
    const Observable& observable = model_.experiment().observables[row.observable];
    GapCell cell;
    cell.observable = observable.id, cell.point = model_.experiment().points[point_.point].id;
    cell.window = {row.begin, point_.rows[end - 1].end};
    const Response& response = base_.responses[p_];
    const int n = end - begin;
    const auto mean = [&](const Eigen::VectorXd& values) { return values.segment(begin, n).mean(); };
    for (int i = begin; i < end; ++i) cell.measured += point_.rows[i].value / n;
    cell.simulated = mean(response.value);
    cell.u_num = std::abs(mean(base_.numerical_error[p_]));
    double input = 0, bias = 0;
    for (std::size_t j = 0; j < base_.by_nuisance.size(); ++j) {
      const Response& moved = base_.by_nuisance[j][p_];
      if (moved.value.size() == 0) continue;
      const double change = (mean(moved.value) - cell.simulated) / nuisance_step;
      (model_.nuisances()[j].of_data ? bias : input) += change * change;
    }
    cell.u_input = std::sqrt(input);
    // Of times that are all censored the median is not known; their scatter still is.
    const double own_u = std::isfinite(row.u) ? row.u : row.sigma / std::sqrt(row.n_replicates);
    double data = is_gaussian(row) ? point_.covariance.block(begin, begin, n, n).mean() : own_u * own_u;
    if (response.paths.cols() > 1 && is_gaussian(row)) {
      const Eigen::VectorXd means = response.paths.middleRows(begin, n).colwise().mean();
      cell.u_S = std::sqrt(means.squaredNorm() / (static_cast<double>(means.size()) - 1) / static_cast<double>(means.size()));
    } else {
      cell.u_S = std::sqrt(response.scatter[begin] / response.n_runs);
    }
    cell.u_D = std::sqrt(data + bias);
    cell.u_val = std::sqrt(cell.u_num * cell.u_num + input + data + bias + cell.u_S * cell.u_S);
    test(cell, row);
    const double size = is_gaussian(row) && row.kind == Row::Kind::path ? range(row.observable) : std::abs(cell.measured);
    constexpr double blind_share = 0.3;
    cell.blind = observable.kind != Observable::Kind::lognormal ? 2 * cell.u_val > blind_share * size : 2 * cell.u_val > blind_share;
    if (observable.kind == Observable::Kind::lognormal) cell.measured = std::exp(cell.measured), cell.simulated = std::exp(cell.simulated);
    return cell;
  }

  // |D| of a path: how far it goes, so that the zero of a coordinate does not matter.
  double range(int observable) const {
    double low = std::numeric_limits<double>::infinity(), high = -low, largest = 0;
    for (const Row& row : point_.rows) {
      if (row.observable != observable || row.kind != Row::Kind::path) continue;
      low = std::min(low, row.value), high = std::max(high, row.value), largest = std::max(largest, std::abs(row.value));
    }
    return high > low ? high - low : largest;
  }

  void test(GapCell& cell, const Row& row) {
    const double E = cell.simulated - cell.measured;
    cell.z = cell.u_val > 0 ? E / cell.u_val : 0;
    cell.p = two_sided_p(cell.z);
    const int n = row.n_replicates, N = base_.responses[p_].n_runs, answers = base_.responses[p_].n_answers;
    const auto from_p = [&](double p, CellTest test) {
      // Inputs that are known badly weaken an exact test as they weaken z.
      const double share =
          std::sqrt(1 - std::min(1.0, (cell.u_input * cell.u_input + cell.u_num * cell.u_num) / (cell.u_val * cell.u_val)));
      cell.z = (E >= 0 ? 1 : -1) * score_of_p(p) * share, cell.p = two_sided_p(cell.z), cell.test = test;
    };
    if (row.kind == Row::Kind::event)
      from_p(
          fisher_exact(static_cast<int>(std::lround(row.value * n)), n, static_cast<int>(std::lround(cell.simulated * answers)), answers),
          CellTest::binomial);
    else if (row.kind == Row::Kind::count)
      from_p(equal_rates(row.value * n, n, cell.simulated * answers, answers, row.sigma), CellTest::negative_binomial);
    else if (row.kind == Row::Kind::time && std::count(row.censored.begin(), row.censored.end(), true) > 0)
      censored_times(cell, row, from_p);
    else if (row.kind == Row::Kind::scalar && std::min(n, N) >= least_of_distribution)
      distribution(cell, row);
  }

  // Whether repeats scatter as runs do, whatever their means: the energy distance of both about their means. The runs get the noise of a
  // sample added. Of two tests the better p counts twice.
  void distribution(GapCell& cell, const Row& row) {
    const Response& response = base_.responses[p_];
    const auto i = &row - point_.rows.data();
    if (response.paths.rows() <= i) return;
    std::vector<double> measured, simulated;
    for (const double value : row.values) measured.push_back(value - row.value);
    NormalNumbers noise(model_.experiment().seed);
    for (const double deviation : response.paths.row(i)) simulated.push_back(deviation + row.noise_u * noise());
    const double mean = std::accumulate(simulated.begin(), simulated.end(), 0.0) / static_cast<double>(simulated.size());
    for (double& value : simulated) value -= mean;
    const double shape = energy_test(measured, simulated, model_.experiment().seed), p = std::min(1.0, 2 * std::min(shape, cell.p));
    if (shape < cell.p) cell.test = CellTest::energy_distance;
    cell.z = (cell.z >= 0 ? 1 : -1) * score_of_p(p), cell.p = p;
  }

  template <class FromP>
  void censored_times(GapCell& cell, const Row& row, const FromP& from_p) {
    std::vector<Lifetime> measured, simulated;
    for (std::size_t r = 0; r < row.values.size(); ++r) measured.push_back({row.values[r], row.censored[r]});
    // Paths hold Gaussian rows only; the times of single runs are drawn from their mean and scatter.
    const Response& response = base_.responses[p_];
    const int N = response.n_runs;
    const int i = static_cast<int>(&row - point_.rows.data());
    const bool later = !response.later.empty() && response.later[i];
    for (int s = 0; s < N; ++s)
      simulated.push_back({response.value[i] + std::sqrt(response.scatter[i]) * (N > 1 ? normal_quantile((s + 0.5) / N) : 0), later});
    if (N > 1)
      from_p(log_rank(measured, simulated).p, CellTest::log_rank);
    else
      cell.z = -deviance_residual(row, response.value[i], 1, row.sigma * row.sigma), cell.p = two_sided_p(cell.z);
  }

  Responses& model_;
  const Linearization& base_;
  std::size_t p_;
  const PointSummary& point_;
};

// p that all of these hypotheses hold (Simes).
double simes(std::vector<double> p) {
  std::sort(p.begin(), p.end());
  double least = 1;
  for (std::size_t i = 0; i < p.size(); ++i) least = std::min(least, p[i] * static_cast<double>(p.size()) / static_cast<double>(i + 1));
  return least;
}

// p that the better of several tests reaches by chance at most (Bonferroni).
double better_of(std::initializer_list<double> p) { return std::min(1.0, static_cast<double>(p.size()) * std::min(p)); }

// The cells with what the evidence says of each: the significant ones level by level.
class Hierarchy {
 public:
  Hierarchy(std::vector<CellOfRows>& cells, const FittedGap& before, const FittedGap* after, int n_shapes)
      : cells_(cells), before_(before), after_(after), n_shapes_(n_shapes) {}

  std::vector<GapCell> judged() {
    for (CellOfRows& c : cells_) judge(c);
    std::vector<std::size_t> all(cells_.size());
    std::iota(all.begin(), all.end(), 0);
    select(all, 0);
    std::vector<GapCell> result;
    for (CellOfRows& c : cells_) result.push_back(std::move(c.cell));
    result.insert(result.end(), coarse_.begin(), coarse_.end());
    return result;
  }

 private:
  static constexpr std::size_t n_levels = 4;

  static std::string key(const GapCell& cell, std::size_t level) {
    return level == 0 ? cell.observable : level == 1 ? cell.region : level == 2 ? cell.point : std::to_string(cell.window[0]);
  }

  // A shape that the best of several hypotheses gives is as good as the best of as many tests.
  double p_of_shape(const std::vector<int>& rows) const { return std::min(1.0, n_shapes_ * before_.p_of_shape(rows)); }

  void judge(CellOfRows& c) const {
    GapCell& cell = c.cell;
    const bool exact = cell.test != CellTest::z && cell.test != CellTest::energy_distance;
    if (!exact) {
      const double of_means = cell.p, any = before_.p_of_any(c.rows), shape = p_of_shape(c.rows);
      if (std::min(any, shape) < of_means) cell.test = any < shape ? CellTest::fitted : CellTest::shape;
      cell.p = before_.has_shape() ? better_of({of_means, any, shape}) : better_of({of_means, any});
    }
    cell.score = std::copysign(score_of_p(cell.p), cell.z);
    if (after_)
      cell.score_after = std::copysign(score_of_p(better_of({after_->p_of_any(c.rows), after_->p_of_mean(c.rows)})), -after_->mean(c.rows));
  }

  std::vector<int> rows_of(const std::vector<std::size_t>& group) const {
    std::vector<int> rows;
    for (const std::size_t i : group) rows.insert(rows.end(), cells_[i].rows.begin(), cells_[i].rows.end());
    return rows;
  }

  // Of a level: groups of cells by a key; those whose combined p pass are handed on. Returns whether one passed. A gap that is spread so
  // thin that no part of a group shows it is a coarse cell, the group itself.
  bool select(const std::vector<std::size_t>& cells, std::size_t level) {
    if (level == n_levels) {
      for (const std::size_t i : cells) cells_[i].cell.significant = true;
      return true;
    }
    std::vector<std::string> names;
    std::vector<std::vector<std::size_t>> groups;
    for (const std::size_t i : cells) {
      const std::string name = key(cells_[i].cell, level);
      const auto at = std::find(names.begin(), names.end(), name) - names.begin();
      if (at == static_cast<std::ptrdiff_t>(names.size())) names.push_back(name), groups.emplace_back();
      groups[static_cast<std::size_t>(at)].push_back(i);
    }
    std::vector<double> p;
    for (const auto& group : groups) {
      std::vector<double> own;
      for (const std::size_t i : group) own.push_back(cells_[i].cell.p);
      p.push_back(before_.has_shape() && group.size() > 1 ? better_of({simes(own), p_of_shape(rows_of(group))}) : simes(own));
    }
    const auto passed = benjamini_hochberg(p);
    bool any = false;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if (!passed[g]) continue;
      if (!select(groups[g], level + 1)) add_coarse(groups[g], level, p[g]);
      any = true;
    }
    return any;
  }

  void add_coarse(const std::vector<std::size_t>& group, std::size_t level, double p) {
    const std::vector<int> rows = rows_of(group);
    const GapCell& first = cells_[group.front()].cell;
    GapCell cell;
    cell.measured = cell.simulated = cell.z = cell.u_num = cell.u_input = cell.u_D = cell.u_S = cell.u_val = not_there;
    cell.observable = first.observable;
    cell.region = level > 0 ? first.region : "all", cell.point = level > 1 ? first.point : all_points;
    cell.window = first.window;
    double difference = 0;
    for (const std::size_t i : group) {
      difference += cells_[i].cell.simulated - cells_[i].cell.measured;
      cell.window[0] = std::min(cell.window[0], cells_[i].cell.window[0]);
      cell.window[1] = std::max(cell.window[1], cells_[i].cell.window[1]);
    }
    cell.p = p, cell.test = CellTest::shape, cell.significant = true;
    cell.score = std::copysign(score_of_p(p), difference);
    if (after_) cell.score_after = std::copysign(score_of_p(after_->p_of_any(rows)), -after_->mean(rows));
    coarse_.push_back(std::move(cell));
  }

  std::vector<CellOfRows>& cells_;
  const FittedGap& before_;
  const FittedGap* after_;
  int n_shapes_;
  std::vector<GapCell> coarse_;
};

void mark_onsets(std::vector<GapCell>& cells) {
  constexpr double onset_score = 3;
  const auto shows = [](const GapCell& c) { return c.significant && !std::isnan(c.z) && std::abs(c.score) > onset_score; };
  for (GapCell& cell : cells) {
    if (!shows(cell) || std::isnan(cell.window[0])) continue;
    cell.onset = std::none_of(cells.begin(), cells.end(), [&](const GapCell& c) {
      return c.point == cell.point && shows(c) && (c.window[0] < cell.window[0] || (c.window[0] == cell.window[0] && c.onset));
    });
  }
}

}  // namespace

std::vector<GapCell> gap_cells(Responses& model, const Fitter& fitter, const FittedGap& before, const FittedGap* after, int n_tried) {
  std::vector<CellOfRows> cells;
  for (std::size_t p = 0; p < model.training().size(); ++p) {
    for (CellOfRows& c : PointCells(model, fitter.base(), p).cells()) {
      for (int& row : c.rows) row = before.row(p, row);
      cells.push_back(std::move(c));
    }
  }
  std::vector<GapCell> judged = Hierarchy(cells, before, after, n_tried).judged();
  mark_onsets(judged);
  return judged;
}

}  // namespace snag
