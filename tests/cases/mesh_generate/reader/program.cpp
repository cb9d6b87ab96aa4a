#include "tests/cases/mesh_generate/reader/program.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>

namespace mesh_generate {

namespace {

// Tetrahedra that fill a cell, and its faces, by type of gmsh.
const std::map<int, std::vector<std::array<std::size_t, 4>>> pieces = {
    {4, {{0, 1, 2, 3}}},
    {6, {{0, 1, 2, 3}, {1, 4, 2, 3}, {2, 4, 5, 3}}},
    {5, {{0, 1, 3, 4}, {1, 2, 3, 6}, {1, 6, 3, 4}, {1, 5, 6, 4}, {3, 6, 7, 4}}},
};
const std::map<int, std::vector<std::vector<std::size_t>>> faces = {
    {4, {{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {0, 2, 3}}},
    {6, {{0, 1, 2}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}},
    {5, {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}},
};

double content(const MeshFile& mesh, const MeshFile::Element& cell) {
  double sum = 0;
  for (const auto& piece : pieces.at(cell.type)) {
    std::array<Vec3, 4> x;
    for (std::size_t k = 0; k < 4; ++k) x[k] = mesh.node.at(cell.nodes[piece[k]]);
    sum += dot(x[1] - x[0], cross(x[2] - x[0], x[3] - x[0])) / 6;
  }
  return sum;
}

}  // namespace

std::filesystem::path folder() {
  const auto path = std::filesystem::temp_directory_path() / "snag_mesh_generate";
  std::filesystem::create_directories(path);
  return path;
}

std::string bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream all;
  all << in.rdbuf();
  return all.str();
}

Outcome snag_mesh(const std::string& arguments) {
  const char* binaries = std::getenv("SNAG_BINARY_DIR");
  const std::string command =
      "cd '" + folder().string() + "' && '" + std::string(binaries ? binaries : ".") + "/snag-mesh' " + arguments + " 2>&1";
  Outcome outcome;
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return outcome;
  std::array<char, 4096> buffer{};
  while (const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe)) outcome.output.append(buffer.data(), n);
  const int status = pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

double Outcome::number(const std::string& name, int column) const {
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word != name) continue;
    for (int k = 0; k < column; ++k) words >> word;
    return std::strtod(word.c_str(), nullptr);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

MeshFile read_mesh(const std::filesystem::path& file) {
  MeshFile mesh;
  std::ifstream in(file);
  std::size_t n = 0;
  for (std::string word; in >> word;) {
    if (word == "$PhysicalNames") {
      in >> n;
      for (std::size_t i = 0; i < n; ++i) {
        int dimension = 0, tag = 0;
        std::string name;
        in >> dimension >> tag >> name;
        mesh.group[name.substr(1, name.size() - 2)] = {dimension, tag};
      }
    } else if (word == "$Nodes") {
      in >> n;
      for (std::size_t i = 0; i < n; ++i) {
        int tag = 0;
        Vec3 x;
        in >> tag >> x.x >> x.y >> x.z;
        mesh.node[tag] = x;
      }
    } else if (word == "$Elements") {
      in >> n;
      const std::map<int, std::size_t> n_nodes = {{1, 2}, {2, 3}, {3, 4}, {4, 4}, {5, 8}, {6, 6}, {7, 5}, {15, 1}};
      for (std::size_t i = 0; i < n; ++i) {
        MeshFile::Element element;
        int number = 0, n_tags = 0, tag = 0;
        in >> number >> element.type >> n_tags >> element.group;
        for (int k = 1; k < n_tags; ++k) in >> tag;
        element.nodes.resize(n_nodes.at(element.type));
        for (int& node : element.nodes) in >> node;
        mesh.elements.push_back(element);
      }
    }
  }
  return mesh;
}

std::vector<const MeshFile::Element*> MeshFile::of(const std::string& name) const {
  std::vector<const Element*> found;
  if (!group.contains(name)) return found;
  const auto [dimension, tag] = group.at(name);
  for (const auto& element : elements)
    if (element.group == tag && (element.type >= 4) == (dimension == 3)) found.push_back(&element);
  return found;
}

std::set<int> MeshFile::nodes_of(const std::string& name) const {
  std::set<int> nodes;
  for (const auto* element : of(name)) nodes.insert(element->nodes.begin(), element->nodes.end());
  return nodes;
}

double MeshFile::area(const std::string& name) const {
  double sum = 0;
  for (const auto* element : of(name)) {
    const auto x = [&](std::size_t k) { return node.at(element->nodes[k]); };
    sum += norm(element->type == 2 ? cross(x(1) - x(0), x(2) - x(0)) : cross(x(2) - x(0), x(3) - x(1))) / 2;
  }
  return sum;
}

double MeshFile::volume(const std::string& name) const {
  double sum = 0;
  for (const auto* cell : of(name)) sum += content(*this, *cell);
  return sum;
}

std::vector<std::string> leaks(const MeshFile& mesh) {
  std::map<std::vector<int>, int> cells_at, surfaces_at;
  std::set<int> used;
  int inverted = 0;
  for (const auto& element : mesh.elements) {
    if (element.type < 4) {
      auto key = element.nodes;
      std::ranges::sort(key);
      ++surfaces_at[key];
      continue;
    }
    inverted += !(content(mesh, element) > 0);
    used.insert(element.nodes.begin(), element.nodes.end());
    for (const auto& face : faces.at(element.type)) {
      std::vector<int> key;
      for (const std::size_t k : face) key.push_back(element.nodes[k]);
      std::ranges::sort(key);
      ++cells_at[key];
    }
  }
  int crowded = 0, unnamed = 0, repeated = 0, loose = 0;
  for (const auto& [face, n] : cells_at) {
    const auto surface = surfaces_at.find(face);
    const int n_surfaces = surface == surfaces_at.end() ? 0 : surface->second;
    crowded += n > 2;
    unnamed += n == 1 && n_surfaces == 0;
    repeated += n_surfaces > 1;
    loose += n == 2 && n_surfaces > 0;
  }
  for (const auto& [face, n] : surfaces_at) loose += !cells_at.contains(face);
  std::vector<std::string> sentences;
  const auto add = [&](std::size_t n, const std::string& what) {
    if (n > 0) sentences.push_back(std::to_string(n) + what);
  };
  add(static_cast<std::size_t>(inverted), " inverted cells");
  add(static_cast<std::size_t>(crowded), " faces of three cells");
  add(static_cast<std::size_t>(unnamed), " boundary faces without a name");
  add(static_cast<std::size_t>(repeated), " faces in two surfaces");
  add(static_cast<std::size_t>(loose), " named faces off the boundary");
  add(mesh.node.size() - used.size(), " nodes without a cell");
  return sentences;
}

}  // namespace mesh_generate
