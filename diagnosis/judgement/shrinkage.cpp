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

/// Gaussian rows of each withheld point that are compared.
using ComparedRows = std::vector<std::vector<int>>;

/// What fits say of the withheld points.
class Prediction {
 public:
  Prediction(Responses& model, const Attribution& attribution) : model_(model), attribution_(attribution) {}

  /// Those for which the fit has a number; empty, and why, where a run fails. The base model has one for all.
  ComparedRows rows_with_answer(const Fit& fit, std::string& failure) {
    ComparedRows rows;
    const auto responses = model_.run(withheld_state(fit), model_.withheld());
    for (std::size_t p = 0; p < responses.size(); ++p) {
      if (!responses[p].failure.empty()) {
        failure = "at point " + model_.experiment().points[static_cast<std::size_t>(model_.withheld()[p])].id + ": " + responses[p].failure;
        return {};
      }
      rows.emplace_back();
      for (int i = 0; i < model_.points()[model_.withheld()[p]].n_gaussian; ++i)
        if (std::isfinite(responses[p].value[i])) rows.back().push_back(i);
    }
    return rows;
  }

  WithheldError predict(const Fit& fit, const ComparedRows& compared) {
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
      const std::vector<int>& rows = compared[p];
      const auto g = std::ssize(rows);
      const Eigen::VectorXd u = data_uncertainty(point)(rows);
      const auto scaled = [&](const Response& a, const Response& b) {
        return Eigen::VectorXd(finite((a.value - b.value)(rows)).cwiseQuotient(u));
      };
      Eigen::VectorXd data(g);
      for (Eigen::Index i = 0; i < g; ++i) data[i] = point.rows[static_cast<std::size_t>(rows[static_cast<std::size_t>(i)])].value;
      const Eigen::VectorXd error = (Eigen::VectorXd(responses[p].value(rows)) - data).cwiseQuotient(u);
      Eigen::MatrixXd strength(g, n_open), input(g, m);
      for (Eigen::Index e = 0; e < n_open; ++e) strength.col(e) = scaled(moved_strength[static_cast<std::size_t>(e)][p], responses[p]);
      for (int j = 0; j < m; ++j) input.col(j) = scaled(moved_input[j][p], lead[p]) * posterior[j];
      const Eigen::MatrixXd scale = u.cwiseInverse().asDiagonal();
      const Eigen::MatrixXd all = model_covariance(point, responses[p], step_error[p], {});
      const Eigen::MatrixXd V = scale * Eigen::MatrixXd(all(rows, rows)) * scale;
      // The best inputs turn an error e into V (V + B B^T)^-1 e.
      const Eigen::MatrixXd projection = (V + input * input.transpose()).llt().solve(V).transpose();
      const Eigen::MatrixXd covariance = projection * V;
      prediction.error.push_back(projection * error);
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

std::int64_t n_rows(const ComparedRows& rows) {
  std::int64_t n = 0;
  for (const std::vector<int>& of_point : rows) n += std::ssize(of_point);
  return n;
}

}  // namespace

void measure_shrinkage(Responses& model, const Attribution& attribution, int chosen, Verdict& verdict) {
  const auto& withheld = model.withheld();
  const auto n_points = [](const ComparedRows& rows) {
    return std::count_if(rows.begin(), rows.end(), [](const auto& of_point) { return !of_point.empty(); });
  };
  Prediction prediction(model, attribution);
  std::string failure;
  const ComparedRows all = prediction.rows_with_answer(attribution.fits.front(), failure);
  if (n_points(all) < least_points) return;
  const WithheldError before = prediction.predict(attribution.fits.front(), all);
  verdict.gap.before = verdict.gap.after = excess_gap(before);
  verdict.gap.floor = noise_floor(before);
  const std::uint64_t seed = model.experiment().seed;
  const auto note_small_gap = [&](const WithheldError& base) {
    const double gap = excess_gap(base), noise = excess_of_noise(base, seed);
    if (gap <= noise)
      verdict.notes.push_back("The withheld points show no gap (excess " + number_text(gap) + ", noise alone makes up to " +
                              number_text(noise) +
                              "): the shrinkage cannot be estimated from them. Withhold points where the effect is larger.");
  };
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
    const ComparedRows both = prediction.rows_with_answer(attribution.fits[i], failure);
    if (n_points(both) < least_points) {
      if (i != chosen) continue;
      verdict.notes.push_back("The shrinkage at the withheld points is not known: with " + attribution.names[i] +
                              (failure.empty() ? " fewer than three of them have numbers to compare." : " the run fails " + failure));
      return;
    }
    const WithheldError base = both == all ? before : prediction.predict(attribution.fits.front(), both);
    const WithheldError after = prediction.predict(attribution.fits[i], both);
    const Shrinkage shrunk = shrinkage(base, after, seed);
    if (i != chosen) {
      verdict.shrinkage_rejected[attribution.names[i]] = shrunk;
      continue;
    }
    verdict.shrinkage[attribution.names[i]] = shrunk;
    note_small_gap(base);
    verdict.gap.before = excess_gap(base), verdict.gap.after = excess_gap(after), verdict.gap.floor = noise_floor(after);
    if (both != all)
      verdict.notes.push_back("The shrinkage at the withheld points is that of " + std::to_string(n_rows(both)) + " of " +
                              counted(n_rows(all), "row") + ": the runs with " + attribution.names[i] + " have no number for the others.");
  }
  verdict.gap.computable = true;
  // What no effect of the library takes away: the gap after beyond the floor.
  verdict.gap.remainder = verdict.gap.after;
  verdict.shrinkage_regression = shrinkage(before, prediction.predict_regression(before), seed);
}

}  // namespace snag
