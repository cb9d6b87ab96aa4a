// PETSc reads the mesh on rank 0 only and would leave the other ranks waiting if it failed there: so everything it will read is checked
// before. Sections of a gmsh file (https://gmsh.info/doc/texinfo/gmsh.html#MSH-file-format):
//
//   $MeshFormat     version file-type(0 ASCII, 1 binary) size; binary: an int of value 1, which tells the byte order
//   $PhysicalNames  count, then dimension tag "name" (always ASCII)
//   $Nodes 2.2      count, then number x y z
//   $Nodes 4.1      blocks count min max, then blocks: dimension entity parametric n, n numbers, n times x y z
//   $Elements 2.2   ASCII:  count, then number type n_tags tags... nodes...
//                   binary: count, then blocks of ints: type n n_tags, n times (number tags... nodes...)
//   $Elements 4.1   blocks count min max, then blocks: dimension entity type n, n times (tag nodes...);
//                   in binary sizes have 8 bytes, and block heads are ints
#include "mesh/gmsh_outline.hpp"

#include <cmath>

#include "base/error.hpp"
#include "mesh/gmsh_reader.hpp"
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

/// Nodes of an element type; throws for curved and unknown ones.
ElementType require_linear(const GmshReader& reader, int type) {
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

void read_names(GmshReader& reader, GmshOutline& outline) {
  const int n = reader.number<int>();
  for (int i = 0; i < n; ++i) {
    const int dimension = reader.number<int>(), tag = reader.number<int>();
    const std::string_view rest = reader.line();
    const std::size_t first = rest.find('"'), last = rest.rfind('"');
    if (first == std::string_view::npos || last <= first) reader.throw_damaged("a name in quotes is missing in $PhysicalNames");
    const std::string name(rest.substr(first + 1, last - first - 1));
    if (dimension == 2) outline.surfaces[tag] = name;
    if (dimension == 3) outline.volumes[tag] = name;
  }
}

/// The node numbers of a file; elements may use no others.
class NodeNumbers {
 public:
  explicit NodeNumbers(const GmshReader& reader) : reader_(reader) {}
  void add(std::int64_t number) {
    if (number < 0 || number > largest_number)
      reader_.throw_damaged("node number " + std::to_string(number) + " is not between 0 and 2147483646");
    if (static_cast<std::size_t>(number) >= is_known_.size())
      is_known_.resize(std::max<std::size_t>(2 * is_known_.size(), number + 1), false);
    if (is_known_[number]) reader_.throw_damaged("node number " + std::to_string(number) + " occurs twice");
    is_known_[number] = true;
  }
  void require(std::int64_t number) const {
    if (number < 0 || static_cast<std::size_t>(number) >= is_known_.size() || !is_known_[number])
      reader_.throw_damaged("an element has node " + std::to_string(number) + ", which does not exist");
  }

 private:
  static constexpr std::int64_t largest_number = 2147483646;
  const GmshReader& reader_;
  std::vector<bool> is_known_;
};

void read_position(GmshReader& reader) {
  for (int axis = 0; axis < 3; ++axis)
    if (!std::isfinite(reader.real())) reader.throw_damaged("a node has a coordinate that is not finite");
}

void read_nodes_22(GmshReader& reader, NodeNumbers& nodes) {
  const auto n = reader.number<std::int64_t>();
  reader.skip_line();
  for (std::int64_t i = 0; i < n; ++i) {
    nodes.add(reader.integer());
    read_position(reader);
  }
}

void read_nodes_41(GmshReader& reader, NodeNumbers& nodes) {
  const std::int64_t n_blocks = reader.size();
  for (int i = 0; i < 3; ++i) reader.size();
  for (std::int64_t b = 0; b < n_blocks; ++b) {
    reader.integer(), reader.integer();
    if (reader.integer() != 0)
      throw Error(ExitCode::mesh, reader.name() + ": nodes with parametric coordinates are not read; save with Mesh.SaveParametric = 0");
    const std::int64_t n = reader.size();
    for (std::int64_t i = 0; i < n; ++i) nodes.add(reader.size());
    for (std::int64_t i = 0; i < n; ++i) read_position(reader);
  }
}

void read_elements_22(GmshReader& reader, const NodeNumbers& nodes, GmshOutline& outline) {
  const auto n = reader.number<std::int64_t>();
  reader.skip_line();
  const auto element = [&](int type, int n_nodes, int n_tags) {
    for (int t = 0; t < n_tags; ++t) reader.integer();
    for (int i = 0; i < n_nodes; ++i) nodes.require(reader.integer());
    count(outline, type, 1);
  };
  for (std::int64_t done = 0; done < n;) {
    if (!reader.is_binary()) reader.integer();
    const int type = reader.integer(), n_block = reader.is_binary() ? reader.integer() : 1, n_tags = reader.integer();
    const int n_nodes = require_linear(reader, type).n_nodes;
    if (n_block <= 0) reader.throw_damaged("a block without elements");
    for (int i = 0; i < n_block; ++i) {
      if (reader.is_binary()) reader.integer();
      element(type, n_nodes, n_tags);
    }
    done += n_block;
  }
}

void read_elements_41(GmshReader& reader, const NodeNumbers& nodes, GmshOutline& outline) {
  const std::int64_t n_blocks = reader.size();
  for (int i = 0; i < 3; ++i) reader.size();
  for (std::int64_t b = 0; b < n_blocks; ++b) {
    reader.integer(), reader.integer();
    const int type = reader.integer();
    const std::int64_t n = reader.size();
    const int n_nodes = require_linear(reader, type).n_nodes;
    for (std::int64_t i = 0; i < n; ++i) {
      reader.size();
      for (int k = 0; k < n_nodes; ++k) nodes.require(reader.size());
    }
    count(outline, type, n);
  }
}

}  // namespace

GmshOutline gmsh_outline(const std::filesystem::path& file) {
  GmshReader reader(file);
  reader.expect("MeshFormat");
  const double version = reader.number<double>();
  const bool is_binary = reader.number<int>() == 1;
  const bool is_22 = std::abs(version - 2.2) < 0.01, is_41 = std::abs(version - 4.1) < 0.01;
  if (!is_22 && !is_41)
    throw Error(ExitCode::mesh, file.string() + ": gmsh format " + std::to_string(version).substr(0, 3) +
                                    " is not read, 2.2 and 4.1 are; save with Mesh.MshFileVersion = 4.1");
  reader.number<int>();
  reader.skip_line();
  if (is_binary) reader.set_binary();
  if (is_binary && reader.integer() != 1)
    throw Error(ExitCode::mesh, file.string() + ": a binary mesh of the other byte order is not read; save it as ASCII");

  GmshOutline outline;
  if (reader.enter("PhysicalNames")) read_names(reader, outline);
  NodeNumbers nodes(reader);
  if (is_41) reader.expect("Entities");
  reader.expect("Nodes");
  is_22 ? read_nodes_22(reader, nodes) : read_nodes_41(reader, nodes);
  reader.expect("EndNodes");
  reader.expect("Elements");
  is_22 ? read_elements_22(reader, nodes, outline) : read_elements_41(reader, nodes, outline);
  reader.expect("EndElements");
  if (outline.cells.empty())
    throw Error(ExitCode::mesh,
                file.string() + ": the mesh has no volume cells; mesh in three dimensions and give the volume a physical name");
  return outline;
}

}  // namespace snag
