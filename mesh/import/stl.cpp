// STL files: binary (80 bytes of header, count, then 50 bytes a triangle: normal, three corners as floats, two bytes unused) or ASCII
// ("vertex x y z" three times a facet). The stored normals are not used: the order of the corners holds. A file is binary if its size is
// the one its count demands.
#include <cstring>
#include <limits>
#include <sstream>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/words.hpp"
#include "mesh/point_tree.hpp"
#include "mesh/wall_surface.hpp"
#include "parallel/rows.hpp"
#include "parallel/session.hpp"

namespace snag {
namespace {

constexpr std::size_t header_bytes = 84, triangle_bytes = 50;
constexpr double joining_distance = 1e-9;    // over the diagonal of the bounding box
constexpr double largest_coordinate = 1e30;  // in the unit of the file: areas and their squares stay finite

std::vector<Vec3> binary_corners(const std::string& content, std::size_t n_triangles) {
  std::vector<Vec3> corners;
  corners.reserve(3 * n_triangles);
  for (std::size_t t = 0; t < n_triangles; ++t) {
    std::array<float, 12> values;
    std::memcpy(values.data(), content.data() + header_bytes + t * triangle_bytes, sizeof values);
    for (std::size_t i = 3; i < 12; i += 3) corners.push_back({values[i], values[i + 1], values[i + 2]});
  }
  return corners;
}

std::vector<Vec3> ascii_corners(const std::string& content, const std::string& name) {
  std::vector<Vec3> corners;
  std::istringstream stream(content);
  for (std::string word; stream >> word;) {
    if (word != "vertex") continue;
    Vec3 x;
    if (!(stream >> x.x >> x.y >> x.z))
      throw Error(ExitCode::io,
                  name + ": corner " + std::to_string(corners.size() + 1) + " is not three numbers; export the STL file again");
    corners.push_back(x);
  }
  if (corners.empty() || corners.size() % 3 != 0 || content.find("endsolid") == std::string::npos)
    throw Error(ExitCode::io, name + ": " + std::to_string(corners.size()) +
                                  " corners, an ASCII STL file has a multiple of three and the word endsolid "
                                  "(and a binary one 84 + 50 n bytes); the file is cut off or not STL, export it again");
  return corners;
}

/// A damaged file may have coordinates that are not numbers.
void check_corners(const std::vector<Vec3>& corners, const std::string& name) {
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (const Vec3& x = corners[i]; !(norm_squared(x) < largest_coordinate * largest_coordinate))
      throw Error(ExitCode::io, name + ": triangle " + std::to_string(i / 3 + 1) + " has the corner (" + number_text(x.x) + ", " +
                                    number_text(x.y) + ", " + number_text(x.z) + "), coordinates must be numbers below " +
                                    number_text(largest_coordinate) + "; the file is damaged, export the STL file again");
}

std::vector<Vec3> corners_of(const std::filesystem::path& file) {
  const std::string content = file_text(file).value_or("");
  if (content.empty())
    throw Error(ExitCode::io, file.string() + ": the STL file cannot be read or is empty; check the path and its permissions");
  if (content.size() >= header_bytes) {
    std::uint32_t n_triangles = 0;
    std::memcpy(&n_triangles, content.data() + header_bytes - sizeof n_triangles, sizeof n_triangles);
    if (n_triangles > 0 && content.size() == header_bytes + triangle_bytes * n_triangles) return binary_corners(content, n_triangles);
  }
  return ascii_corners(content, file.string());
}

/// For every corner the number of its node; corners closer than the joining distance are one node, at the place of the first.
std::vector<int> joined(std::vector<Vec3>& corners) {
  Vec3 lower = corners[0], upper = corners[0];
  for (const Vec3& x : corners)
    for (int axis = 0; axis < 3; ++axis) lower[axis] = std::min(lower[axis], x[axis]), upper[axis] = std::max(upper[axis], x[axis]);
  const double radius_squared = joining_distance * joining_distance * norm_squared(upper - lower);
  const std::vector<Vec3> original = corners;
  const PointTree tree(original);
  std::vector<int> node(corners.size(), -1);
  std::vector<std::pair<unsigned, double>> near;
  int n_nodes = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (node[i] >= 0) continue;
    tree->radiusSearch(&original[i].x, radius_squared + std::numeric_limits<double>::min(), near, nanoflann::SearchParams());
    node[i] = n_nodes;
    for (const auto& [other, distance_squared] : near)
      if (node[other] < 0) node[other] = n_nodes, corners[other] = original[i];
    ++n_nodes;
  }
  return node;
}

}  // namespace

WallSurface read_stl(const std::filesystem::path& file, const std::string& part, double scale) {
  std::vector<Vec3> corners;
  MPI_Comm comm = MPI_COMM_WORLD;
  on_all_ranks(comm, [&] {
    if (rank_of(comm) != 0) return;
    corners = corners_of(file);
    check_corners(corners, file.string());
  });
  auto n = static_cast<std::int64_t>(corners.size());
  MPI_Bcast(&n, 1, MPI_INT64_T, 0, comm);
  corners.resize(static_cast<std::size_t>(n));
  broadcast<Vec3>(comm, corners);
  for (Vec3& x : corners) x *= scale;

  const std::vector<int> node = joined(corners);
  WallSurface surface{{part}, {}};
  int n_flat = 0;
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    WallTriangle triangle{{corners[i], corners[i + 1], corners[i + 2]}, {}, 0, {node[i], node[i + 1], node[i + 2]}};
    triangle.normal = unit(cross(triangle.node[1] - triangle.node[0], triangle.node[2] - triangle.node[0]));
    if (triangle.normal == Vec3{}) {
      ++n_flat;
      continue;
    }
    surface.triangles.push_back(triangle);
  }
  if (surface.triangles.empty())
    throw Error(ExitCode::io, file.string() + ": none of its " + std::to_string(n_flat) +
                                  " triangles has an area, at least one must have; check the file, export the STL file again");
  if (n_flat > 0) log::warning(file.string() + ": " + std::to_string(n_flat) + " triangles without area are left out");
  return surface;
}

}  // namespace snag
