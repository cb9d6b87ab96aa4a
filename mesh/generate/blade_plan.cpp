#include "mesh/generate/blade_plan.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/error.hpp"

namespace snag::generate {

namespace {

constexpr double pi = std::numbers::pi, corner_turn = pi / 6;
constexpr double long_side = 10;       // lengths of wall_size from which on a side is finer towards its ends
constexpr double longest_spoke = 1.6;  // depth of the layers at a sharp corner over that along a side

double signed_area(const std::vector<Plane>& points) {
  double twice = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto &a = points[i], &b = points[(i + 1) % points.size()];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return twice / 2;
}

Plane difference(const Plane& a, const Plane& b) { return {a[0] - b[0], a[1] - b[1]}; }
double length(const Plane& a) { return std::hypot(a[0], a[1]); }

// At each point: the angle by which the outline turns, and the direction out of the blade that halves it.
struct Bend {
  double turn;
  Plane outwards;
};

std::vector<Bend> bends_of(const std::vector<Plane>& points) {
  const double side = signed_area(points) > 0 ? 1 : -1;
  const std::size_t n = points.size();
  std::vector<Bend> bends;
  for (std::size_t i = 0; i < n; ++i) {
    const Plane u = difference(points[i], points[(i + n - 1) % n]), v = difference(points[(i + 1) % n], points[i]);
    const double turn = std::atan2(u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1]), direction = std::atan2(u[1], u[0]) + turn / 2;
    bends.push_back({std::abs(turn), {side * std::sin(direction), -side * std::cos(direction)}});
  }
  return bends;
}

// Depth of the layers at a point over that along a straight wall.
double spoke(const Bend& bend) { return std::min(1 / std::cos(bend.turn / 2), longest_spoke); }

// Cells along one piece of an outline of length L that grow from `first` at one end to `last` at the other.
struct Grading {
  int cells;
  double ratio;
};

Grading grading(double L, double first, double last) {
  if (L < first + last || first == last) return {std::max(1, static_cast<int>(std::lround(2 * L / (first + last)))), 1};
  const double ratio = (L - first) / (L - last);
  const int cells = std::max(1, static_cast<int>(std::lround(1 + std::log(last / first) / std::log(ratio))));
  return {cells, std::pow(last / first, 1.0 / std::max(1, cells - 1))};
}

// Pieces of an outline: it is cut at its corners, and long sides in their middle. [from, to] are indices of points; sizes at both ends, m.
struct Piece {
  std::size_t from, to;
  Grading grading;
};

std::vector<Piece> pieces_of(const std::vector<Plane>& points, const std::vector<Bend>& bends, double edge, double wall) {
  const std::size_t n = points.size();
  const auto within = [n](std::size_t i) { return i < n ? i : i - n; };
  std::vector<std::size_t> corners;
  for (std::size_t i = 0; i < n; ++i)
    if (bends[i].turn > corner_turn) corners.push_back(i);
  if (corners.size() < 2) throw Error(ExitCode::usage, "[blade_rows]: an outline, must have two corners or more; end it with sharp edges");
  std::vector<Piece> pieces;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const std::size_t from = corners[k], to = corners[(k + 1) % corners.size()];
    std::vector<double> reached{0};
    for (std::size_t j = from; j != to; j = within(j + 1))
      reached.push_back(reached.back() + length(difference(points[within(j + 1)], points[j])));
    const double L = reached.back();
    if (L < long_side * wall) {
      pieces.push_back({from, to, grading(L, edge, edge)});
      continue;
    }
    const auto half = std::ranges::min_element(reached, {}, [L](double l) { return std::abs(l - L / 2); });
    const std::size_t middle = within(from + static_cast<std::size_t>(half - reached.begin()));
    pieces.push_back({from, middle, grading(*half, edge, wall)});
    const Grading back = grading(L - *half, edge, wall);
    pieces.push_back({middle, to, {back.cells, 1 / back.ratio}});
  }
  return pieces;
}

}  // namespace

