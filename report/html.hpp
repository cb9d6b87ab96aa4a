#pragma once
// Small pieces of HTML: numbers for people, tables, pictures inside the page.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace snag::html {

/// Four significant digits, "1.2 × 10⁻⁵" for what is far from one; "not a number" where it is none.
std::string number(double value);
/// With thin spaces between thousands.
std::string count(std::int64_t value);
/// "1.3 GB".
std::string bytes(double value);
/// Rows of cells that are HTML already; the first row of `header` cells may be empty.
std::string table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);
/// A PNG file as an address inside the page. Throws Error(io).
std::string embedded_png(const std::filesystem::path& file);

}  // namespace snag::html
