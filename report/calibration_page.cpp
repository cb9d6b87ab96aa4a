#include "report/calibration_page.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "base/words.hpp"
#include "report/html.hpp"
#include "report/independence_section.hpp"
#include "report/line_plot.hpp"
#include "report/page.hpp"

namespace snag {

namespace {

constexpr double pi = std::numbers::pi;
constexpr const char* cloth_colour = "#0072B2";

std::string stem(const Calibration& c) { return "r" + number_text(1e3 * c.settings.radius) + "mm"; }

std::string range_text(const MeasuredRange& range, double scale) {
  return range.given() ? html::number(scale * range.low) + " to " + html::number(scale * range.high) : "";
}

/// The strip over the edge, the plane, and the points where measured overhangs would touch it.
NamedDrawing strip_drawing(const TextileTests& tests, const Calibration& c, int d) {
  Drawing drawing = over_the_edge(tests, d, c.settings.radius);
  for (const Vec3& x : c.bending[d].shape.centres) drawing.circle({x.x, x.z}, c.settings.radius, cloth_colour);
  add_strip(tests, d, c.bending[d].shape, cloth_colour, drawing);
  return {"strip_" + std::string(direction_key[d]) + "_" + stem(c) + ".svg",
          std::string("Strip ") + direction_name[d] + ", " + millimetres(tests.bending[d].overhang) +
              " over the edge; dashed: the plane at " + number_text(std::round(1800 / pi * tests.plane_angle) / 10) + " degrees",
          drawing.svg()};
}

/// Cells of the cloth from the lowest up, lit from the upper left.
NamedDrawing drape_drawing(const TextileTests& tests, const Calibration& c) {
  const RagSheet& sheet = c.sheet;
  struct Cell {
    double height;
    std::array<int, 4> corner;
  };
  std::vector<Cell> cells;
  for (std::size_t t = 0; t + 1 < sheet.triangles.size(); t += 2) {  // two triangles a cell: (a, b, d), (a, d, c)
    const auto &one = sheet.triangles[t], &two = sheet.triangles[t + 1];
    const std::array<int, 4> corner{one[0], one[1], one[2], two[2]};
    double height = 0;
    for (const int k : corner) height += sheet.position[k].z / 4;
    cells.push_back({height, corner});
  }
  std::sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) { return a.height < b.height; });
  Drawing drawing = from_above(tests);
  const Vec3 light = unit(Vec3{-0.5, 0.6, 0.7});
  for (const Cell& cell : cells) {
    const auto& p = sheet.position;
    Vec3 normal = unit(cross(p[cell.corner[2]] - p[cell.corner[0]], p[cell.corner[3]] - p[cell.corner[1]]));
    if (normal.z < 0) normal = -normal;
    const int shade = static_cast<int>(70 + 175 * std::max(0.0, dot(normal, light)));
    char colour[16];
    std::snprintf(colour, sizeof colour, "#%02x%02x%02x", shade * 9 / 10, shade * 95 / 100, shade);
    std::vector<DrawingPoint> points;
    for (const int k : cell.corner) points.push_back({p[k].x, p[k].y});
    drawing.area(points, colour);
  }
  add_circles(tests, drawing);
  return {"drape_" + stem(c) + ".svg", "The drape from above (first seed); grey circle: the table, dashed: the mean measured wave size",
          drawing.svg()};
}

NamedDrawing outline_drawing(const TextileTests& tests, const Calibration& c) {
  Drawing drawing = from_above(tests);
  for (const double size : {tests.drape.wave_size_range.low, tests.drape.wave_size_range.high})
    if (size > 0) drawing.circle({}, size, "#f0c9a8");
  add_circles(tests, drawing);
  std::size_t k = 0;
  for (const DrapeSample& sample : c.drapes[c.chosen].samples) {
    const std::string colour = line_colour(k++);
    add_outline(sample.outline, colour, drawing);
    for (const Wave& wave : sample.outline.waves)
      drawing.circle({wave.radius * std::cos(wave.angle), wave.radius * std::sin(wave.angle)}, 1.2e-3, colour, colour);
  }
  return {"outlines_" + stem(c) + ".svg",
          "Outlines of all seeds, dots at the waves; dashed: the mean measured wave size, pale: the smallest and largest", drawing.svg()};
}

