// gmsh files: MSH 2.2 and 4.1, ASCII and binary, with linear cells and named physical groups.
//
// One rank reads the file and would leave the others waiting if PETSc failed on what it holds: so everything is checked here, and PETSc
// gets cells that fit together. Sections of a gmsh file (https://gmsh.info/doc/texinfo/gmsh.html#MSH-file-format):
//
//   $MeshFormat     version file-type(0 ASCII, 1 binary) size; binary: an int of value 1, which tells the byte order
//   $PhysicalNames  count, then dimension tag "name" (always ASCII)
//   $Entities 4.1   n_points n_curves n_surfaces n_volumes, then each: tag, 3 (a point) or 6 reals, n physical tags, but for a point n
//                   bounding entities
//   $Nodes 2.2      count, then number x y z
//   $Nodes 4.1      blocks count min max, then blocks: dimension entity parametric n, n numbers, n times x y z
//   $Elements 2.2   ASCII:  count, then number type n_tags tags... nodes...
//                   binary: count, then blocks of ints: type n n_tags, n times (number tags... nodes...)
//                   the first tag is the physical one
//   $Elements 4.1   blocks count min max, then blocks: dimension entity type n, n times (tag nodes...);
//                   in binary sizes have 8 bytes, and block heads are ints
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/error.hpp"
#include "base/quotation.hpp"
#include "base/words.hpp"
#include "mesh/import/gmsh_reader.hpp"
#include "mesh/import/mesh_reader.hpp"
#include "mesh/import/node_numbers.hpp"
#include "mesh/shapes.hpp"

