#pragma once
// Numbers and sections of a gmsh file, text or bytes.
#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/error.hpp"

namespace snag {

/// Walks through the bytes of a file; every read past the end, or of something that is no number, is an Error(io) with its place.
class GmshReader {
 public:
  /// Throws Error(io) if the file cannot be read.
  explicit GmshReader(const std::filesystem::path& file);

  /// Goes behind the line "$name"; false if there is none.
  bool enter(const std::string& name);
  /// The same; throws Error(io) if there is none.
  void expect(const std::string& name);
  std::string_view line() {
    const std::size_t begin = at_;
    skip_line();
    return std::string_view(text_).substr(begin, at_ - begin);
  }
  /// From now on numbers are bytes, not text.
  void set_binary() { is_binary_ = true; }
  int integer() { return is_binary_ ? value<int>() : number<int>(); }
  std::int64_t size() { return is_binary_ ? value<std::int64_t>() : number<std::int64_t>(); }
  double real() { return is_binary_ ? value<double>() : number<double>(); }
  /// A number of things that follow: an Error(io) if it is negative.
  std::int64_t count(const char* what) { return checked_count(size(), what); }
  std::int64_t checked_count(std::int64_t n, const char* what) const;
  bool is_binary() const { return is_binary_; }

  /// Next number of text.
  template <class Number>
  Number number() {
    while (at_ < text_.size() && static_cast<unsigned char>(text_[at_]) <= ' ') ++at_;
    Number value{};
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc()) throw_no_number(error == std::errc::result_out_of_range);
    at_ = static_cast<std::size_t>(end - text_.data());
    return value;
  }
  void skip_line() {
    const std::size_t end = text_.find('\n', at_);
    at_ = end == std::string::npos ? text_.size() : end + 1;
  }
  [[noreturn]] void throw_damaged(const std::string& what) const;
  const std::string& name() const { return name_; }

 private:
  template <class Value>
  Value value() {
    Value result;
    if (sizeof(Value) > text_.size() - at_) throw_damaged("the file ends too early");
    std::memcpy(&result, text_.data() + at_, sizeof(Value));
    at_ += sizeof(Value);
    return result;
  }
  [[noreturn]] void throw_no_number(bool is_too_large) const;
  std::string where() const;

  std::string name_, section_, text_;
  std::size_t at_ = 0;
  bool is_binary_ = false;
};

}  // namespace snag
