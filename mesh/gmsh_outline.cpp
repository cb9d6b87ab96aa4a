// Sections of a gmsh file that matter here (https://gmsh.info/doc/texinfo/gmsh.html#MSH-file-format):
//
//   $MeshFormat     version file-type(0 ASCII, 1 binary) size; binary: an int of value 1, which tells the byte order
//   $PhysicalNames  count, then dimension tag "name" (always ASCII)
//   $Elements 2.2   ASCII:  count, then number type n_tags tags... nodes...
//                   binary: count, then blocks of ints: type n n_tags, n times (number tags... nodes...)
//   $Elements 4.1   blocks count min max, then blocks: dimension entity type n, n times (tag nodes...); sizes are 8 bytes in binary, block
//   heads ints
#include "mesh/gmsh_outline.hpp"

#include <charconv>
#include <cstring>
#include <fstream>
#include <string_view>

#include "base/error.hpp"
#include "mesh/shapes.hpp"

namespace snag {
namespace {

struct ElementType {
  int n_nodes;
  int dimension;
};

/// The linear elements of gmsh by type; n_nodes 0 for all others.
ElementType element_type(int type) {
  switch (type) {
    case 15:
      return {1, 0};
    case 1:
      return {2, 1};
    case 2:
      return {3, 2};
    case 3:
      return {4, 2};
    case 4:
      return {4, 3};
    case 5:
      return {8, 3};
    case 6:
      return {6, 3};
    case 7:
      return {5, 3};
    default:
      return {0, 0};
  }
}

CellShape shape_of(int type) {
  switch (type) {
    case 4:
      return CellShape::tetrahedron;
    case 5:
      return CellShape::hexahedron;
    case 6:
      return CellShape::prism;
    default:
      return CellShape::pyramid;
  }
}

/// Walks through the bytes of a file; every read past the end is the error of a file that was cut off.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : name_(file.string()) {
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    if (!stream) throw Error(ExitCode::io, name_ + ": the mesh file cannot be opened; check the path and its permissions");
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
    if (!enter(name)) throw_cut_off("section $" + name + " is missing");
  }
  std::string_view line() {
    const std::size_t begin = at_;
    skip_line();
    return std::string_view(text_).substr(begin, at_ - begin);
  }
  /// Next number of text.
  template <class Number>
  Number number() {
    while (at_ < text_.size() && static_cast<unsigned char>(text_[at_]) <= ' ') ++at_;
    Number value{};
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc()) throw_cut_off("a number is expected at byte " + std::to_string(at_));
    at_ = static_cast<std::size_t>(end - text_.data());
    return value;
  }
  /// Next value of the binary part.
  template <class Value>
  Value value() {
    Value result;
    if (sizeof(Value) > text_.size() - at_) throw_cut_off("the file ends too early");
    std::memcpy(&result, text_.data() + at_, sizeof(Value));
    at_ += sizeof(Value);
    return result;
  }
  void skip(std::int64_t bytes) {
    if (bytes < 0 || static_cast<std::size_t>(bytes) > text_.size() - at_) throw_cut_off("the file ends too early");
    at_ += static_cast<std::size_t>(bytes);
  }
  void skip_line() {
    const std::size_t end = text_.find('\n', at_);
    at_ = end == std::string::npos ? text_.size() : end + 1;
  }
  [[noreturn]] void throw_cut_off(const std::string& what) const {
    throw Error(ExitCode::io, name_ + ": not a complete gmsh mesh (" + what + "); write the mesh again, as MSH 2.2 or 4.1");
  }
  const std::string& name() const { return name_; }

 private:
  std::string name_, text_;
  std::size_t at_ = 0;
};

/// Nodes of an element type; throws for curved and unknown ones.
ElementType require_linear(const Reader& reader, int type) {
  const ElementType element = element_type(type);
  if (element.n_nodes == 0)
    throw Error(ExitCode::mesh,
                reader.name() + ": element type " + std::to_string(type) +
                    " is not one of tetrahedron, hexahedron, prism, pyramid with straight edges; mesh with Mesh.ElementOrder = 1");
  return element;
}

