#pragma once
// Numbers and sections of a gmsh file, text or bytes.
#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "base/error.hpp"

namespace snag {

/// Walks through the bytes of a file; every read past the end, or of something that is no number, is an Error(io).
class GmshReader {
 public:
  explicit GmshReader(const std::filesystem::path& file) : name_(file.string()) {
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    if (!stream || !std::filesystem::is_regular_file(file))
      throw Error(ExitCode::io, name_ + ": the mesh file cannot be opened; check the path and its permissions");
    const auto size = stream.tellg();
    text_.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    stream.seekg(0);
    if (!stream.read(text_.data(), static_cast<std::streamsize>(text_.size())) || text_.empty())
      throw Error(ExitCode::io, name_ + ": the mesh file cannot be read or is empty; check the path, it must be a gmsh .msh file");
  }

  /// Goes behind the line "$name"; false if there is none.
  bool enter(const std::string& name) {
    const std::size_t found = text_.find("$" + name, at_);
    if (found == std::string::npos) return false;
    at_ = found + name.size() + 1;
    skip_line();
    return true;
  }
  void expect(const std::string& name) {
    if (!enter(name)) throw_damaged("section $" + name + " is missing");
  }
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
  bool is_binary() const { return is_binary_; }

  /// Next number of text.
  template <class Number>
  Number number() {
    while (at_ < text_.size() && static_cast<unsigned char>(text_[at_]) <= ' ') ++at_;
    Number value{};
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc()) throw_damaged("a number is expected at byte " + std::to_string(at_));
    at_ = static_cast<std::size_t>(end - text_.data());
    return value;
  }
  void skip_line() {
    const std::size_t end = text_.find('\n', at_);
    at_ = end == std::string::npos ? text_.size() : end + 1;
  }
  [[noreturn]] void throw_damaged(const std::string& what) const {
    throw Error(ExitCode::io, name_ + ": not a sound gmsh mesh (" + what + "); write the mesh again, as MSH 2.2 or 4.1");
  }
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

  std::string name_, text_;
  std::size_t at_ = 0;
  bool is_binary_ = false;
};

}  // namespace snag