std::string elongation_section(const TextileTests& tests, const Calibration& c) {
  std::string plots;
  std::vector<std::vector<std::string>> rows;
  for (int d = 0; d < 2; ++d) {
    const ElongationResult& m = tests.elongation[d];
    LinePlot plot{std::string("Grab test ") + direction_name[d], "strain", "force, N", {}};
    plot.lines = {{"simulated", c.grab[d].strain, c.grab[d].force}, {"measured: mean of the largest", {0, m.max_strain}, {0, m.max_force}}};
    plot.lines[1].dotted = true;
    if (m.force_range.given()) {
      plot.marks.push_back({m.force_range.low, "smallest measured", true});
      plot.marks.push_back({m.force_range.high, "largest measured", true});
    }
    plots += figure(plot);
    rows.push_back({std::string("Largest force ") + direction_name[d] + ", N",
                    html::number(m.max_force) + " (" + range_text(m.force_range, 1) + ")", html::number(c.grab[d].max_force)});
    rows.push_back({std::string("Strain there, ") + direction_name[d], html::number(m.max_strain), html::number(c.grab[d].strain_at_max)});
  }
  return "<div class=\"plots\">\n" + plots + "</div>\n" + html::table({"", "measured", "simulated"}, rows) +
         (c.settings.as_published
              ? "<p class=\"note\">Clamps counted twice, as published: the cloth carries half of the measured force.</p>\n"
              : "");
}

std::string bending_section(const TextileTests& tests, const Calibration& c, const std::vector<NamedDrawing>& drawings) {
  std::vector<std::vector<std::string>> rows;
  for (int d = 0; d < 2; ++d)
    rows.push_back({std::string("Tip above the plane, ") + direction_name[d] + ", mm", "0 at " + millimetres(tests.bending[d].overhang),
                    html::number(1e3 * c.bending[d].height)});
  return "<div class=\"plots\">\n" + figure_of(drawings[0]) + figure_of(drawings[1]) + "</div>\n" +
         html::table({"", "measured", "simulated"}, rows);
}

std::string drape_section(const TextileTests& tests, const Calibration& c, const std::vector<NamedDrawing>& drawings) {
  const DrapePoint& drape = c.drapes[c.chosen];
  const DrapeResult& m = tests.drape;
  LinePlot scan{"Deviation of the drape", "tangential stiffness, 10^6 N/m3", "deviation, %", {}};
  scan.lines = {{"area", {}, {}}, {"wave size", {}, {}}};
  for (const DrapePoint& point : c.drapes) {
    for (PlotLine& line : scan.lines) line.x.push_back(1e-6 * point.tangential_stiffness()), line.dotted = true;
    scan.lines[0].y.push_back(100 * (point.area / m.area - 1)), scan.lines[1].y.push_back(100 * (point.wave_size / m.wave_size - 1));
  }
  scan.marks = {{1e-6 * drape.tangential_stiffness(), "chosen"}};
  LinePlot curves{"Centre to outline", "angle, degrees", "distance, mm", {}};
  for (const DrapeSample& sample : drape.samples) {
    PlotLine line{"seed " + std::to_string(sample.seed), {}, {}};
    for (std::size_t i = 0; i < sample.outline.radius.size(); ++i)
      line.x.push_back(360.0 * static_cast<double>(i) / static_cast<double>(sample.outline.radius.size())),
          line.y.push_back(1e3 * sample.outline.radius[i]);
    curves.lines.push_back(line);
  }
  std::vector<std::vector<std::string>> rows{
      {"Area from above, cm<sup>2</sup>", html::number(1e4 * m.area),
       html::number(1e4 * drape.area) + " ± " + html::number(1e4 * drape.area_spread) + " (" + percent(drape.area / m.area - 1) + ")"},
      {"Mean wave size, mm",
       html::number(1e3 * m.wave_size) + (m.wave_size_range.given() ? " (single waves " + range_text(m.wave_size_range, 1e3) + ")" : ""),
       html::number(1e3 * drape.wave_size) + " ± " + html::number(1e3 * drape.wave_size_spread) + " (" +
           percent(drape.wave_size / m.wave_size - 1) + ")"},
      {"Waves", html::number(m.wave_count), html::number(drape.wave_count)}};
  for (const DrapeSample& sample : drape.samples)
    rows.push_back({"Seed " + std::to_string(sample.seed), "",
                    std::to_string(sample.outline.waves.size()) + " waves of " + html::number(1e3 * sample.outline.mean_wave_size()) +
                        " mm, " + html::number(1e4 * sample.outline.area) + " cm<sup>2</sup>; rest after " +
                        std::to_string(sample.cost.n_peaks) + " peaks, " + html::count(sample.cost.n_steps) + " steps"});
  return "<div class=\"plots\">\n" + figure_of(drawings[2]) + figure_of(drawings[3]) + figure(scan) + figure(curves) + "</div>\n" +
         html::table({"", "measured", "simulated"}, rows);
}

