#include "mesh/import/gmsh_reader.hpp"

#include <algorithm>

#include "base/atomic_file.hpp"
#include "base/quotation.hpp"

namespace snag {

GmshReader::GmshReader(const std::filesystem::path& file) : name_(file.string()) {
  auto text = file_text(file);
  if (!text) throw Error(ExitCode::io, name_ + ": the mesh file cannot be read; check its permissions");
  text_ = std::move(*text);
}

bool GmshReader::enter(const std::string& name) {
  const std::string mark = "$" + name;
  for (std::size_t found = text_.find(mark, at_); found != std::string::npos; found = text_.find(mark, found + 1)) {
    const std::size_t end = found + mark.size();
    const bool begins_line = found == 0 || text_[found - 1] == '\n', ends_word = end == text_.size() || std::isspace(text_[end]);
    if (!begins_line || !ends_word) continue;
    at_ = end;
    skip_line();
    section_ = name;
    return true;
  }
  return false;
}

void GmshReader::expect(const std::string& name) {
  if (!enter(name)) throw_damaged("section $" + name + " is missing");
}

std::int64_t GmshReader::checked_count(std::int64_t n, const char* what) const {
  if (n < 0) throw_damaged("number of " + std::string(what) + " is " + std::to_string(n) + ", it must be zero or more");
  return n;
}

std::string GmshReader::where() const {
  const std::string section = section_.empty() ? "" : ", section $" + section_;
  if (is_binary_) return "byte " + std::to_string(at_) + section;
  return "line " + std::to_string(1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n')) + section;
}

void GmshReader::throw_no_number(bool is_too_large) const {
  if (at_ >= text_.size()) throw_damaged("the file ends too early");
  std::size_t end = at_;
  while (end < text_.size() && static_cast<unsigned char>(text_[end]) > ' ') ++end;
  const std::string word = shortened(std::string_view(text_).substr(at_, end - at_));
  throw_damaged(is_too_large ? "the number " + word + " is too large" : "a number is expected, found \"" + word + "\"");
}

void GmshReader::throw_damaged(const std::string& what) const {
  throw Error(ExitCode::io, name_ + ": not a sound gmsh mesh (" + where() + ": " + what + "); write the mesh again, as MSH 2.2 or 4.1");
}

}  // namespace snag
