#pragma once
// Numbers, points and lists as text, for messages and files; and the way back.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec3.hpp"

namespace snag {

/// Six significant digits: "0.001", "1.2e-06".
std::string number_text(double value);
/// Three significant digits: "0.00123", "1.2e-06".
std::string rounded(double value);
/// "(0.1, 0.2, 1e-05) m".
std::string point_text(const Vec3& x);
/// "a, b, c".
std::string joined(const std::vector<std::string>& words);
/// The parts between the separators, empty ones included; at least one.
std::vector<std::string> split(std::string_view text, char separator);
/// "1 rank", "2 ranks".
std::string counted(std::int64_t n, const std::string& noun);
/// "water_000120": files sort as time goes.
std::string numbered(const std::string& stem, std::int64_t number);
/// Text as it stands in XML and HTML: & < > " are written as entities.
std::string escaped(std::string_view text);
/// The candidate nearest to a misspelt word (edit distance), or "" if none is near.
std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace snag
