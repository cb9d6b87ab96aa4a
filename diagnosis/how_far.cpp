#include "diagnosis/how_far.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/statistics.hpp"

namespace snag {

namespace {

constexpr int least_points = 3, n_resamples = 600;
/// Below this excess, in units of u_D^2 per row, there is no gap that could shrink: the number is NaN, null in verdict.json.
constexpr double no_gap = 1e-12;

// What one hypothesis predicts at the withheld points, by point and row: E over u_D, and how it moves with what is uncertain.
struct Prediction {
  std::vector<Eigen::VectorXd> error;        // (model - data)/u_D, inputs fitted
  std::vector<Eigen::MatrixXd> covariance;   // of it when nothing is missing
  std::vector<Eigen::MatrixXd> noise;        // its factor
  std::vector<Eigen::MatrixXd> projection;   // what the fit of the inputs leaves of an error
  std::vector<Eigen::MatrixXd> by_strength;  // (d model)/u_D per posterior standard deviation of a strength, inputs fitted again
  Eigen::MatrixXd strength_factor;           // of their posterior correlation
};

Eigen::VectorXd data_uncertainty(const PointSummary& point) { return point.covariance.diagonal().cwiseSqrt(); }

class HowFar {
 public:
  HowFar(Responses& model, const Attribution& attribution) : model_(model), attribution_(attribution) {}

