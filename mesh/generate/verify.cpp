#include "mesh/generate/verify.hpp"

#include <spdlog/fmt/fmt.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>
#include <set>

#include "mesh/generate/cells.hpp"

namespace snag::generate {

namespace {

constexpr double closure_limit = 1e-12;    // of a volume's boundary, relative
constexpr double volume_limit = 0.05;      // of the mesh against the curved shape, relative
constexpr double equal_area_limit = 1e-3;  // between the two sides of a sliding interface, relative
constexpr double periodic_limit = 1e-9;    // distance of partners over the distance of the surfaces

void examine_cells(const Cells& cells, const Cells::Volume& volume, MeshReport::Volume& result, MeshReport& report) {
  std::size_t first = 0;
  for (const CellKind* kind : volume.kind) {
    const double q = quality(*kind, std::span(volume.node).subspan(first, kind->n_nodes), cells);
    first += kind->n_nodes;
    ++result.cells[kind->name];
    report.min_quality = std::min(report.min_quality, q);
    report.mean_quality += q;
    report.n_poor += q < report.quality_limit;
  }
  report.n_cells += static_cast<std::int64_t>(volume.kind.size());
}

// Volume and closure of the boundary; returns the number of its edges that do not have two faces.
std::int64_t examine_boundary(const Cells& cells, const Cells::Volume& volume, MeshReport::Volume& result) {
  Vec3 sum;
  double areas = 0;
  std::vector<std::pair<Node, Node>> edges;
  for (const auto& face : volume.boundary) {
    const Vec3 S = area_vector(cells, face.nodes);
    sum += S;
    areas += norm(S);
    result.volume += volume_share(cells, face.nodes);
    const std::size_t n = face.nodes[3] ? 4 : 3;
    for (std::size_t k = 0; k < n; ++k) edges.push_back(std::minmax(face.nodes[k], face.nodes[(k + 1) % n]));
  }
  result.closure = areas > 0 ? norm(sum) / areas : 1;
  std::ranges::sort(edges);
  std::int64_t open_edges = 0;
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    while (end < edges.size() && edges[end] == edges[i]) ++end;
    open_edges += end - i != 2;
  }
  return open_edges;
}

void examine_volume(const Cells& cells, const Cells::Volume& volume, const Expectation& expectation, MeshReport& report) {
  MeshReport::Volume result;
  result.name = volume.name;
  result.n_components = volume.n_components;
  examine_cells(cells, volume, result, report);
  const auto open_edges = examine_boundary(cells, volume, result);

  const auto fail = [&](const std::string& text) { report.failures.push_back("volume " + volume.name + ": " + text); };
  if (volume.n_crowded_faces > 0) fail(fmt::format("{} faces belong to three cells or more", volume.n_crowded_faces));
  if (open_edges > 0) fail(fmt::format("{} edges of its boundary do not have two faces", open_edges));
  if (result.closure > closure_limit)
    fail(fmt::format("its boundary does not close (relative {:.1e}, limit {:.0e})", result.closure, closure_limit));
  for (const auto& expected : expectation.volumes) {
    if (expected.name != volume.name) continue;
    result.exact_volume = expected.exact_volume;
    if (expected.n_components != volume.n_components)
      fail(fmt::format("has {} separate parts, expected are {}", volume.n_components, expected.n_components));
    if (expected.exact_volume > 0 && std::abs(result.volume / expected.exact_volume - 1) > volume_limit)
      fail(fmt::format("has {:.6g} m3, the shape {:.6g} m3; take smaller sizes", result.volume, expected.exact_volume));
  }
  report.volumes.push_back(result);
}

// Every boundary face lies in one named surface, and every named face is a boundary face.
void examine_surfaces(const Cells& cells, MeshReport& report) {
  for (const auto& surface : cells.surfaces) report.surfaces.push_back({.name = surface});
  std::vector<const CellFace*> boundary;
  for (const auto& volume : cells.volumes)
    for (const auto& face : volume.boundary) boundary.push_back(&face);
  std::ranges::sort(boundary, {}, [](const CellFace* face) { return face->key; });
  auto named = cells.named;
  std::ranges::sort(named, {}, &NamedFace::key);
  std::int64_t unnamed = 0, repeated = 0;
  std::size_t matched = 0, k = 0;
  for (const CellFace* face : boundary) {
    while (k < named.size() && named[k].key < face->key) ++k;
    std::size_t end = k;
    while (end < named.size() && named[end].key == face->key) ++end;
    unnamed += end == k;
    repeated += end > k + 1;
    if (end == k) continue;
    auto& surface = report.surfaces[static_cast<std::size_t>(named[k].surface)];
    ++surface.n_faces;
    surface.area += norm(area_vector(cells, face->nodes));
    matched += end - k;
  }
  if (unnamed > 0) report.failures.push_back(fmt::format("{} boundary faces lie in no named surface", unnamed));
  if (repeated > 0) report.failures.push_back(fmt::format("{} boundary faces lie in more than one named surface", repeated));
  if (matched != named.size()) report.failures.push_back(fmt::format("{} faces of named surfaces bound no cell", named.size() - matched));
}

void examine_nodes(const Cells& cells, MeshReport& report) {
  std::vector<const Cells::Volume*> user(cells.position.size(), nullptr);
  std::int64_t shared = 0;
  for (const auto& volume : cells.volumes)
    for (const Node node : volume.node) {
      shared += user[node] && user[node] != &volume;
      user[node] = &volume;
    }
  report.n_nodes = std::ranges::count_if(user, [](const auto* volume) { return volume != nullptr; });
  const auto stray = std::ranges::count(cells.exists, true) - report.n_nodes;
  if (shared > 0) report.failures.push_back("volumes share nodes: they would not slide");
  if (stray > 0) report.failures.push_back(fmt::format("{} nodes belong to no cell", stray));
}

std::vector<Vec3> points_of(const Cells& cells, const std::string& surface) {
  std::set<Node> nodes;
  for (const auto& face : cells.named)
    if (cells.surfaces[static_cast<std::size_t>(face.surface)] == surface)
      for (const Node node : face.key)
        if (node != 0) nodes.insert(node);
  std::vector<Vec3> points;
  for (const Node node : nodes) points.push_back(cells.position[node]);
  return points;
}

void examine_periodic(const Cells& cells, const Expectation::Match& match, MeshReport& report) {
  const auto from = points_of(cells, match.first), to = points_of(cells, match.second);
  double worst = from.size() == to.size() && !to.empty() ? 0 : std::numeric_limits<double>::infinity();
  if (worst == 0) {
    Eigen::MatrixX3d points(static_cast<Eigen::Index>(to.size()), 3);
    for (std::size_t i = 0; i < to.size(); ++i) points.row(static_cast<Eigen::Index>(i)) << to[i].x, to[i].y, to[i].z;
    const nanoflann::KDTreeEigenMatrixAdaptor<Eigen::MatrixX3d> tree(3, points);
    for (const Vec3& x : from) {
      const Vec3 shifted = x + match.translation;
      Eigen::Index nearest = 0;
      double distance_squared = 0;
      nanoflann::KNNResultSet<double, Eigen::Index> result(1);
      result.init(&nearest, &distance_squared);
      tree.index->findNeighbors(result, &shifted.x, nanoflann::SearchParams());
      worst = std::max(worst, std::sqrt(distance_squared));
    }
  }
  if (!(worst <= periodic_limit * norm(match.translation)))
    report.failures.push_back(
        fmt::format("{} and {} are periodic, but a node misses its partner by {:.3g} m", match.first, match.second, worst));
}

double area_of(const MeshReport& report, const std::string& name) {
  for (const auto& surface : report.surfaces)
    if (surface.name == name) return surface.area;
  return 0;
}

}  // namespace

