#pragma once
// A candidate that is another case instead of a strength: a set-point that was misread, another geometry, another inlet. It is there or
// not; nothing of it is fitted.
#include <map>
#include <string>
#include <vector>

#include "base/case_file.hpp"
#include "diagnosis/data/simulator.hpp"

namespace snag {

struct Alternative {
  std::string effect;                                  // name of the candidate
  std::string meaning;                                 // in words
  std::vector<std::string> set;                        // values of the case, "section.key=value", at every point
  std::map<std::string, std::vector<std::string>> at;  // the same by point, after those
};

/// [[alternative]] of DIAGNOSIS.toml. `points`: names of the operating points. Throws Error(usage).
std::vector<Alternative> read_alternatives(const Table& root, const std::vector<std::string>& points);
/// Its tables, for the manual.
std::vector<Section> alternative_sections();

/// What the cases take of it at a point.
std::vector<std::string> overrides_at(const Alternative& alternative, const std::string& point);

/// The effects with those replaced that stand as alternatives, and those added that have new names.
void set_alternatives(std::vector<Effect>& effects, const std::vector<Alternative>& alternatives);

}  // namespace snag
