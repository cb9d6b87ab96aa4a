#pragma once
// Runs snag-mesh and reads what it wrote, with a reader of its own: nothing here trusts the generator's checks.
#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "base/vec3.hpp"

namespace mesh_generate {

using snag::Vec3;

struct Outcome {
  int code = -1;       // exit code
  std::string output;  // of both streams
  /// Number in this column (from 0, the name is column 0) of the line of the table that starts with `name`; NaN if absent.
  double number(const std::string& name, int column) const;
};
/// Start the program in the folder of the test's files.
Outcome snag_mesh(const std::string& arguments);
/// Folder for files of the tests.
std::filesystem::path folder();
std::string bytes(const std::filesystem::path& file);

struct MeshFile {
  struct Element {
    int type = 0;  // of gmsh: 2 triangle, 3 quadrangle, 4 tetrahedron, 5 hexahedron, 6 prism
    int group = 0;
    std::vector<int> nodes;
  };
  std::map<int, Vec3> node;                          // m
  std::map<std::string, std::pair<int, int>> group;  // name -> dimension, tag
  std::vector<Element> elements;

  std::vector<const Element*> of(const std::string& name) const;
  std::set<int> nodes_of(const std::string& name) const;
  double area(const std::string& name) const;    // m2
  double volume(const std::string& name) const;  // m3, of the elements, each split into tetrahedra
};
/// MSH 2.2, text.
MeshFile read_mesh(const std::filesystem::path& file);

/// Sentences on what is not watertight: boundary faces without exactly one surface, surfaces off the boundary, inverted cells.
std::vector<std::string> leaks(const MeshFile& mesh);

}  // namespace mesh_generate