namespace snag {
namespace {

struct ElementType {
  int n_nodes;
  int dimension;
};

/// The linear elements of gmsh by type; throws for curved and unknown ones.
ElementType element_type(const GmshReader& reader, int type) {
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
      throw Error(ExitCode::mesh,
                  reader.name() + ": element type " + std::to_string(type) +
                      " is not one of tetrahedron, hexahedron, prism, pyramid with straight edges; mesh with Mesh.ElementOrder = 1");
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

/// Tags of one dimension: the name of each.
using NamesByTag = std::map<int, std::string>;

class GmshFile {
 public:
  GmshFile(const std::filesystem::path& file, double scale) : reader_(file), scale_(scale), nodes_(reader_) {
    parts_.source = file.string();
  }

  MeshParts read() {
    read_format();
    if (reader_.enter("PhysicalNames")) read_names();
    zone_of_tag_ = sorted_names(volumes_, parts_.zones), patch_of_tag_ = sorted_names(surfaces_, parts_.patches);
    if (is_41_) {
      reader_.expect("Entities");
      read_entities();
      reader_.expect("EndEntities");
    }
    reader_.expect("Nodes");
    is_41_ ? read_nodes_41() : read_nodes_22();
    nodes_.sort();
    reader_.expect("EndNodes");
    reader_.expect("Elements");
    is_41_ ? read_elements_41() : read_elements_22();
    reader_.expect("EndElements");
    if (parts_.shape.empty())
      throw Error(ExitCode::mesh,
                  reader_.name() + ": the mesh has no volume cells; mesh in three dimensions and give the volume a physical name");
    leave_out_unused_nodes();
    return std::move(parts_);
  }

 private:
  void read_format();
  void read_names();
  std::map<int, int> sorted_names(const NamesByTag& name_of_tag, std::vector<std::string>& names) const;
  void read_entities();
  void read_nodes_22();
  void read_nodes_41();
  void read_elements_22();
  void read_elements_41();
  void read_position();
  void read_element(int type, int tag);
  void leave_out_unused_nodes();

  GmshReader reader_;
  double scale_;
  bool is_41_ = false;
  NamesByTag surfaces_, volumes_;
  std::map<int, int> zone_of_tag_, patch_of_tag_;
  std::map<std::pair<int, int>, int> tag_of_entity_;  // 4.1: physical tag of an entity (dimension, number)
  NodeNumbers nodes_;
  MeshParts parts_;
};

void GmshFile::read_format() {
  reader_.expect("MeshFormat");
  const double version = reader_.number<double>();
  const bool is_binary = reader_.number<int>() == 1;
  is_41_ = std::abs(version - 4.1) < 0.01;
  if (!is_41_ && !(std::abs(version - 2.2) < 0.01))
    throw Error(ExitCode::mesh, reader_.name() + ": gmsh format " + number_text(version) +
                                    " is not read, 2.2 and 4.1 are; save with Mesh.MshFileVersion = 4.1");
  reader_.number<int>();
  reader_.skip_line();
  if (!is_binary) return;
  reader_.set_binary();
  if (reader_.integer() != 1)
    throw Error(ExitCode::mesh, reader_.name() + ": a binary mesh of the other byte order is not read; save it as ASCII");
}

/// Names go into messages, keys of a case and file names: they have one line and a length that can be read.
void GmshFile::read_names() {
  constexpr std::size_t longest_name = 127;  // gmsh's own limit
  const int n = reader_.number<int>();
  reader_.checked_count(n, "names");
  for (int i = 0; i < n; ++i) {
    const int dimension = reader_.number<int>(), tag = reader_.number<int>();
    const std::string_view rest = reader_.line();
    const std::size_t first = rest.find('"'), last = rest.rfind('"');
    if (first == std::string_view::npos || last <= first) reader_.throw_damaged("a name in quotes is missing");
    const std::string name(rest.substr(first + 1, last - first - 1));
    const auto is_control = [](unsigned char c) { return c < ' ' || c == 127; };
    if (name.empty() || name.size() > longest_name || std::any_of(name.begin(), name.end(), is_control))
      reader_.throw_damaged("the name \"" + shortened(name) + "\" has " + std::to_string(name.size()) +
                            " bytes, a name has 1 to 127 and no control characters");
    if (dimension == 2) surfaces_[tag] = name;
    if (dimension == 3) volumes_[tag] = name;
  }
}

/// Sorted names without repetition, and where each tag's name is among them.
std::map<int, int> GmshFile::sorted_names(const NamesByTag& name_of_tag, std::vector<std::string>& names) const {
  for (const auto& [tag, name] : name_of_tag) names.push_back(name);
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  std::map<int, int> index;
  for (const auto& [tag, name] : name_of_tag)
    index[tag] = static_cast<int>(std::lower_bound(names.begin(), names.end(), name) - names.begin());
  return index;
}

void GmshFile::read_entities() {
  std::array<std::int64_t, 4> n_entities{};
  for (auto& n : n_entities) n = reader_.count("entities");
  for (int dimension = 0; dimension < 4; ++dimension)
    for (std::int64_t e = 0; e < n_entities[dimension]; ++e) {
      const int number = reader_.integer();
      for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i) reader_.real();
      const std::int64_t n_tags = reader_.count("physical tags");
      for (std::int64_t t = 0; t < n_tags; ++t) {
        const int tag = reader_.integer();
        // The sign is the side of the surface that the group names; the first group counts, as in 2.2.
        if (t == 0) tag_of_entity_[{dimension, number}] = tag < 0 ? -std::max(tag, -std::numeric_limits<int>::max()) : tag;
      }
      const std::int64_t n_bounding = dimension == 0 ? 0 : reader_.count("bounding entities");
      for (std::int64_t b = 0; b < n_bounding; ++b) reader_.integer();
    }
}

void GmshFile::read_position() {
  Vec3 x;
  for (int axis = 0; axis < 3; ++axis) {
    x[axis] = scale_ * reader_.real();
    if (!std::isfinite(x[axis])) reader_.throw_damaged("a node has a coordinate that is not finite");
  }
  parts_.node.push_back(x);
}

void GmshFile::read_nodes_22() {
  const auto n = reader_.checked_count(reader_.number<std::int64_t>(), "nodes");
  reader_.skip_line();
  for (std::int64_t i = 0; i < n; ++i) {
    nodes_.add(reader_.integer());
    read_position();
  }
}

void GmshFile::read_nodes_41() {
  const std::int64_t n_blocks = reader_.count("node blocks");
  for (int i = 0; i < 3; ++i) reader_.size();
  for (std::int64_t b = 0; b < n_blocks; ++b) {
    reader_.integer(), reader_.integer();
    if (reader_.integer() != 0)
      throw Error(ExitCode::mesh, reader_.name() + ": nodes with parametric coordinates are not read; save with Mesh.SaveParametric = 0");
    const std::int64_t n = reader_.count("nodes");
    for (std::int64_t i = 0; i < n; ++i) nodes_.add(reader_.size());
    for (std::int64_t i = 0; i < n; ++i) read_position();
  }
}

/// An element after its number and tags; only cells and faces of named surfaces are kept.
void GmshFile::read_element(int type, int tag) {
  const ElementType element = element_type(reader_, type);
  std::array<int, 8> node{};
  for (int i = 0; i < element.n_nodes; ++i) node[i] = nodes_.position(is_41_ ? reader_.size() : reader_.integer());
  if (element.dimension == 3) {
    if (type == 6) std::swap(node[1], node[2]), std::swap(node[4], node[5]);  // VTK's prism turns the other way
    const auto zone = zone_of_tag_.find(tag);
    parts_.zone.push_back(zone == zone_of_tag_.end() ? -1 : zone->second);
    parts_.cell_id.push_back(static_cast<std::int64_t>(parts_.shape.size()));
    if (parts_.cell_node.size() > static_cast<std::size_t>(std::numeric_limits<int>::max() - 8))
      throw Error(ExitCode::mesh, reader_.name() + ": has more than " + std::to_string(parts_.shape.size()) +
                                      " cells, their corners must be fewer than 2147483648; mesh coarser");
    add_cell(parts_, shape_of(type), node.data(), element.n_nodes);
  }
  if (const auto patch = patch_of_tag_.find(tag); element.dimension == 2 && patch != patch_of_tag_.end())
    add_boundary_face(parts_, patch->second, node.data(), element.n_nodes);
}

void GmshFile::read_elements_22() {
  const auto n = reader_.checked_count(reader_.number<std::int64_t>(), "elements");
  reader_.skip_line();
  for (std::int64_t done = 0; done < n;) {
    if (!reader_.is_binary()) reader_.integer();
    const int type = reader_.integer(), n_block = reader_.is_binary() ? reader_.integer() : 1;
    const auto n_tags = reader_.checked_count(reader_.integer(), "tags");
    if (n_block <= 0) reader_.throw_damaged("a block without elements");
    for (int i = 0; i < n_block; ++i) {
      if (reader_.is_binary()) reader_.integer();
      int tag = 0;
      for (std::int64_t t = 0; t < n_tags; ++t)
        if (const int value = reader_.integer(); t == 0) tag = value;
      read_element(type, tag);
    }
    done += n_block;
  }
}

void GmshFile::read_elements_41() {
  const std::int64_t n_blocks = reader_.count("element blocks");
  for (int i = 0; i < 3; ++i) reader_.size();
  for (std::int64_t b = 0; b < n_blocks; ++b) {
    const int dimension = reader_.integer(), entity = reader_.integer(), type = reader_.integer();
    const std::int64_t n = reader_.count("elements");
    if (const int needed = element_type(reader_, type).dimension; dimension != needed)
      reader_.throw_damaged("a block of dimension " + std::to_string(dimension) + " holds elements of type " + std::to_string(type) +
                            ", which has dimension " + std::to_string(needed));
    const auto tag = tag_of_entity_.find({dimension, entity});
    for (std::int64_t i = 0; i < n; ++i) {
      reader_.size();
      read_element(type, tag == tag_of_entity_.end() ? 0 : tag->second);
    }
  }
}

/// Numbers nodes of cells and faces from 0 in the order of the file.
void GmshFile::leave_out_unused_nodes() {
  std::vector<int> number(parts_.node.size(), -1);
  for (const auto* list : {&parts_.cell_node, &parts_.boundary_node})
    for (const int node : *list) number[node] = 0;
  int n_used = 0;
  for (std::size_t i = 0; i < number.size(); ++i)
    if (number[i] == 0) parts_.node[n_used] = parts_.node[i], parts_.node_id.push_back(n_used), number[i] = n_used++;
  parts_.node.resize(static_cast<std::size_t>(n_used));
  for (auto* list : {&parts_.cell_node, &parts_.boundary_node})
    for (int& node : *list) node = number[node];
  parts_.n_owned = static_cast<int>(parts_.shape.size());
}

struct Gmsh final : MeshReader {
  static constexpr const char* name = "gmsh";

  MeshFormat format() const override { return {.title = "gmsh MSH 2.2 or 4.1", .endings = {".msh"}}; }
  bool recognises(std::string_view beginning) const override {
    const std::string_view word = beginning.substr(std::min(beginning.find_first_not_of(" \t\r\n"), beginning.size()));
    return word.starts_with("$") && !word.starts_with("$NOD");  // that is gmsh 1.0
  }
  MeshParts read(const std::filesystem::path& file, double scale) const override { return GmshFile(file, scale).read(); }
};
const bool registered = mesh_readers().add<Gmsh>();

}  // namespace
}  // namespace snag
