#pragma once
// Draws from a posterior, and posterior.json: groups of ArviZ's InferenceData as arviz.from_json reads them.
#include <string>
#include <vector>

namespace snag {

/// Independent draws: ArviZ compares chains, so they are written as four of equal length.
inline constexpr int n_posterior_chains = 4, n_posterior_draws = 2000;

struct PosteriorDraws {
  struct Variable {
    std::string name, unit;   // of an effect, or of an input as verdict.json names it
    bool is_strength = true;  // of an effect; else the deviation of an input, in standard uncertainties
    std::vector<double> draws{};
  };
  std::string hypothesis;             // under which they are drawn; empty: there are none
  std::vector<Variable> variables{};  // strengths first
};

double mean_of(const std::vector<double>& draws);
/// Correlation of two variables over the draws.
double correlation_of(const PosteriorDraws::Variable& a, const PosteriorDraws::Variable& b);

/// The content of posterior.json: {"posterior": {variable: [chain][draw]}, "posterior_attrs": {...}}.
/// Source: ArviZ, InferenceData schema specification; arviz/data/io_json.py hands the groups to from_dict.
std::string posterior_json(const PosteriorDraws& posterior);

}  // namespace snag
