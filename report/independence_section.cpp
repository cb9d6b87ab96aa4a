#include "report/independence_section.hpp"

#include "base/words.hpp"
#include "report/html.hpp"
#include "report/line_plot.hpp"

namespace snag {

namespace {

NamedDrawing strips(const TextileTests& tests, const Independence& found, int d) {
  Drawing drawing = over_the_edge(tests, d, found.radii.front().radius);
  std::string radii;
  for (std::size_t i = 0; i < found.radii.size(); ++i) {
    add_strip(tests, d, found.radii[i].strip[d], line_colour(i), drawing);
    radii += (i ? ", " : "") + millimetres(found.radii[i].radius);
  }
  return {"independence_strip_" + std::string(direction_key[d]) + ".svg",
          std::string("Strips ") + direction_name[d] + " of particles of " + radii + " (blue, green, pink, orange, pale blue)",
          drawing.svg()};
}

template <class Name>
NamedDrawing outlines(const TextileTests& tests, const std::vector<DampingPoint>& points, const std::string& file, const std::string& what,
                      const Name& name) {
  Drawing drawing = from_above(tests);
  add_circles(tests, drawing);
  std::string values;
  for (std::size_t i = 0; i < points.size(); ++i) {
    add_outline(points[i].outline, line_colour(i), drawing);
    values += (i ? ", " : "") + number_text(name(points[i]));
  }
  return {file, what + " " + values + " (blue, green, pink, orange), from the same laying", drawing.svg()};
}

double damping_of(const DampingPoint& point) { return point.bond_damping; }
double friction_of(const DampingPoint& point) { return point.rotation_friction; }

std::string radius_tables(const TextileTests& tests, const Independence& found) {
  std::string text;
  for (int d = 0; d < 2; ++d) {
    std::vector<std::vector<std::string>> rows;
    for (const RadiusPoint& point : found.radii)
      rows.push_back({millimetres(point.radius), html::number(point.bond[d].normal_stiffness),
                      html::number(point.bond[d].bending_stiffness), html::number(point.grab[d].max_force),
                      html::number(point.grab[d].strain_at_max), html::number(1e3 * point.height[d])});
    text += html::table({std::string("Radius, ") + direction_name[d], "S_n, N/m<sup>3</sup>", "S_nb, N/m<sup>3</sup>", "largest force, N",
                         "strain there", "tip above the plane, mm"},
                        rows);
  }
  return text + "<p>Over these radii the strain at the largest force differs by " + html::number(100 * found.strain_spread(0)) + " %" +
         " lengthwise and " + html::number(100 * found.strain_spread(1)) + " %" + " crosswise, the force by " +
         html::number(100 * found.force_spread(0)) + " %" + " and " + html::number(100 * found.force_spread(1)) + " %" +
         " (measured: " + html::number(tests.elongation[0].max_force) + " N and " + html::number(tests.elongation[1].max_force) +
         " N; whole particles do not make up clamps and gauge exactly; the force is looked at 400 times before it is due).</p>\n";
}

std::string step_table(const TextileTests& tests, const Independence& found) {
  std::vector<std::vector<std::string>> rows;
  for (const StepPoint& point : found.steps)
    rows.push_back({html::number(point.share), html::number(point.grab.max_force), html::number(point.grab.strain_at_max),
                    html::number(1e3 * height_above_plane(point.strip.tip, tests.plane_angle))});
  return html::table({"Step over the stable one", "largest force lengthwise, N", "strain there", "tip above the plane, mm"}, rows) +
         "<p>Both tests here by the motion of the particles. Between these steps the tip moves by " +
         html::number(100 * found.tip_spread()) + " % of its distance from the edge.</p>\n";
}

template <class Name>
std::string drape_table(const TextileTests& tests, const std::vector<DampingPoint>& points, const std::string& what, const Name& name) {
  std::vector<std::vector<std::string>> rows;
  for (const DampingPoint& point : points)
    rows.push_back({number_text(name(point)),
                    html::number(1e4 * point.outline.area) + " (" + percent(point.outline.area / tests.drape.area - 1) + ")",
                    html::number(1e3 * point.outline.mean_wave_size()) + " (" +
                        percent(point.outline.mean_wave_size() / tests.drape.wave_size - 1) + ")",
                    std::to_string(point.outline.waves.size())});
  return html::table({what, "area, cm<sup>2</sup> (from the measured mean)", "wave size, mm", "waves"}, rows);
}

}  // namespace

std::vector<NamedDrawing> independence_drawings(const TextileTests& tests, const Independence& found) {
  return {strips(tests, found, 0), strips(tests, found, 1),
          outlines(tests, found.dampings, "independence_damping.svg", "Drapes with a damping ratio of", damping_of),
          outlines(tests, found.frictions, "independence_friction.svg", "Drapes with a rotation friction of", friction_of)};
}

std::string independence_section(const TextileTests& tests, const IndependencePart& part) {
  const Independence& found = part.found;
  std::string plots;
  for (int d = 0; d < 2; ++d) {
    LinePlot pull{std::string("Grab test ") + direction_name[d] + " by particle radius", "strain", "force, N", {}};
    LinePlot stiffness{std::string("Bending stiffness ") + direction_name[d], "particle radius, mm", "S_nb, N/m3", {}, true};
    stiffness.lines = {{"calibrated", {}, {}}};
    stiffness.lines[0].dotted = true;
    for (const RadiusPoint& point : found.radii) {
      pull.lines.push_back({millimetres(point.radius), point.grab[d].strain, point.grab[d].force});
      stiffness.lines[0].x.push_back(1e3 * point.radius), stiffness.lines[0].y.push_back(point.bond[d].bending_stiffness);
    }
    plots += figure(pull) + figure(stiffness);
  }
  std::string drawings[2];
  for (std::size_t i = 0; i < part.drawings.size(); ++i) drawings[i / 2] += figure_of(part.drawings[i]);
  const auto side_by_side = [](const std::string& figures) { return "<div class=\"plots\">\n" + figures + "</div>\n"; };
  return "<p>Particle radius: bonds calibrated anew for each, the tangential stiffness kept times the radius squared.</p>\n" +
         side_by_side(plots) + side_by_side(drawings[0]) + radius_tables(tests, found) + "<p>Time step, at " + millimetres(part.radius) +
         ".</p>\n" + step_table(tests, found) + "<p>Dashpots and rotation friction of the bonds, at " + millimetres(part.radius) +
         ": the cloth falls for " + number_text(drape_duration) + " s from the same laying.</p>\n" + side_by_side(drawings[1]) +
         drape_table(tests, found.dampings, "Damping ratio", damping_of) +
         drape_table(tests, found.frictions, "Rotation friction", friction_of);
}

}  // namespace snag