  Prediction predict(const Fit& fit) {
    const auto& withheld = model_.withheld();
    const State state = withheld_state(fit);
    const State leading = lead_of(state);
    const auto responses = model_.run(state, withheld), lead = model_.run(leading, withheld), coarse = model_.run(leading, withheld, 2);
    std::vector<std::vector<Response>> moved_strength, moved_input;
    const int k = static_cast<int>(fit.linear.lower.size()), m = static_cast<int>(model_.nuisances().size());
    // What the fit leaves open of the effects: their strengths and the shares of their forms, by index in its linear model.
    std::vector<Eigen::Index> open;
    for (int e = 0; e < k; ++e) {
      State moved = state;
      const Effect& effect = model_.effects()[fit.hypothesis.effects[e]];
      moved.effects[e].second = std::clamp(state.effects[e].second + fit.theta_sd[e], effect.minimum, effect.maximum);
      moved_strength.push_back(model_.run(moved, withheld)), open.push_back(e);
    }
    for (Eigen::Index s = 0; s < state.shares.size() && k > 0; ++s) {
      State moved = state;
      open.push_back(k + m + s);
      moved.shares[s] += std::sqrt(fit.solution.covariance(open.back(), open.back()));
      moved_strength.push_back(model_.run(moved, withheld));
    }
    const auto n_open = static_cast<Eigen::Index>(open.size());
    Eigen::VectorXd posterior = Eigen::VectorXd::Ones(m);
    for (int j = 0; j < m; ++j) {
      State moved = leading;
      moved.nuisances[j] += 1;
      moved_input.push_back(model_.run(moved, withheld));
      if (!fit.hypothesis.effects.empty()) posterior[j] = std::sqrt(fit.solution.covariance(k + j, k + j));
    }
    Prediction prediction;
    for (std::size_t p = 0; p < withheld.size(); ++p) {
      const PointSummary& point = model_.points()[withheld[p]];
      const int g = point.n_gaussian;
      const Eigen::VectorXd u = data_uncertainty(point);
      const auto scaled = [&](const Response& a, const Response& b) {
        return Eigen::VectorXd((a.value - b.value).head(g).cwiseQuotient(u).unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; }));
      };
      Eigen::VectorXd data(g);
      for (int i = 0; i < g; ++i) data[i] = point.rows[i].value;
      const Eigen::VectorXd error = (responses[p].value.head(g) - data).cwiseQuotient(u);
      Eigen::MatrixXd strength(g, n_open), input(g, m);
      for (Eigen::Index e = 0; e < n_open; ++e) strength.col(e) = scaled(moved_strength[static_cast<std::size_t>(e)][p], responses[p]);
      for (int j = 0; j < m; ++j) input.col(j) = scaled(moved_input[j][p], lead[p]) * posterior[j];
      const Eigen::VectorXd scatter = responses[p].scatter.head(g).cwiseQuotient(u.cwiseAbs2()) / responses[p].n_runs;
      const Eigen::MatrixXd scale = u.cwiseInverse().asDiagonal();
      Eigen::MatrixXd V = scale * point.covariance * scale;
      V.diagonal() += scaled(coarse[p], lead[p]).cwiseAbs2() + scatter + Eigen::VectorXd::Constant(g, 1e-9);
      // The best inputs turn an error e into V (V + B B^T)^-1 e.
      const Eigen::MatrixXd projection = (V + input * input.transpose()).llt().solve(V).transpose();
      const Eigen::MatrixXd covariance = projection * V;
      prediction.error.push_back(projection * error.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; }));
      prediction.noise.push_back(
          Eigen::LLT<Eigen::MatrixXd>(0.5 * (covariance + covariance.transpose()) + 1e-9 * Eigen::MatrixXd::Identity(g, g)).matrixL());
      prediction.covariance.push_back(covariance), prediction.projection.push_back(projection);
      prediction.by_strength.push_back(projection * strength);
    }
    const Eigen::MatrixXd covariance = fit.solution.covariance(open, open);
    const Eigen::VectorXd sd = covariance.diagonal().cwiseSqrt();
    prediction.strength_factor = covariance.cwiseQuotient(sd * sd.transpose());
    if (n_open > 0) prediction.strength_factor = Eigen::LLT<Eigen::MatrixXd>(prediction.strength_factor).matrixL();
    return prediction;
  }

  // Correction without physics: at the training points the error of the base model is regressed on 1, t, t^2 and how far the base model has
  // come, observable by observable, with the smallest ridge that keeps it solvable.
  Prediction predict_regression(const Prediction& before) {
    const Fit& none = attribution_.fits.front();
    const auto features = [&](const PointSummary& point, const Response& response, int i) {
      const Row& row = point.rows[i];
      int first = i;
      while (first > 0 && point.rows[first - 1].observable == row.observable) --first;
      const double t = row.kind == Row::Kind::path ? row.end / std::max(point.duration, 1e-300) : 1;
      return Eigen::Vector4d(1, t, t * t, response.value[i] - response.value[first]);
    };
    const int n_observables = static_cast<int>(model_.experiment().observables.size());
    std::vector<Eigen::Matrix4d> A(n_observables, 1e-9 * Eigen::Matrix4d::Identity());
    std::vector<Eigen::Vector4d> b(n_observables, Eigen::Vector4d::Zero());
    for (std::size_t p = 0; p < model_.training().size(); ++p) {
      const PointSummary& point = model_.points()[model_.training()[p]];
      for (int i = 0; i < point.n_gaussian; ++i) {
        const Eigen::Vector4d f = features(point, none.at.responses[p], i);
        A[point.rows[i].observable] += f * f.transpose(),
            b[point.rows[i].observable] += f * (point.rows[i].value - none.at.responses[p].value[i]);
      }
    }
    Prediction after = before;
    const auto responses = model_.run(withheld_state(none), model_.withheld());
    for (std::size_t p = 0; p < model_.withheld().size(); ++p) {
      const PointSummary& point = model_.points()[model_.withheld()[p]];
      const Eigen::VectorXd u = data_uncertainty(point);
      Eigen::VectorXd correction(point.n_gaussian);
      for (int i = 0; i < point.n_gaussian; ++i) {
        const int o = point.rows[i].observable;
        const double scale = A[o].diagonal().maxCoeff();
        const Eigen::Vector4d c = (A[o] + 1e-9 * scale * Eigen::Matrix4d::Identity()).ldlt().solve(b[o]);
        correction[i] = c.dot(features(point, responses[p], i)) / u[i];
      }
      after.error[p] += after.projection[p] * correction;
    }
    return after;
  }

  // n_noise: how many realisations of the noise the error holds.
  static double excess(const Prediction& prediction, const std::vector<int>& points, double n_noise = 1) {
    double sum = 0;
    int n = 0;
    for (const int p : points) {
      sum += prediction.error[p].squaredNorm() - n_noise * prediction.covariance[p].trace();
      n += static_cast<int>(prediction.error[p].size());
    }
    return n > 0 ? std::max(0.0, sum / n) : 0;
  }

  static double floor(const Prediction& prediction, const std::vector<int>& points) {
    double sum = 0;
    int n = 0;
    for (const int p : points) sum += prediction.covariance[p].trace(), n += static_cast<int>(prediction.error[p].size());
    return n > 0 ? sum / n : 0;
  }

  std::vector<int> all_points() const {
    std::vector<int> points(model_.withheld().size());
    for (std::size_t p = 0; p < points.size(); ++p) points[p] = static_cast<int>(p);
    return points;
  }

  // Interval by resampling: points with replacement, and within each what the fit and the inputs leave open.
  Shrinkage shrinkage(const Prediction& before, const Prediction& after) const {
    const double G_before = excess(before, all_points());
    Shrinkage result;
    result.mean = G_before > no_gap ? 1 - excess(after, all_points()) / G_before : std::numeric_limits<double>::quiet_NaN();
    NormalNumbers random(model_.experiment().seed + 17);
    std::vector<double> draws;
    const int n = static_cast<int>(before.error.size());
    for (int k = 0; k < n_resamples; ++k) {
      std::vector<int> points(n);
      for (int& p : points) p = random.index(n);
      Prediction b = before, a = after;
      perturb(b, a, random);
      const double own = excess(b, points, 2);
      if (own > no_gap) draws.push_back(1 - excess(a, points, 2) / own);
    }
    std::sort(draws.begin(), draws.end());
    if (draws.empty() || std::isnan(result.mean)) return {result.mean, result.mean, result.mean};
    result.low = std::min(result.mean, draws[static_cast<std::size_t>(0.025 * static_cast<double>(draws.size() - 1))]);
    result.high = std::max(result.mean, draws[static_cast<std::size_t>(0.975 * static_cast<double>(draws.size() - 1))]);
    return result;
  }

 private:
  // The base model with all inputs as they are expected, or it would take up the effect with inputs far outside their band; with an
  // effect the fitted state. Nuisances that no training point shares stay at their expected value: they are what u_input is for.
  State withheld_state(const Fit& fit) const {
    if (fit.hypothesis.effects.empty()) return model_.base();
    State state = fit.at.state;
    for (std::size_t j = 0; j < model_.nuisances().size(); ++j) {
      const auto& training = model_.training();
      if (std::none_of(training.begin(), training.end(), [&](int p) { return model_.acts_at(static_cast<int>(j), p); }))
        state.nuisances[static_cast<Eigen::Index>(j)] = 0;
    }
    return state;
  }

  // Another strength within its posterior and another realisation of noise and inputs, the same before and after.
  static void perturb(Prediction& before, Prediction& after, NormalNumbers& random) {
    Eigen::VectorXd strength(after.strength_factor.cols());
    for (double& v : strength) v = random();
    strength = after.strength_factor * strength;
    for (std::size_t p = 0; p < after.error.size(); ++p) {
      Eigen::VectorXd noise(after.error[p].size());
      for (double& v : noise) v = random();
      if (strength.size() > 0) after.error[p] += after.by_strength[p] * strength;
      after.error[p] += after.noise[p] * noise, before.error[p] += before.noise[p] * noise;
    }
  }

  Responses& model_;
  const Attribution& attribution_;
};

}  // namespace