std::string properties_section(const TextileTests& tests, const Calibration& c) {
  struct Line {
    const char* name;
    double BondProperties::*value;
  };
  constexpr Line lines[] = {{"Normal stiffness S_n, N/m<sup>3</sup>", &BondProperties::normal_stiffness},
                            {"Critical stress, Pa", &BondProperties::normal_strength},
                            {"Bending stiffness S_nb, N/m<sup>3</sup>", &BondProperties::bending_stiffness},
                            {"Tangential stiffness S_t, N/m<sup>3</sup>", &BondProperties::tangential_stiffness}};
  std::vector<std::vector<std::string>> rows;
  for (const Line& line : lines)
    for (int d = 0; d < 2; ++d) {
      const double value = c.bond[d].*line.value;
      std::vector<std::string> row{std::string(line.name) + ", " + direction_name[d], html::number(value), "", ""};
      for (const PublishedBond& p : tests.published)
        if (p.direction == d && std::abs(p.radius - c.settings.radius) < 1e-9 && p.bond.*line.value > 0)
          row[2] = html::number(p.bond.*line.value), row[3] = html::number(value / (p.bond.*line.value));
      rows.push_back(row);
    }
  return html::table({"", "calibrated", "published", "ratio"}, rows) + "<p>The contact radius of " +
         number_text(tests.contact_radius_ratio) + " r_p lies between " + html::number(c.contact_radius.low) +
         ", which the largest strain asks for, and " + html::number(c.contact_radius.high) +
         ", above which particles that are no neighbours would be bonded.</p>\n";
}

}  // namespace

std::vector<NamedDrawing> calibration_drawings(const TextileTests& tests, const Calibration& c) {
  return {strip_drawing(tests, c, 0), strip_drawing(tests, c, 1), drape_drawing(tests, c), outline_drawing(tests, c)};
}

std::string calibration_page(const TextileTests& tests, const std::vector<Calibration>& calibrations,
                             const std::vector<std::vector<NamedDrawing>>& drawings, const std::optional<IndependencePart>& independence) {
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>Snag: calibration</title>\n<style>" +
      std::string(report_style) + "td:first-child { width: 40%; }</style>\n</head>\n<body>\n<h1>" + escaped(tests.name) +
      "</h1>\n<p class=\"origin\">" + escaped(tests.source) + "</p>\n";
  for (std::size_t i = 0; i < calibrations.size(); ++i) {
    const Calibration& c = calibrations[i];
    const std::string radius = " (particle radius " + millimetres(c.settings.radius) + ")";
    page += section("Properties" + radius, properties_section(tests, c));
    page += section("Elongation" + radius, elongation_section(tests, c));
    page += section("Bending" + radius, bending_section(tests, c, drawings[i]));
    page += section("Drape" + radius, drape_section(tests, c, drawings[i]));
  }
  if (independence) page += section("Independence of numerical parameters", independence_section(tests, *independence));
  return page + "</body>\n</html>\n";
}

}  // namespace snag
