#include "diagnosis/data/posterior_draws.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <nlohmann/json.hpp>

#include "base/version.hpp"

namespace snag {

namespace {

using Json = nlohmann::ordered_json;

/// Nine significant digits: strengths with a small scatter keep five of it.
double shortened(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return std::strtod(text, nullptr);
}

}  // namespace

double mean_of(const std::vector<double>& draws) {
  double sum = 0;
  for (const double value : draws) sum += value;
  return sum / static_cast<double>(draws.size());
}

double correlation_of(const PosteriorDraws::Variable& a, const PosteriorDraws::Variable& b) {
  const double mean_a = mean_of(a.draws), mean_b = mean_of(b.draws);
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.draws.size(); ++i) {
    const double x = a.draws[i] - mean_a, y = b.draws[i] - mean_b;
    ab += x * y, aa += x * x, bb += y * y;
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

std::string posterior_json(const PosteriorDraws& posterior) {
  constexpr int length = n_posterior_draws / n_posterior_chains;
  Json draws = Json::object(), units = Json::object();
  for (const PosteriorDraws::Variable& variable : posterior.variables) {
    Json& chains = draws[variable.name] = Json::array();
    for (int c = 0; c < n_posterior_chains; ++c) {
      chains.push_back(Json::array());
      for (int i = 0; i < length; ++i) chains.back().push_back(shortened(variable.draws[static_cast<std::size_t>(c * length + i)]));
    }
    units[variable.name] = variable.unit;
  }
  Json json{{"posterior", draws}};
  // Attributes of netCDF are texts and numbers.
  json["posterior_attrs"] = {{"inference_library", "snag"},
                             {"inference_library_version", version_number},
                             {"hypothesis", posterior.hypothesis},
                             {"units", units.dump()}};
  return json.dump() + "\n";
}

}  // namespace snag
