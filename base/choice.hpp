#pragma once
// A key of the case that is one of a few words: in the program an enumeration.
#include <cstddef>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace snag {

/// What the reader and the manual know of a choice: its words, and which of them is chosen.
class AnyChoice {
 public:
  const std::vector<std::string>& words() const { return words_; }
  const std::string& word() const { return words_[index_]; }
  /// Throws std::logic_error for another word: the reader of the case lets none pass (Parameter::choices).
  void choose(std::string_view word) {
    for (std::size_t i = 0; i < words_.size(); ++i)
      if (word == words_[i]) {
        index_ = i;
        return;
      }
    throw std::logic_error("\"" + std::string(word) + "\" is not one of the choices");
  }

 protected:
  AnyChoice(std::size_t index, std::initializer_list<const char*> words) : words_(words.begin(), words.end()), index_(index) {}

  std::vector<std::string> words_;
  std::size_t index_;
};

/// A value of the enumeration E, whose values are 0, 1, 2 ...; a target of a Parameter.
template <class E>
class Choice : public AnyChoice {
 public:
  /// `words`: in the order of E.
  Choice(E value, std::initializer_list<const char*> words) : AnyChoice(static_cast<std::size_t>(value), words) {}
  Choice& operator=(E value) {
    index_ = static_cast<std::size_t>(value);
    return *this;
  }
  operator E() const { return static_cast<E>(index_); }
};

}  // namespace snag
