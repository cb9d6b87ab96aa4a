#include "report/verdict_maps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include "base/words.hpp"
#include "observe/observables.hpp"
#include "report/html.hpp"
#include "report/verdict_words.hpp"

namespace snag {

namespace {

/// White where the score is zero, over yellow to dark red at six and more.
std::string heat(double score) {
  const double t = std::min(std::abs(score) / 6, 1.0);
  const auto channel = [t](double at_zero, double at_half, double at_one) {
    return static_cast<int>(t < 0.5 ? at_zero + 2 * t * (at_half - at_zero) : at_half + (2 * t - 1) * (at_one - at_half));
  };
  char text[32];
  std::snprintf(text, sizeof text, "rgb(%d,%d,%d)", channel(255, 254, 165), channel(255, 196, 15), channel(255, 79, 21));
  return text;
}

/// A place on the measured way of a point: the means of its coordinates over a part of the time, and the largest |score| of them there.
struct Place {
  std::map<std::string, double> at;  // by observable, m
  double score = 0;
};

/// The measured ways of all points.
struct Ways {
  std::map<std::string, std::map<double, Place>> of_point;  // by the begin of the part
  std::map<std::string, std::array<double, 2>> ranges;      // by coordinate

  /// The two coordinates that change most, x before y before z; fewer if fewer were measured.
  std::vector<std::string> axes() const {
    std::vector<std::string> all;
    for (const auto& [axis, range] : ranges) all.push_back(axis);
    const auto width = [&](const std::string& axis) { return ranges.at(axis)[1] - ranges.at(axis)[0]; };
    std::stable_sort(all.begin(), all.end(), [&](const std::string& a, const std::string& b) { return width(a) > width(b); });
    if (all.size() > 2) all.resize(2);
    std::sort(all.begin(), all.end());
    return all;
  }
};

Ways ways_of(const Verdict& v) {
  Ways ways;
  for (const GapCell& c : v.where) {
    const ObservableRecord* record = find_observable(c.observable);
    if (std::isnan(c.window[0]) || std::isnan(c.z) || !record || !record->is_position()) continue;
    Place& place = ways.of_point[c.point][c.window[0]];
    place.at[c.observable] = c.measured, place.score = std::max(place.score, std::abs(c.score));
    auto& [low, high] = ways.ranges.try_emplace(c.observable, std::array{c.measured, c.measured}).first->second;
    low = std::min(low, c.measured), high = std::max(high, c.measured);
  }
  for (const MissingForce& f : v.missing_force)
    for (std::size_t d = 0; d < f.place.size(); ++d)
      if (const auto range = ways.ranges.find(std::string(1, "xyz"[d])); range != ways.ranges.end() && !std::isnan(f.place.at(d)))
        range->second = {std::min(range->second[0], f.place.at(d)), std::max(range->second[1], f.place.at(d))};
  return ways;
}

constexpr const char *colour_before = "#c0392b", *colour_after = "#1f6fb2";

/// Size of the largest missing force of the base model in the plane of two coordinates, N/kg.
double largest_of(const std::vector<MissingForce>& forces, const std::vector<std::string>& axes) {
  const std::size_t a = std::string("xyz").find(axes[0]), b = std::string("xyz").find(axes[1]);
  double largest = 0;
  for (const MissingForce& f : forces)
    if (const double size = std::hypot(f.before.at(a), f.before.at(b)); std::isfinite(size)) largest = std::max(largest, size);
  return largest;
}

/// Missing forces as arrows from their places, in the plane of two coordinates; the longest is `longest` pixels long.
template <class Across, class Up>
std::string arrows(const Verdict& v, const std::vector<std::string>& axes, const Across& across, const Up& up) {
  constexpr double longest = 60, shortest = 1;
  const std::size_t a = std::string("xyz").find(axes[0]), b = std::string("xyz").find(axes[1]);
  const double largest = largest_of(v.missing_force, axes);
  std::string all;
  for (const MissingForce& f : v.missing_force) {
    for (const auto& [force, colour] : {std::pair{&f.before, colour_before}, std::pair{&f.after, colour_after}}) {
      const double dx = longest * force->at(a) / largest, dy = -longest * force->at(b) / largest, length = std::hypot(dx, dy);
      if (!(length > shortest) || std::isnan(f.place.at(a) + f.place.at(b))) continue;
      const double x = across(f.place.at(a)), y = up(f.place.at(b)), head = std::min(5.0, 0.5 * length) / length;
      const auto at = [](double px, double py) { return number_text(px) + " " + number_text(py); };
      const double tx = x + dx, ty = y + dy, bx = tx - head * dx, by = ty - head * dy;
      all += "<path d=\"M " + at(x, y) + " L " + at(tx, ty) + " M " + at(bx - 0.5 * head * dy, by + 0.5 * head * dx) + " L " + at(tx, ty) +
             " L " + at(bx + 0.5 * head * dy, by - 0.5 * head * dx) + "\" fill=\"none\" stroke=\"" + colour + "\" stroke-width=\"1.5\"/>\n";
    }
  }
  return all;
}

}  // namespace

std::string map_of_gap(const Verdict& v, double GapCell::*score) {
  constexpr double left = 190, top = 26, width = 56, height = 24;
  std::vector<std::string> points, rows;
  const auto place = [](std::vector<std::string>& list, const std::string& name) {
    const auto found = std::find(list.begin(), list.end(), name);
    if (found != list.end()) return static_cast<double>(found - list.begin());
    list.push_back(name);
    return static_cast<double>(list.size() - 1);
  };
  std::map<std::pair<std::string, std::string>, int> part;  // windows of an observable at a point so far
  std::string cells;
  for (const GapCell& c : v.where) {
    std::string row = c.observable + (c.region == "all" ? "" : ", " + c.region);
    if (std::isnan(c.z))
      row += ", " + (c.point == all_points ? std::string("together") : "all parts");
    else if (const int n = ++part[{c.point, row}]; !std::isnan(c.window[0]))
      row += ", part " + std::to_string(n);
    const double x = left + width * place(points, c.point), y = top + height * place(rows, row);
    char number[32];
    const double shown = std::abs(c.*score) < 0.05 ? 0 : c.*score;  // no "-0.0"
    std::snprintf(number, sizeof number, std::abs(shown) < 9.95 ? "%.1f" : "%.0f", shown);
    cells += "<rect x=\"" + number_text(x) + "\" y=\"" + number_text(y) + "\" width=\"" + number_text(width - 2) + "\" height=\"" +
             number_text(height - 2) + "\" fill=\"" + heat(c.*score) + "\"" +
             (c.origin == GapOrigin::born && score == &GapCell::score ? " stroke=\"#000\" stroke-width=\"2\"" : "") + "/><text x=\"" +
             number_text(x + width / 2 - 1) + "\" y=\"" + number_text(y + 0.66 * height) + "\" text-anchor=\"middle\"" +
             (std::abs(c.*score) > 4.5 ? " style=\"fill:#fff\"" : "") + ">" + number + "</text>\n";
  }
  std::string labels;
  for (std::size_t i = 0; i < points.size(); ++i)
    labels += "<text x=\"" + number_text(left + width * (static_cast<double>(i) + 0.5) - 1) + "\" y=\"18\" text-anchor=\"middle\">" +
              escaped(points[i]) + "</text>\n";
  for (std::size_t i = 0; i < rows.size(); ++i)
    labels += "<text x=\"" + number_text(left - 8) + "\" y=\"" + number_text(top + height * (static_cast<double>(i) + 0.66)) +
              "\" text-anchor=\"end\">" + escaped(rows[i]) + "</text>\n";
  const double all_width = std::max(760.0, left + width * static_cast<double>(points.size()));
  return "<svg viewBox=\"0 0 " + number_text(all_width) + " " + number_text(top + height * static_cast<double>(rows.size()) + 4) +
         "\" role=\"img\">\n" + labels + cells + "</svg>\n";
}

std::string map_of_ways(const Verdict& v) {
  Ways ways = ways_of(v);
  auto& ranges = ways.ranges;
  const std::vector<std::string> axes = ways.axes();
  if (axes.size() < 2) return "";
  constexpr double width = 760, height = 330, left = 90, right = 40, top = 14, bottom = 44;
  const auto across = [&](double value) {
    return left + (width - left - right) * (value - ranges[axes[0]][0]) / std::max(ranges[axes[0]][1] - ranges[axes[0]][0], 1e-300);
  };
  const auto up = [&](double value) {
    return height - bottom -
           (height - top - bottom) * (value - ranges[axes[1]][0]) / std::max(ranges[axes[1]][1] - ranges[axes[1]][0], 1e-300);
  };
  std::string lines, dots;
  for (const auto& [point, way] : ways.of_point) {
    std::string line;
    for (const auto& [begin, place] : way) {
      if (!place.at.contains(axes[0]) || !place.at.contains(axes[1])) continue;
      const std::string x = number_text(across(place.at.at(axes[0]))), y = number_text(up(place.at.at(axes[1])));
      line += x + "," + y + " ";
      dots += "<circle cx=\"" + x + "\" cy=\"" + y + "\" r=\"8\" fill=\"" + heat(place.score) + "\" stroke=\"#596575\"/>";
      if (begin == way.rbegin()->first)
        dots += "<text x=\"" + number_text(across(place.at.at(axes[0])) + 12) + "\" y=\"" + y + "\">" + escaped(point) + "</text>\n";
    }
    lines += "<polyline points=\"" + line + "\" fill=\"none\" stroke=\"#a9b7c6\"/>\n";
  }
  const auto ends = [&](const std::string& axis, double low_x, double low_y, double high_x, double high_y, const char* anchor) {
    return "<text x=\"" + number_text(low_x) + "\" y=\"" + number_text(low_y) + "\" text-anchor=\"" + anchor + "\">" +
           html::number(ranges[axis][0]) + "</text><text x=\"" + number_text(high_x) + "\" y=\"" + number_text(high_y) +
           "\" text-anchor=\"" + anchor + "\">" + html::number(ranges[axis][1]) + "</text>\n";
  };
  return "<svg viewBox=\"0 0 " + number_text(width) + " " + number_text(height) + "\" role=\"img\" aria-label=\"Ways\">\n<rect x=\"" +
         number_text(left - 16) + "\" y=\"" + number_text(top - 12) + "\" width=\"" + number_text(width - left - right + 50) +
         "\" height=\"" + number_text(height - top - bottom + 24) + "\" fill=\"none\" stroke=\"#dde3ea\"/>\n" + lines + dots +
         arrows(v, axes, across, up) + ends(axes[0], left, height - 14, width - right, height - 14, "middle") +
         ends(axes[1], left - 22, height - bottom, left - 22, top + 8, "end") + "<text x=\"" + number_text(0.5 * (left + width - right)) +
         "\" y=\"" + number_text(height - 14) + "\" text-anchor=\"middle\">measured " + axes[0] + " [m]</text><text x=\"14\" y=\"" +
         number_text(0.5 * height) + "\" transform=\"rotate(-90 14 " + number_text(0.5 * height) + ")\" text-anchor=\"middle\">measured " +
         axes[1] +
         " [m]</text>\n</svg>\n<p>The measured paths in parts of time, in the same colours: the largest score of a coordinate there." +
         (v.missing_force.empty() ? ""
                                  : " Arrows: the missing force over mass, red of the base model, blue with " +
                                        (v.effects.empty() ? "the effects of the verdict" : escaped(effects_in_words(v))) +
                                        "; the longest red one is " + html::number(largest_of(v.missing_force, axes)) + " N/kg.") +
         "</p>\n";
}

}  // namespace snag
