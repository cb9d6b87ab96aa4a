#pragma once
// The plateau of a study, for people and for scripts.
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "report/key_words.hpp"
#include "simulation/plateau.hpp"
#include "simulation/study.hpp"

namespace snag {

/// What a plateau was looked for in, with the words of its x and of its results.
struct PlateauQuestion {
  const PlateauSettings& settings;
  KeyWords x;
  std::vector<std::string> results;
};

/// The finding in a sentence: the recommended value and the range, or why there is none.
std::string plateau_in_words(const PlateauQuestion& question, const Plateau& plateau);
/// That sentence and a table of the groups, as HTML.
std::string plateau_section(const PlateauQuestion& question, const Plateau& plateau);
/// The same for scripts: plateau.json.
nlohmann::ordered_json plateau_json(const PlateauQuestion& question, const Plateau& plateau);

}  // namespace snag
