#include "report/html.hpp"

#include <openssl/evp.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "base/atomic_file.hpp"
#include "base/error.hpp"

namespace snag::html {

namespace {

template <class... Values>
std::string printed(const char* format, Values... values) {
  char text[64];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

}  // namespace

std::string number(double value) {
  if (!std::isfinite(value)) return std::isnan(value) ? "not a number" : value < 0 ? "−infinite" : "infinite";
  const double size = std::abs(value);
  if (value == 0) return "0";
  if (size >= 1e-3 && size < 1e5) return printed("%.4g", value);
  const std::string text = printed("%.3e", value);
  const auto split = text.find('e');
  std::string mantissa = text.substr(0, split);
  while (mantissa.back() == '0') mantissa.pop_back();
  if (mantissa.back() == '.') mantissa.pop_back();
  const int exponent = std::atoi(text.c_str() + split + 1);
  const std::string factor = mantissa == "1" ? "" : mantissa == "-1" ? "-" : mantissa + " × ";
  return factor + "10<sup>" + (exponent < 0 ? "−" : "") + std::to_string(std::abs(exponent)) + "</sup>";
}

std::string count(std::int64_t value) {
  std::string digits = std::to_string(value);
  for (int at = static_cast<int>(digits.size()) - 3; at > (value < 0 ? 1 : 0); at -= 3) digits.insert(at, "\u2009");
  return digits;
}

std::string bytes(double value) {
  const char* const units[] = {"bytes", "kB", "MB", "GB", "TB"};
  int unit = 0;
  while (value >= 1000 && unit < 4) value /= 1000, ++unit;
  return printed("%.3g ", value) + units[unit];
}

std::string table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows) {
  std::string result = "<table>\n";
  const auto row = [&](const char* tag, const std::vector<std::string>& cells) {
    result += "<tr>";
    for (const auto& cell : cells) result += std::string("<") + tag + ">" + cell + "</" + tag + ">";
    result += "</tr>\n";
  };
  if (!header.empty()) row("th", header);
  for (const auto& cells : rows) row("td", cells);
  return result + "</table>\n";
}

std::string embedded_png(const std::filesystem::path& file) {
  const std::string content = file_text(file).value_or("");
  if (!content.starts_with("\x89PNG"))
    throw Error(ExitCode::io, file.string() + ": is not a PNG picture; remove it and make the report again");
  std::string code(4 * ((content.size() + 2) / 3) + 1, '\0');  // the library ends it with a null
  const int length = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(code.data()), reinterpret_cast<const unsigned char*>(content.data()),
                                     static_cast<int>(content.size()));
  code.resize(length);
  return "data:image/png;base64," + code;
}

}  // namespace snag::html
