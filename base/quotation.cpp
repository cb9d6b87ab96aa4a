#include "base/quotation.hpp"

namespace snag {

std::string shortened(std::string_view text) {
  constexpr std::size_t longest = 80;
  std::string result(text.substr(0, longest));
  // A character of several bytes is not cut: its further bytes begin with the bits 10.
  while (text.size() > longest && !result.empty() && (static_cast<unsigned char>(text[result.size()]) & 0xC0) == 0x80) result.pop_back();
  for (char& c : result)
    if (static_cast<unsigned char>(c) < ' ' || c == 127) c = '?';
  return text.size() > longest ? result + "..." : result;
}

}  // namespace snag
