#include "diagnosis/judgement/next_experiment.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "base/words.hpp"

namespace snag {

namespace {

// T of one observable at one point, rows begin .. end.
Separation separation(const Responses& model, std::size_t p, const Predictions& predictions, int begin, int end, int n_repeats) {
  const PointSummary& point = model.points()[model.training()[p]];
  const int n = end - begin;
  const Row& first = point.rows[begin];
  const Eigen::VectorXd difference = finite(predictions.difference.segment(begin, n));
  // Of two rows the repeats of one are among those of the other: their noise is divided by the larger number.
  Eigen::MatrixXd C = point.covariance.block(begin, begin, n, n) / n_repeats;
  const auto measured = [&](int i) { return std::max(1, point.rows[static_cast<std::size_t>(begin + i)].n_replicates); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) C(i, j) *= std::max(measured(i), measured(j));
  const Eigen::VectorXd numerical = predictions.numerical_error.segment(begin, n);
  C += numerical * numerical.transpose();
  for (const Eigen::VectorXd& all : predictions.by_input) {
    const Eigen::VectorXd change = all.segment(begin, n);
    if (change.allFinite()) C += change * change.transpose();
  }
  C.diagonal().array() += 1e-9 * C.diagonal().mean() + 1e-300;
  // Draws of chance differ whatever the hypotheses are: E d . C^-1 d = T + tr(C^-1 V).
  const Eigen::LLT<Eigen::MatrixXd> factor(C);
  const Eigen::MatrixXd chance =
      predictions.chance.size() > 0 ? Eigen::MatrixXd(predictions.chance.segment(begin, n).asDiagonal()) : Eigen::MatrixXd::Zero(n, n);
  Separation result{std::max(0.0, difference.dot(factor.solve(difference)) - factor.solve(chance).trace()),
                    model.experiment().observables[first.observable].id, model.experiment().points[point.point].id, first.begin};
  double largest = 0;
  for (int i = 0; i < n; ++i) {
    const double size = std::abs(difference[i]) / std::sqrt(C(i, i));
    if (size > largest) largest = size, result.time = 0.5 * (point.rows[begin + i].begin + point.rows[begin + i].end);
  }
  return result;
}

Predictions predictions_of(const Fit& a, const Fit& b, std::size_t p) {
  Predictions predictions{a.at.responses[p].value - b.at.responses[p].value, a.at.numerical_error[p], {}};
  for (const auto& by_nuisance : a.at.by_nuisance)
    if (by_nuisance[p].value.size() > 0) predictions.by_input.push_back((by_nuisance[p].value - a.at.origin[p].value) / nuisance_step);
  return predictions;
}

// The same of a row with a likelihood of its own, by the variance of one replicate; spreads are no measurement of one.
Separation separation(const Responses& model, const Fit& a, const Fit& b, std::size_t p, int row, int n_repeats) {
  const PointSummary& point = model.points()[model.training()[p]];
  const Row& own = point.rows[row];
  const double difference = a.at.responses[p].value[row] - b.at.responses[p].value[row],
               mean = 0.5 * (a.at.responses[p].value[row] + b.at.responses[p].value[row]);
  double variance = 0;
  if (own.kind == Row::Kind::time) variance = own.sigma * own.sigma;
  if (own.kind == Row::Kind::count) variance = mean * std::max(1.0, own.sigma);
  if (own.kind == Row::Kind::event) variance = mean * (1 - mean);
  Separation result{0, model.experiment().observables[own.observable].id, model.experiment().points[point.point].id, own.begin};
  if (!std::isfinite(difference) || !(variance > 0)) return result;
  const Predictions predictions = predictions_of(a, b, p);
  variance = variance / n_repeats + std::pow(predictions.numerical_error[row], 2);
  for (const Eigen::VectorXd& change : predictions.by_input)
    if (std::isfinite(change[row])) variance += change[row] * change[row];
  result.T = difference * difference / variance;
  return result;
}

// Where the fit leaves most, summed over the rows of an observable at a point.
std::string what_remains(const Responses& model, const Fit& fit) {
  std::map<std::pair<std::string, std::string>, double> left;  // by observable and point
  for (std::size_t p = 0; p < model.training().size(); ++p) {
    const PointSummary& point = model.points()[model.training()[p]];
    for (std::size_t i = 0; i < point.rows.size(); ++i)
      left[{model.experiment().observables[point.rows[i].observable].id, model.experiment().points[point.point].id}] +=
          std::pow(fit.residual[fit.first_row[p] + static_cast<int>(i)], 2);
  }
  const auto most = std::max_element(left.begin(), left.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return "What no effect explains shows most in " + most->first.first + " at point " + most->first.second +
         ": measured at further operating points around it, it would show what the missing cause depends on.";
}

/// More digits are not known of a prediction.
std::string two_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

/// A hypothesis in a sentence.
std::string spoken(std::string name) {
  if (name == "none") return "no missing effect";
  if (const auto plus = name.find('+'); plus != std::string::npos) name.replace(plus, 1, " with ");
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

}  // namespace

Separation best_separation(const Responses& model, std::size_t training_point, const Predictions& predictions, int n_repeats) {
  const PointSummary& point = model.points()[model.training()[training_point]];
  Separation best;
  for (int begin = 0, end = 0; begin < point.n_gaussian; begin = end) {
    while (end < point.n_gaussian && point.rows[end].observable == point.rows[begin].observable) ++end;
    Separation tried = separation(model, training_point, predictions, begin, end, n_repeats);
    if (tried.T > best.T) best = std::move(tried);
  }
  return best;
}

namespace {

Separation repeats_that_tell_most(const Responses& model, const Fit& a, const Fit& b, int n_repeats) {
  Separation best;
  for (std::size_t p = 0; p < model.training().size(); ++p) {
    if (Separation tried = best_separation(model, p, predictions_of(a, b, p), n_repeats); tried.T > best.T) best = std::move(tried);
    const PointSummary& point = model.points()[model.training()[p]];
    for (int row = point.n_gaussian; row < static_cast<int>(point.rows.size()); ++row)
      if (Separation tried = separation(model, a, b, p, row, n_repeats); tried.T > best.T) best = std::move(tried);
  }
  return best;
}

// The fewest repeats with which a measurement separates the two; 0: no number up to `most` does.
int repeats_needed(const Responses& model, const Fit& a, const Fit& b, double wanted_T, int most) {
  if (repeats_that_tell_most(model, a, b, most).T < wanted_T) return 0;
  int too_few = 0, enough = most;
  while (enough - too_few > 1) {
    const int n = (too_few + enough) / 2;
    (repeats_that_tell_most(model, a, b, n).T < wanted_T ? too_few : enough) = n;
  }
  return enough;
}

}  // namespace

double best_repeat(const Responses& model, const Fit& a, const Fit& b) { return repeats_that_tell_most(model, a, b, 1).T; }

int rival_of(const Attribution& attribution, int fit) {
  int rival = -1;
  for (int i = 0; i < static_cast<int>(attribution.fits.size()); ++i)
    if (i != fit && (rival < 0 || attribution.weight[i] > attribution.weight[rival])) rival = i;
  return rival;
}

std::string next_experiment(const Responses& model, const Attribution& attribution, bool unexplained) {
  const int first = attribution.first();
  if (unexplained) return what_remains(model, attribution.fits[first]);
  const int second = rival_of(attribution, first);
  if (second < 0) return "";
  const Fit &a = attribution.fits[first], &b = attribution.fits[second];
  // Derivatives by the inputs are known where a fit linearized them.
  if (a.at.by_nuisance.empty() && !model.nuisances().empty()) return "";
  const std::string both = spoken(attribution.names[first]) + " from " + spoken(attribution.names[second]);
  constexpr double wanted_nats = 6;
  constexpr int most_replicates = 1000;
  const int replicates = repeats_needed(model, a, b, 2 * wanted_nats, most_replicates);
  if (replicates == 0)
    return "No number of repeats of these measurements would distinguish " + both + "; that needs another operating point or observable.";
  const Separation best = repeats_that_tell_most(model, a, b, replicates);
  return "To distinguish " + both + ", repeat the measurement of " + best.observable + " at point " + best.point +
         (std::isnan(best.time) ? "" : ", especially near t = " + number_text(best.time) + " s") +
         ": there their predictions differ most, by " + two_digits(std::sqrt(best.T)) + " standard uncertainties of " +
         (replicates > 1
              ? "the mean of " + std::to_string(replicates) + " repeats. " + std::to_string(replicates) + " more repeats are enough."
              : "one repeat. One more repeat is enough.");
}

}  // namespace snag
