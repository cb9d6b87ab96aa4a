#include "diagnosis/fitting/numerical_error.hpp"

#include <algorithm>
#include <cmath>

namespace snag {

namespace {

// What the experiment states of each row, NaN where it does not.
std::vector<Eigen::VectorXd> stated_error(const Responses& model, const std::vector<int>& points) {
  std::vector<Eigen::VectorXd> errors;
  for (const int p : points) {
    const auto& rows = model.points()[p].rows;
    errors.emplace_back(static_cast<Eigen::Index>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i)
      errors.back()[static_cast<Eigen::Index>(i)] = model.experiment().observables[rows[i].observable].numerics_u;
  }
  return errors;
}

}  // namespace

std::vector<Eigen::VectorXd> numerical_error(Responses& model, const State& state, const std::vector<int>& points,
                                             const std::vector<Response>& responses) {
  std::vector<Eigen::VectorXd> stated = stated_error(model, points);
  if (std::all_of(stated.begin(), stated.end(), [](const Eigen::VectorXd& e) { return e.allFinite(); })) return stated;
  const auto coarse = model.run(state, points, 2);
  std::vector<Eigen::VectorXd> errors;
  std::vector<Responses::Request> again;
  for (std::size_t p = 0; p < coarse.size(); ++p) {
    if (!coarse[p].failure.empty()) again.push_back({state, points[p], 0.5});
  }
  // A step that is too coarse to run at all: then from half the step.
  const auto fine = again.empty() ? std::vector<Response>{} : model.run(again);
  std::size_t next = 0;
  for (std::size_t p = 0; p < coarse.size(); ++p) {
    Eigen::VectorXd error = !coarse[p].failure.empty() ? Eigen::VectorXd(2 * (responses[p].value - fine[next].value))
                                                       : Eigen::VectorXd(coarse[p].value - responses[p].value);
    if (!coarse[p].failure.empty()) ++next;
    // The difference of means of chance runs holds chance.
    for (Eigen::Index i = 0; i < error.size(); ++i) {
      const double chance = (responses[p].scatter[i] + coarse[p].scatter[i]) / responses[p].n_runs;
      if (responses[p].n_runs > 1) error[i] = std::copysign(std::sqrt(std::max(0.0, error[i] * error[i] - chance)), error[i]);
      if (std::isfinite(stated[p][i])) error[i] = stated[p][i];
    }
    errors.push_back(finite(error));
  }
  return errors;
}

}  // namespace snag
