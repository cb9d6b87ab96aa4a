#include "diagnosis/judgement/shrinkage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/words.hpp"
#include "diagnosis/fitting/numerical_error.hpp"
#include "diagnosis/judgement/excess_gap.hpp"

namespace snag {

namespace {

constexpr int least_points = 3;

Eigen::VectorXd data_uncertainty(const PointSummary& point) { return point.covariance.diagonal().cwiseSqrt(); }

/// What fits say of the withheld points.
class Prediction {
 public:
  Prediction(Responses& model, const Attribution& attribution) : model_(model), attribution_(attribution) {}

  WithheldError predict(const Fit& fit) {
    const auto& withheld = model_.withheld();
    const State state = withheld_state(fit);
    const State leading = lead_of(state);
    const auto responses = model_.run(state, withheld), lead = model_.run(leading, withheld);
    const auto step_error = numerical_error(model_, leading, withheld, lead);
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
    WithheldError prediction;
    for (std::size_t p = 0; p < withheld.size(); ++p) {
      const PointSummary& point = model_.points()[withheld[p]];
      const int g = point.n_gaussian;
      const Eigen::VectorXd u = data_uncertainty(point);
      const auto scaled = [&](const Response& a, const Response& b) { return finite((a.value - b.value).head(g).cwiseQuotient(u)); };
      Eigen::VectorXd data(g);
      for (int i = 0; i < g; ++i) data[i] = point.rows[i].value;
      const Eigen::VectorXd error = (responses[p].value.head(g) - data).cwiseQuotient(u);
      Eigen::MatrixXd strength(g, n_open), input(g, m);
      for (Eigen::Index e = 0; e < n_open; ++e) strength.col(e) = scaled(moved_strength[static_cast<std::size_t>(e)][p], responses[p]);
      for (int j = 0; j < m; ++j) input.col(j) = scaled(moved_input[j][p], lead[p]) * posterior[j];
      const Eigen::MatrixXd scale = u.cwiseInverse().asDiagonal();
      const Eigen::MatrixXd V = scale * model_covariance(point, responses[p], step_error[p], {}) * scale;
      // The best inputs turn an error e into V (V + B B^T)^-1 e.
      const Eigen::MatrixXd projection = (V + input * input.transpose()).llt().solve(V).transpose();
      const Eigen::MatrixXd covariance = projection * V;
      prediction.error.push_back(projection * finite(error));
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
  WithheldError predict_regression(const WithheldError& before) {
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
    WithheldError after = before;
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

  Responses& model_;
  const Attribution& attribution_;
};

}  // namespace

void measure_shrinkage(Responses& model, const Attribution& attribution, int chosen, Verdict& verdict) {
  const auto& withheld = model.withheld();
  const auto has_cells = [&](int p) { return model.points()[p].n_gaussian > 0; };
  if (std::count_if(withheld.begin(), withheld.end(), has_cells) < least_points) return;
  Prediction prediction(model, attribution);
  const WithheldError before = prediction.predict(attribution.fits.front());
  verdict.gap.before = verdict.gap.after = excess_gap(before);
  verdict.gap.floor = noise_floor(before);
  const std::uint64_t seed = model.experiment().seed;
  if (const double noise = excess_of_noise(before, seed); chosen > 0 && verdict.gap.before <= noise)
    verdict.notes.push_back("The withheld points show no gap (excess " + number_text(verdict.gap.before) + ", noise alone makes up to " +
                            number_text(noise) +
                            "): the shrinkage cannot be estimated from them. Withhold points where the effect is larger.");
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
    const WithheldError after = prediction.predict(attribution.fits[i]);
    const Shrinkage shrunk = shrinkage(before, after, seed);
    if (i != chosen) {
      verdict.shrinkage_rejected[attribution.names[i]] = shrunk;
      continue;
    }
    verdict.shrinkage[attribution.names[i]] = shrunk;
    verdict.gap.after = excess_gap(after), verdict.gap.floor = noise_floor(after);
  }
  verdict.gap.computable = true;
  // What no effect of the library takes away: the gap after beyond the floor.
  verdict.gap.remainder = verdict.gap.after;
  verdict.shrinkage_regression = shrinkage(before, prediction.predict_regression(before), seed);
}

}  // namespace snag
