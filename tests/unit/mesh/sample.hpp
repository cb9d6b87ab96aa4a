#pragma once
// Small meshes made in the test and written as gmsh files, in all four forms that Snag reads.
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <random>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "parallel/session.hpp"

namespace snag::test {

struct Element {
  int type;               // gmsh: 2 triangle, 3 quadrilateral, 4 tetrahedron, 5 hexahedron, 6 prism, 7 pyramid
  int tag;                // physical
  std::vector<int> node;  // from 0, gmsh's order
  int dimension() const { return type < 4 ? 2 : 3; }
};

struct Sample {
  std::vector<Vec3> node;
  std::vector<Element> element;                                // in the order of the file
  std::vector<std::pair<int, std::string>> volumes, surfaces;  // physical tag, name
};

/// n units along y of one prism, hexahedron, tetrahedron and pyramid each, in this order in the file, boundary faces in between; volume 2
/// n. Patches bottom, front (y = 0), back (y = n), sides; zones "block" (hexahedra and prisms) and "roof". Tags of volumes and surfaces
/// coincide on purpose.
inline Sample mixed_units(int n) {
  Sample s;
  s.volumes = {{1, "block"}, {2, "roof"}};
  s.surfaces = {{1, "bottom"}, {2, "front"}, {3, "back"}, {4, "sides"}};
  for (int k = 0; k <= n; ++k)  // corners of the hexahedra: 4 k + 0..3
    for (const auto& [x, z] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) s.node.push_back({1.0 * x, 1.0 * k, 1.0 * z});
  for (int k = 0; k < n; ++k) {
    const int a = 4 * k, b = a + 4, ridge = static_cast<int>(s.node.size());
    s.node.push_back({2, k + 0.5, 0}), s.node.push_back({2, k + 0.5, 1}), s.node.push_back({0.5, k + 0.5, 2});
    s.element.push_back({3, 1, {a, a + 1, b + 1, b}});
    s.element.push_back({6, 1, {a + 1, ridge, b + 1, a + 3, ridge + 1, b + 3}});
    s.element.push_back({2, 1, {a + 1, ridge, b + 1}});
    s.element.push_back({5, 1, {a, a + 1, b + 1, b, a + 2, a + 3, b + 3, b + 2}});
    s.element.push_back({4, 2, {a + 3, ridge + 1, b + 3, ridge + 2}});
    s.element.push_back({7, 2, {a + 2, a + 3, b + 3, b + 2, ridge + 2}});
    for (const auto& quad : {std::vector{a, b, b + 2, a + 2}, {a + 1, ridge, ridge + 1, a + 3}, {b + 1, ridge, ridge + 1, b + 3}})
      s.element.push_back({3, 4, quad});
    for (const auto& tri : {std::vector{a + 2, a + 3, ridge + 2},
                            {b + 2, b + 3, ridge + 2},
                            {a + 2, b + 2, ridge + 2},
                            {a + 3, ridge + 1, ridge + 2},
                            {b + 3, ridge + 1, ridge + 2}})
      s.element.push_back({2, 4, tri});
  }
  s.element.insert(s.element.begin() + 3, {3, 2, {0, 1, 3, 2}});
  s.element.push_back({3, 3, {4 * n, 4 * n + 1, 4 * n + 3, 4 * n + 2}});
  return s;
}

/// n^3 hexahedra in the unit cube whose inner nodes are moved at random by up to `shift` of the cell width, so that faces are warped. Patch
/// "wall", zone "fluid".
inline Sample warped_cube(int n, double shift) {
  Sample s;
  s.volumes = {{1, "fluid"}};
  s.surfaces = {{1, "wall"}};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-shift / n, shift / n);
  const auto node = [n](int i, int j, int k) { return i + (n + 1) * (j + (n + 1) * k); };
  const auto is_inner = [n](int i) { return i > 0 && i < n; };
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        Vec3 x = Vec3{1.0 * i, 1.0 * j, 1.0 * k} / n;
        const Vec3 moved{uniform(random), uniform(random), uniform(random)};
        if (is_inner(i) && is_inner(j) && is_inner(k)) x += moved;
        s.node.push_back(x);
      }
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const std::vector<int> c{node(i, j, k),     node(i + 1, j, k),     node(i + 1, j + 1, k),     node(i, j + 1, k),
                                 node(i, j, k + 1), node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1)};
        s.element.push_back({5, 1, c});
        const auto wall = [&](bool is_wall, int p, int q, int r, int t) {
          if (is_wall) s.element.push_back({3, 1, {c[p], c[q], c[r], c[t]}});
        };
        wall(i == 0, 0, 3, 7, 4), wall(i == n - 1, 1, 2, 6, 5), wall(j == 0, 0, 1, 5, 4);
        wall(j == n - 1, 3, 2, 6, 7), wall(k == 0, 0, 1, 2, 3), wall(k == n - 1, 4, 5, 6, 7);
      }
  return s;
}

enum class Format { ascii22, binary22, ascii41, binary41 };