MeshReport verified(const Expectation& expectation) {
  const Cells cells = current_cells();
  MeshReport report;
  report.min_quality = 1;
  report.quality_limit = expectation.minimum_quality;
  for (const auto& volume : cells.volumes) examine_volume(cells, volume, expectation, report);
  if (report.n_cells == 0) report.failures.push_back("there are no cells");
  report.mean_quality /= static_cast<double>(std::max<std::int64_t>(1, report.n_cells));
  if (report.n_poor > 0)
    report.failures.push_back(fmt::format("{} cells have a quality below {} (worst {:.3g}); change sizes or shape a little", report.n_poor,
                                          report.quality_limit, report.min_quality));
  examine_surfaces(cells, report);
  examine_nodes(cells, report);
  for (const auto& [first, second] : expectation.equal_areas) {
    const double difference = area_of(report, first) / area_of(report, second) - 1;
    if (!(std::abs(difference) < equal_area_limit))
      report.failures.push_back(
          fmt::format("areas of {} and {} differ by {:.2e}, limit {:.0e}", first, second, difference, equal_area_limit));
  }
  for (const auto& match : expectation.periodic) examine_periodic(cells, match, report);
  return report;
}

std::string table(const MeshReport& report) {
  std::string text = fmt::format("{:<22}{:>12}{:>8}{:>16}{:>16}{:>14}{:>12}\n", "volume", "cells", "parts", "volume [m3]", "of the shape",
                                 "mesh/shape-1", "closure");
  for (const auto& volume : report.volumes) {
    std::int64_t n = 0;
    std::string kinds;
    for (const auto& [kind, count] : volume.cells) n += count, kinds += fmt::format("{}{} {}", kinds.empty() ? "" : ", ", count, kind);
    text +=
        fmt::format("{:<22}{:>12}{:>8}{:>16.7e}{:>16}{:>14}{:>12.1e}  {}\n", volume.name, n, volume.n_components, volume.volume,
                    volume.exact_volume > 0 ? fmt::format("{:.7e}", volume.exact_volume) : "",
                    volume.exact_volume > 0 ? fmt::format("{:+.2e}", volume.volume / volume.exact_volume - 1) : "", volume.closure, kinds);
  }
  text += fmt::format("{:<22}{:>12}{:>24}\n", "surface", "faces", "area [m2]");
  for (const auto& surface : report.surfaces) text += fmt::format("{:<22}{:>12}{:>24.7e}\n", surface.name, surface.n_faces, surface.area);
  text += fmt::format("cells {}, nodes {}, quality: least {:.3f}, mean {:.3f}, below {}: {}\n", report.n_cells, report.n_nodes,
                      report.min_quality, report.mean_quality, report.quality_limit, report.n_poor);
  return text;
}

}  // namespace snag::generate
