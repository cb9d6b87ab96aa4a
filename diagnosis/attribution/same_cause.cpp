#include "diagnosis/attribution/same_cause.hpp"

#include <algorithm>
#include <cmath>

namespace snag {

namespace {

constexpr double alike = 0.999, seen = 1;

/// What an effect of a fit adds, whitened as `by` is; empty where that is not known. Of a row with a likelihood of its own: the derivative
/// of its residual times the strength.
Eigen::VectorXd added(const Responses& model, const Fit& fit, int effect, const Fit& by) {
  const auto& effects = fit.hypothesis.effects;
  const auto e = static_cast<std::size_t>(std::find(effects.begin(), effects.end(), effect) - effects.begin());
  if (fit.at.parts.size() != effects.size()) return {};
  const auto column = static_cast<Eigen::Index>(e);
  Eigen::VectorXd all = -fit.linear.J.col(column) * (fit.theta[column] / model.effects()[static_cast<std::size_t>(effect)].sd);
  for (std::size_t p = 0; p + 1 < by.first_row.size(); ++p)
    if (const Eigen::Index g = by.whitening.factor[p].rows(); g > 0)
      all.segment(by.first_row[p], g) = by.whitening.factor[p].matrixL().solve(fit.at.parts[e][p].head(g));
  return all;
}

bool is_same(const Responses& model, const Fit& fit, int effect, const Fit& other, int instead) {
  const Eigen::VectorXd a = added(model, fit, effect, fit), b = added(model, other, instead, fit);
  if (a.size() == 0 || b.size() == 0) return false;
  const Eigen::Index bounded = fit.linear.lower.size();
  const auto J = fit.linear.J.middleCols(bounded, fit.linear.J.cols() - bounded - fit.at.state.shares.size());
  const Eigen::LLT<Eigen::MatrixXd> precision(J.transpose() * J + Eigen::MatrixXd::Identity(J.cols(), J.cols()));
  const auto projected = [&](const Eigen::VectorXd& v) -> Eigen::VectorXd { return v - J * precision.solve(J.transpose() * v); };
  const double aa = a.dot(projected(a)), bb = b.dot(projected(b)), ab = a.dot(projected(b));
  if (!(aa > 0) || !(bb > 0)) return false;
  const double cosine = ab / std::sqrt(aa * bb);
  return cosine > alike && std::sqrt(aa * std::max(0.0, 1 - cosine * cosine)) < seen;
}

/// Index of the fit of these effects, in any order; -1: there is none.
int fit_of(const Attribution& attribution, std::vector<int> effects) {
  std::sort(effects.begin(), effects.end());
  for (int i = 0; i < static_cast<int>(attribution.fits.size()); ++i) {
    std::vector<int> own = attribution.fits[static_cast<std::size_t>(i)].hypothesis.effects;
    std::sort(own.begin(), own.end());
    if (own == effects) return i;
  }
  return -1;
}

}  // namespace

std::vector<int> same_causes(const Responses& model, const Attribution& attribution, int fit, int effect) {
  const Fit& own = attribution.fits[static_cast<std::size_t>(fit)];
  std::vector<int> others, same;
  for (const Fit& any : attribution.fits)
    for (const int k : any.hypothesis.effects)
      if (std::count(own.hypothesis.effects.begin(), own.hypothesis.effects.end(), k) == 0) others.push_back(k);
  std::sort(others.begin(), others.end());
  others.erase(std::unique(others.begin(), others.end()), others.end());
  for (const int k : others) {
    std::vector<int> swapped = own.hypothesis.effects;
    std::replace(swapped.begin(), swapped.end(), effect, k);
    // `with` and `instead`: the fit of the same set with the other effect in its place, or those of both alone.
    const int here = fit_of(attribution, swapped);
    const int with = here >= 0 ? fit : fit_of(attribution, {effect}), instead = here >= 0 ? here : fit_of(attribution, {k});
    if (with < 0 || instead < 0 || attribution.log_evidence(instead) < attribution.log_evidence(with) - nats_of_rule) continue;
    if (is_same(model, attribution.fits[static_cast<std::size_t>(with)], effect, attribution.fits[static_cast<std::size_t>(instead)], k))
      same.push_back(k);
  }
  return same;
}

}  // namespace snag
