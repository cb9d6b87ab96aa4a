#include "tests/fuzz/mutation.hpp"

#include <algorithm>
#include <array>
#include <random>

namespace snag::fuzz {
namespace {

using Random = std::mt19937_64;

std::size_t below(Random& random, std::size_t n) { return n == 0 ? 0 : random() % n; }

/// Numbers and words at which readers break.
std::string trap(Random& random) {
  static const std::array<std::string, 28> traps{"-1",
                                                 "0",
                                                 "1",
                                                 "2147483647",
                                                 "2147483648",
                                                 "-2147483648",
                                                 "4294967296",
                                                 "9223372036854775807",
                                                 "-9223372036854775808",
                                                 "1e308",
                                                 "-1e308",
                                                 "1e-308",
                                                 "1e400",
                                                 "nan",
                                                 "inf",
                                                 "-inf",
                                                 "1000000000",
                                                 "\"",
                                                 "[",
                                                 "]",
                                                 ",",
                                                 "\n",
                                                 "=",
                                                 "{}",
                                                 "\"\"",
                                                 "[[1]]",
                                                 "1 mm",
                                                 "\xff\xfe"};
  return below(random, 20) == 0 ? std::string(5000, 'x') : traps[below(random, traps.size())];
}

/// Where a word of letters, digits, signs begins and ends; the whole text if there is none near.
std::pair<std::size_t, std::size_t> word_at(const std::string& text, std::size_t at) {
  const auto belongs = [](unsigned char c) { return std::isalnum(c) || c == '.' || c == '-' || c == '+' || c == '_'; };
  std::size_t begin = at;
  while (begin < text.size() && !belongs(text[begin])) ++begin;
  while (begin > 0 && belongs(text[begin - 1])) --begin;
  std::size_t end = begin;
  while (end < text.size() && belongs(text[end])) ++end;
  return {begin, end};
}

std::pair<std::size_t, std::size_t> line_at(const std::string& text, std::size_t at) {
  const std::size_t before = at == 0 ? std::string::npos : text.rfind('\n', at - 1), after = text.find('\n', at);
  return {before == std::string::npos ? 0 : before + 1, after == std::string::npos ? text.size() : after + 1};
}

void change_bytes(std::string& text, Random& random) {
  const std::size_t n = 1 + below(random, 4);
  for (std::size_t i = 0; i < n && !text.empty(); ++i) {
    char& c = text[below(random, text.size())];
    c = below(random, 2) == 0 ? static_cast<char>(c ^ (1 << below(random, 8))) : static_cast<char>(random());
  }
}

/// Four or eight bytes as binary files hold numbers.
void change_binary_number(std::string& text, Random& random) {
  static const std::array<std::uint64_t, 8> values{
      0, 1, 0x7fffffff, 0x80000000, 0xffffffff, 0x7fffffffffffffff, 0xffffffffffffffff, 0x7ff8000000000000};
  const std::uint64_t value = values[below(random, values.size())];
  const std::size_t n = below(random, 2) == 0 ? 4 : 8, at = below(random, text.size());
  for (std::size_t i = 0; i < n && at + i < text.size(); ++i) text[at + i] = static_cast<char>(value >> (8 * i));
}

void change_once(std::string& text, const std::string& other, Random& random) {
  if (text.empty()) {
    text = trap(random);
    return;
  }
  const std::size_t at = below(random, text.size());
  const auto [word_begin, word_end] = word_at(text, at);
  const auto [line_begin, line_end] = line_at(text, at);
  switch (below(random, 9)) {
    case 0:
      return change_bytes(text, random);
    case 1:
      return change_binary_number(text, random);
    case 2:
    case 3:
      text.replace(word_begin, word_end - word_begin, trap(random));
      return;
    case 4:
      text.erase(line_begin, line_end - line_begin);
      return;
    case 5:
      text.insert(line_begin, text.substr(line_begin, line_end - line_begin));
      return;
    case 6:
      text.erase(at, below(random, std::min<std::size_t>(text.size() - at, 200)));
      return;
    case 7:
      text.insert(at,
                  below(random, 2) == 0 || other.empty() ? trap(random) : other.substr(below(random, other.size()), below(random, 200)));
      return;
    default:
      if (below(random, 4) == 0)
        text.resize(at);
      else
        text.replace(word_begin, word_end - word_begin, std::to_string(static_cast<int>(below(random, 40)) - 4));
  }
}

}  // namespace

std::string mutated(const std::vector<std::string>& seeds, std::uint64_t number) {
  Random random(number * 0x9E3779B97F4A7C15ULL + 1);
  std::string text = seeds[below(random, seeds.size())];
  const std::size_t n_changes = 1 + below(random, 4);
  for (std::size_t i = 0; i < n_changes; ++i) change_once(text, seeds[below(random, seeds.size())], random);
  return text;
}

}  // namespace snag::fuzz
