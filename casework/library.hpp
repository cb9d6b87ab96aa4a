#pragma once
// The candidates that are values of a case: forces by the priors on their descriptions, and settings of the particles.
#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/prior.hpp"
#include "diagnosis/effects/effect_model.hpp"

namespace snag {

struct CatalogueEffect {
  std::string name;
  Prior prior;
  bool is_force = false;
  std::vector<std::string> forms{};     // of a force that is written in several: values of its key `form`, the usual one first
  std::vector<std::string> added_to{};  // of a setting: keys whose value in the base case theta changes; empty: theta is the value
  Candidate setting{};                  // how it changes them

  int n_forms() const { return static_cast<int>(std::max({std::size_t{1}, forms.size(), 1 + setting.other_keys.size()})); }
  /// Keys and values of a run with a form by its index; `base` gives the value of a key of the base case.
  std::vector<std::string> overrides(double theta, int form, std::uint64_t seed,
                                     const std::function<std::string(const std::string&)>& base) const;
};

/// The override that gives a random force of a run its seed.
std::string seed_of(const std::string& force, std::uint64_t seed);

/// Null if there is none of that name.
const CatalogueEffect* catalogue_effect(const std::string& name);
/// Sorted by name.
const std::vector<CatalogueEffect>& effect_catalogue();

}  // namespace snag