void count(GmshOutline& outline, int type, std::int64_t n) {
  if (element_type(type).dimension < 3 || n == 0) return;
  const CellShape shape = shape_of(type);
  if (outline.cells.empty() || outline.cells.back().first != shape) outline.cells.emplace_back(shape, 0);
  outline.cells.back().second += static_cast<int>(n);
}

void read_names(Reader& reader, GmshOutline& outline) {
  const int n = reader.number<int>();
  for (int i = 0; i < n; ++i) {
    const int dimension = reader.number<int>(), tag = reader.number<int>();
    const std::string_view rest = reader.line();
    const std::size_t first = rest.find('"'), last = rest.rfind('"');
    if (first == std::string_view::npos || last <= first) reader.throw_cut_off("a name in quotes is missing in $PhysicalNames");
    const std::string name(rest.substr(first + 1, last - first - 1));
    if (dimension == 2) outline.surfaces[tag] = name;
    if (dimension == 3) outline.volumes[tag] = name;
  }
}

void read_elements_22(Reader& reader, bool is_binary, GmshOutline& outline) {
  const std::int64_t n = reader.number<std::int64_t>();
  reader.skip_line();
  if (!is_binary) {
    for (std::int64_t i = 0; i < n; ++i) {
      reader.number<std::int64_t>();
      const int type = reader.number<int>();
      require_linear(reader, type);
      count(outline, type, 1);
      reader.skip_line();
    }
    return;
  }
  for (std::int64_t done = 0; done < n;) {
    const int type = reader.value<int>(), n_block = reader.value<int>(), n_tags = reader.value<int>();
    if (n_block <= 0) reader.throw_cut_off("an empty block of elements");
    reader.skip(std::int64_t{n_block} * (1 + n_tags + require_linear(reader, type).n_nodes) * static_cast<int>(sizeof(int)));
    count(outline, type, n_block);
    done += n_block;
  }
}

void read_elements_41(Reader& reader, bool is_binary, GmshOutline& outline) {
  const auto size = [&] { return is_binary ? reader.value<std::int64_t>() : reader.number<std::int64_t>(); };
  const auto integer = [&] { return is_binary ? reader.value<int>() : reader.number<int>(); };
  const std::int64_t n_blocks = size();
  for (int i = 0; i < 3; ++i) size();
  for (std::int64_t b = 0; b < n_blocks; ++b) {
    integer(), integer();
    const int type = integer();
    const std::int64_t n = size();
    const ElementType element = require_linear(reader, type);
    if (is_binary) {
      reader.skip(n * (1 + element.n_nodes) * static_cast<int>(sizeof(std::int64_t)));
    } else {
      reader.skip_line();
      for (std::int64_t i = 0; i < n; ++i) reader.skip_line();
    }
    count(outline, type, n);
  }
}

}  // namespace

GmshOutline gmsh_outline(const std::filesystem::path& file) {
  Reader reader(file);
  reader.expect("MeshFormat");
  const double version = reader.number<double>();
  const bool is_binary = reader.number<int>() == 1;
  const bool is_22 = version > 2.15 && version<2.25, is_41 = version> 4.05 && version < 4.15;
  if (!is_22 && !is_41)
    throw Error(ExitCode::mesh, file.string() + ": gmsh format " + std::to_string(version).substr(0, 3) +
                                    " is not read, 2.2 and 4.1 are; save with Mesh.MshFileVersion = 4.1");
  reader.number<int>();
  reader.skip_line();
  if (is_binary && reader.value<int>() != 1)
    throw Error(ExitCode::mesh, file.string() + ": a binary mesh of the other byte order is not read; save it as ASCII");

  GmshOutline outline;
  if (reader.enter("PhysicalNames")) read_names(reader, outline);
  reader.expect("Nodes");
  reader.expect("EndNodes");
  reader.expect("Elements");
  is_22 ? read_elements_22(reader, is_binary, outline) : read_elements_41(reader, is_binary, outline);
  reader.expect("EndElements");
  if (outline.cells.empty())
    throw Error(ExitCode::mesh,
                file.string() + ": the mesh has no volume cells; mesh in three dimensions and give the volume a physical name");
  return outline;
}

}  // namespace snag