void measure_shrinkage(Responses& model, const Attribution& attribution, int chosen, Verdict& verdict) {
  const auto& withheld = model.withheld();
  const auto has_cells = [&](int p) { return model.points()[p].n_gaussian > 0; };
  if (std::count_if(withheld.begin(), withheld.end(), has_cells) < least_points) return;
  HowFar how_far(model, attribution);
  const Prediction before = how_far.predict(attribution.fits.front());
  const auto points = how_far.all_points();
  verdict.gap.before = verdict.gap.after = HowFar::excess(before, points);
  verdict.gap.floor = HowFar::floor(before, points);
  // The chosen one first: without it there is no gap after.
  std::vector<int> order;
  if (chosen > 0) order.push_back(chosen);
  for (int i = 1; i < static_cast<int>(attribution.fits.size()); ++i)
    if (i != chosen) order.push_back(i);
  for (const int i : order) {
    if (model.runs_left() < 2 * static_cast<int>(withheld.size())) {
      if (i == chosen) return;
      break;
    }
    const Prediction after = how_far.predict(attribution.fits[i]);
    const Shrinkage shrinkage = how_far.shrinkage(before, after);
    if (i != chosen) {
      verdict.shrinkage_rejected[attribution.names[i]] = shrinkage;
      continue;
    }
    verdict.shrinkage[attribution.names[i]] = shrinkage;
    verdict.gap.after = HowFar::excess(after, points), verdict.gap.floor = HowFar::floor(after, points);
  }
  verdict.gap.computable = true;
  // What no effect of the library takes away: the gap after beyond the floor.
  verdict.gap.remainder = verdict.gap.after;
  verdict.shrinkage_regression = how_far.shrinkage(before, how_far.predict_regression(before));
}

}  // namespace snag