std::vector<double> rooms_of(const std::vector<Plane>& outline, double depth) {
  std::vector<double> rooms;
  for (const Bend& bend : bends_of(outline)) rooms.push_back(depth * spoke(bend));
  return rooms;
}

Row row_of(const std::vector<Plane>& outline, int count, double edge_size, double wall_size, const Layers& layers) {
  namespace geo = gmsh::model::geo;
  Row row;
  row.area = std::abs(signed_area(outline));
  const auto bends = bends_of(outline);
  const auto pieces = pieces_of(outline, bends, edge_size, wall_size);
  const std::size_t n = outline.size();
  for (int k = 0; k < count; ++k) {
    const double c = std::cos(2 * pi * k / count), s = std::sin(2 * pi * k / count);
    std::vector<int> wall_points, outer_points, walls, frame;
    for (std::size_t i = 0; i < n; ++i) {
      const double depth = layers.depth * spoke(bends[i]);
      const auto& [x, y] = outline[i];
      const double X = x + depth * bends[i].outwards[0], Y = y + depth * bends[i].outwards[1];
      wall_points.push_back(geo::addPoint(c * x - s * y, s * x + c * y, 0));
      outer_points.push_back(geo::addPoint(c * X - s * Y, s * X + c * Y, 0));
    }
    const auto curve = [&](const std::vector<int>& points, const Piece& piece) {
      std::vector<int> part{points[piece.from]};
      for (std::size_t j = piece.from; j != piece.to;) {
        j = j + 1 < n ? j + 1 : 0;
        part.push_back(points[j]);
      }
      const int tag = part.size() > 2 ? geo::addSpline(part) : geo::addLine(part[0], part[1]);
      geo::mesh::setTransfiniteCurve(tag, piece.grading.cells + 1, "Progression", piece.grading.ratio);
      return tag;
    };
    std::map<std::size_t, int> spokes;
    for (const Piece& piece : pieces) {
      const int spoke = spokes[piece.from] = geo::addLine(wall_points[piece.from], outer_points[piece.from]);
      geo::mesh::setTransfiniteCurve(spoke, layers.count + 1, "Progression", layers.growth);
    }
    for (const Piece& piece : pieces) {
      const int wall = curve(wall_points, piece), outer = curve(outer_points, piece);
      const int layer = geo::addPlaneSurface({geo::addCurveLoop({wall, spokes[piece.to], -outer, -spokes[piece.from]})});
      geo::mesh::setTransfiniteSurface(layer);
      geo::mesh::setRecombine(2, layer);
      row.layers.push_back(layer);
      walls.push_back(wall);
      frame.push_back(outer);
      if (bends[piece.from].turn > corner_turn) row.corners.push_back(outer_points[piece.from]);
    }
    row.wall_loops.push_back(geo::addCurveLoop(walls));
    row.loops.push_back(geo::addCurveLoop(frame));
    row.walls.insert(row.walls.end(), walls.begin(), walls.end());
    row.frames.insert(row.frames.end(), frame.begin(), frame.end());
  }
  return row;
}

std::vector<int> circle(double radius, double start) {
  namespace geo = gmsh::model::geo;
  const int centre = geo::addPoint(0, 0, 0);
  std::vector<int> points, arcs;
  for (int k = 0; k < 4; ++k)
    points.push_back(geo::addPoint(radius * std::cos(start + k * pi / 2), radius * std::sin(start + k * pi / 2), 0));
  for (std::size_t k = 0; k < 4; ++k) arcs.push_back(geo::addCircleArc(points[k], centre, points[(k + 1) % 4]));
  return arcs;
}

Ring ring_of(std::vector<int> inner, std::vector<int> outer, Row row) {
  namespace geo = gmsh::model::geo;
  std::vector<int> loops{geo::addCurveLoop(outer), geo::addCurveLoop(inner)};
  loops.insert(loops.end(), row.loops.begin(), row.loops.end());
  const int surface = geo::addPlaneSurface(loops);
  geo::mesh::setRecombine(2, surface);
  return {std::move(inner), std::move(outer), std::move(row), surface};
}

}  // namespace snag::generate