/// Writes numbers as text or as bytes.
struct GmshStream {
  std::ofstream file;
  bool is_binary;
  template <class Number>
  void put(Number value) {
    if (is_binary) {
      file.write(reinterpret_cast<const char*>(&value), sizeof value);
    } else {
      file << std::setprecision(17) << value << ' ';
    }
  }
  void end_line() {
    if (!is_binary) file << '\n';
  }
};

inline void write_22(const Sample& s, GmshStream& out) {
  out.file << "$Nodes\n" << s.node.size() << '\n';
  for (std::size_t i = 0; i < s.node.size(); ++i) {
    out.put(static_cast<int>(i) + 1), out.put(s.node[i].x), out.put(s.node[i].y), out.put(s.node[i].z);
    out.end_line();
  }
  out.file << "\n$EndNodes\n$Elements\n" << s.element.size() << '\n';
  for (std::size_t e = 0; e < s.element.size(); ++e) {
    const Element& element = s.element[e];
    if (out.is_binary) {
      for (const int value : {element.type, 1, 2, static_cast<int>(e) + 1}) out.put(value);
    } else {
      for (const int value : {static_cast<int>(e) + 1, element.type, 2}) out.put(value);
    }
    out.put(element.tag), out.put(3 - element.tag);  // the elementary tag is another one's physical tag: it must not count
    for (const int node : element.node) out.put(node + 1);
    out.end_line();
  }
  out.file << "\n$EndElements\n";
}

inline void write_41(const Sample& s, GmshStream& out) {
  const auto size = [&](std::size_t value) { out.put(static_cast<std::int64_t>(value)); };
  const auto group = [&](int tag) {  // an entity of the same tag as its physical group
    out.put(tag + 10);
    for (const double bound : {0.0, 0.0, 0.0, 9.0, 9.0, 9.0}) out.put(bound);
    size(1), out.put(tag), size(0), out.end_line();
  };
  out.file << "$Entities\n";
  size(0), size(0), size(s.surfaces.size()), size(s.volumes.size()), out.end_line();
  for (const auto& [tag, name] : s.surfaces) group(tag);
  for (const auto& [tag, name] : s.volumes) group(tag);
  out.file << "\n$EndEntities\n$Nodes\n";
  size(1), size(s.node.size()), size(1), size(s.node.size()), out.end_line();
  out.put(3), out.put(s.volumes[0].first + 10), out.put(0), size(s.node.size()), out.end_line();
  for (std::size_t i = 0; i < s.node.size(); ++i) size(i + 1), out.end_line();
  for (const Vec3& x : s.node) out.put(x.x), out.put(x.y), out.put(x.z), out.end_line();
  out.file << "\n$EndNodes\n$Elements\n";
  size(s.element.size()), size(s.element.size()), size(1), size(s.element.size()), out.end_line();
  for (std::size_t e = 0; e < s.element.size(); ++e) {
    const Element& element = s.element[e];
    out.put(element.dimension()), out.put(element.tag + 10), out.put(element.type), size(1), out.end_line();
    size(e + 1);
    for (const int node : element.node) size(static_cast<std::size_t>(node) + 1);
    out.end_line();
  }
  out.file << "\n$EndElements\n";
}

inline void write(const Sample& s, Format format, const std::filesystem::path& file) {
  const bool is_22 = format == Format::ascii22 || format == Format::binary22,
             is_binary = format == Format::binary22 || format == Format::binary41;
  GmshStream out{std::ofstream(file, std::ios::binary), is_binary};
  out.file << "$MeshFormat\n" << (is_22 ? "2.2 " : "4.1 ") << (is_binary ? "1 8\n" : "0 8\n");
  if (is_binary) out.put(1), out.file << '\n';
  out.file << "$EndMeshFormat\n$PhysicalNames\n" << s.volumes.size() + s.surfaces.size() << '\n';
  for (const auto& [tag, name] : s.surfaces) out.file << "2 " << tag << " \"" << name << "\"\n";
  for (const auto& [tag, name] : s.volumes) out.file << "3 " << tag << " \"" << name << "\"\n";
  out.file << "$EndPhysicalNames\n";
  is_22 ? write_22(s, out) : write_41(s, out);
}

/// A file that rank 0 writes and removes; every rank knows its name.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& ending) {
    int process = getpid();
    MPI_Bcast(&process, 1, MPI_INT, 0, MPI_COMM_WORLD);
    path_ = std::filesystem::temp_directory_path() / ("snag_" + std::to_string(process) + ending);
  }
  TemporaryFile(const Sample& sample, Format format) : TemporaryFile(".msh") {
    if (rank_of(MPI_COMM_WORLD) == 0) write(sample, format, path_);
    MPI_Barrier(MPI_COMM_WORLD);
  }
  ~TemporaryFile() {
    MPI_Barrier(MPI_COMM_WORLD);
    if (rank_of(MPI_COMM_WORLD) == 0) std::filesystem::remove(path_);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace snag::test
