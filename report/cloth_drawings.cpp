#include "report/cloth_drawings.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "base/words.hpp"
#include "report/html.hpp"

namespace snag {

namespace {

constexpr const char *measured_colour = "#D55E00", *table_colour = "#9aa7b4";

}  // namespace

std::string figure_of(const NamedDrawing& drawing) {
  return "<figure>" + drawing.svg + "<figcaption>" + escaped(drawing.caption) + "</figcaption></figure>\n";
}

std::string line_colour(std::size_t k) {
  constexpr const char* colours[] = {"#0072B2", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"};
  return colours[k % std::size(colours)];
}

std::string millimetres(double length) { return number_text(std::round(1e4 * length) / 10) + " mm"; }

std::string percent(double ratio) {
  char text[32];
  std::snprintf(text, sizeof text, "%+.1f %%", 100 * ratio);
  return text;
}

Drawing over_the_edge(const TextileTests& tests, int direction, double radius) {
  const double length = tests.bending[direction].overhang, angle = tests.plane_angle;
  Drawing drawing({-0.25 * length, -0.85 * length}, {1.1 * length, 0.15 * length});
  drawing.area({{-0.25 * length, -radius}, {0, -radius}, {0, -0.85 * length}, {-0.25 * length, -0.85 * length}}, "#e6eaef");
  drawing.line({{0, 0}, {1.05 * length * std::cos(angle), -1.05 * length * std::sin(angle)}}, measured_colour, 1.5, true);
  return drawing;
}

void add_strip(const TextileTests& tests, int direction, const StripShape& shape, const std::string& colour, Drawing& drawing) {
  std::vector<DrawingPoint> axis{{-0.25 * tests.bending[direction].overhang, 0}};
  for (const Vec3& x : shape.centres) axis.push_back({x.x, x.z});
  axis.push_back({shape.tip.x, shape.tip.z});
  drawing.line(axis, colour, 2);
}

Drawing from_above(const TextileTests& tests) {
  const double reach = 0.53 * tests.drape.sample_diameter;
  return Drawing({-reach, -reach}, {reach, reach});
}

void add_circles(const TextileTests& tests, Drawing& drawing) {
  drawing.circle({}, tests.drape.disc_diameter / 2, table_colour);
  drawing.circle({}, tests.drape.wave_size, measured_colour, "none", true);
}

void add_outline(const Outline& outline, const std::string& colour, Drawing& drawing) {
  std::vector<DrawingPoint> points;
  for (std::size_t i = 0; i <= outline.radius.size(); i += 2) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(outline.radius.size()),
                 r = outline.radius[i % outline.radius.size()];
    points.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  drawing.line(points, colour);
}

}  // namespace snag
