#pragma once
// A text of the case that is one of a few words, as an enumeration.
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace snag {

/// The value of E whose word this is; `words`: in the order of E. Throws std::logic_error for another word: the reader of the case lets
/// none pass (Parameter::choices).
template <class E, std::size_t n>
E chosen(std::string_view text, const std::array<const char*, n>& words) {
  for (std::size_t i = 0; i < n; ++i)
    if (text == words[i]) return static_cast<E>(i);
  throw std::logic_error("\"" + std::string(text) + "\" is not one of the choices");
}

}  // namespace snag
