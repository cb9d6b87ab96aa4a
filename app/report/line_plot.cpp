#include "app/report/line_plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "app/report/html.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

// pixels of the drawing and of the frame inside it
constexpr double width = 480, height = 260, left = 64, right = 12, top = 18, bottom = 40;
constexpr std::size_t max_legend = 9;
// distinguishable also without colour vision (Okabe and Ito)
const char* const colours[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#7A5195"};
constexpr std::size_t n_colours = std::size(colours);

const char* const faint_colour = "#9aa7b4";

/// Faint lines take no colour from the others.
std::vector<std::string> colours_of(const LinePlot& plot) {
  std::vector<std::string> result;
  std::size_t n = 0;
  for (const PlotLine& line : plot.lines) result.emplace_back(line.faint ? faint_colour : colours[n++ % n_colours]);
  return result;
}

std::string printed(const char* format, double value) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

struct Axis {
  double begin = 0, end = 1;  // of the drawn quantity (its decimal logarithm on a logarithmic axis)
  bool logarithmic = false;
  int exponent = 0;  // the labels are in units of 10^exponent
  std::vector<double> ticks;

  double coordinate(double value) const { return logarithmic ? (value > 0 ? std::log10(value) : NAN) : value; }
  double part(double value) const { return (coordinate(value) - begin) / (end - begin); }
  std::string label(double tick) const {
    if (logarithmic) return "10<tspan dy=\"-5\" font-size=\"8\">" + printed("%.0f", tick) + "</tspan>";
    const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1;
    return printed("%.6g", std::abs(tick) < 1e-9 * step ? 0 : tick / std::pow(10, exponent));
  }
};

/// About `wanted` round numbers that cover the axis.
void set_ticks(Axis& axis, int wanted) {
  const double span = axis.end - axis.begin;
  double step = std::pow(10, std::floor(std::log10(span / wanted)));
  for (const double factor : {1.0, 2.0, 5.0, 10.0})
    if (span / (factor * step) <= wanted) {
      step *= factor;
      break;
    }
  if (axis.logarithmic) step = std::max(1.0, std::round(step));
  const double first = std::ceil(axis.begin / step - 1e-9);
  for (int i = 0; (first + i) * step <= axis.end + 1e-9 * span; ++i) axis.ticks.push_back((first + i) * step);
}

Axis axis_of(const LinePlot& plot, const std::vector<double> PlotLine::*values, bool logarithmic) {
  Axis axis;
  axis.logarithmic = logarithmic;
  double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
  for (const auto& line : plot.lines)
    for (const double value : line.*values) {
      const double at = axis.coordinate(value);
      if (std::isfinite(at)) low = std::min(low, at), high = std::max(high, at);
    }
  if (low > high) low = 0, high = 1;
  if (logarithmic) low = std::floor(low), high = std::ceil(high);
  // a constant gets a band around it, wide enough that round-off does not look like a signal
  const double smallest = logarithmic ? 1 : std::max(1e-6 * std::max(std::abs(low), std::abs(high)), std::numeric_limits<double>::min());
  if (high - low < smallest) {
    const double band = logarithmic ? 0.5 : low == 0 && high == 0 ? 1 : 0.05 * std::max(std::abs(low), std::abs(high));
    low -= band, high += band;
  }
  const double margin = logarithmic || values == &PlotLine::x ? 0 : 0.04 * (high - low);  // lines keep off the frame
  axis.begin = low - margin, axis.end = high + margin;
  const double size = std::max(std::abs(low), std::abs(high));
  if (!logarithmic && (size >= 1e5 || size < 1e-3)) axis.exponent = static_cast<int>(std::floor(std::log10(size) + 1e-9));
  return axis;
}

double pixel_x(const Axis& x, double value) { return left + (width - left - right) * x.part(value); }
double pixel_y(const Axis& y, double value) { return height - bottom - (height - top - bottom) * y.part(value); }

/// Indices to draw: of a long line the lowest and highest value of each stretch, in order; values that are not finite stay (they are gaps).
std::vector<std::size_t> drawn(const std::vector<double>& y) {
  constexpr std::size_t stretches = 400;
  std::vector<std::size_t> result;
  const std::size_t n = y.size(), length = std::max<std::size_t>(1, n / stretches);
  for (std::size_t begin = 0; begin < n; begin += length) {
    const std::size_t end = std::min(n, begin + length);
    std::size_t low = begin, high = begin, gap = n;
    for (std::size_t i = begin; i < end; ++i) {
      if (!std::isfinite(y[i])) gap = i;
      if (!(y[i] >= y[low])) low = i;
      if (!(y[i] <= y[high])) high = i;
    }
    std::vector<std::size_t> kept = {low, high};
    if (gap < n) kept.push_back(gap);
    std::sort(kept.begin(), kept.end());
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    result.insert(result.end(), kept.begin(), kept.end());
  }
  if (n > 0 && result.back() != n - 1) result.push_back(n - 1);
  return result;
}

/// A small ring at each point, as a part of the path.
std::string dots(const PlotLine& line, const Axis& x, const Axis& y) {
  std::string path;
  for (std::size_t i = 0; i < line.x.size(); ++i) {
    const double px = pixel_x(x, line.x[i]), py = pixel_y(y, line.y[i]);
    if (std::isfinite(px) && std::isfinite(py))
      path += "M" + printed("%.1f ", px - 2) + printed("%.1f", py) + "a2 2 0 1 0 4 0a2 2 0 1 0 -4 0";
  }
  return path;
}

std::string path_of(const PlotLine& line, const Axis& x, const Axis& y, const std::string& style) {
  std::string path;
  bool is_open = false;
  for (const std::size_t i : drawn(line.y)) {
    const double px = pixel_x(x, line.x[i]), py = pixel_y(y, line.y[i]);
    if (!std::isfinite(px) || !std::isfinite(py)) {
      is_open = false;
      continue;
    }
    path += (is_open ? "L" : "M") + printed("%.1f ", px) + printed("%.1f", py);
    is_open = true;
  }
  if (path.empty()) return "";
  if (line.dotted) path = dots(line, x, y) + path;
  return "<path d=\"" + path + (path.find('L') == std::string::npos ? "h0.1" : "") + "\" fill=\"none\" " + style + "/>\n";
}

std::string frame(const LinePlot& plot, const Axis& x, const Axis& y) {
  std::string svg;
  const std::string x_end = printed("%.1f", width - right), y_end = printed("%.1f", height - bottom);
  for (const double tick : x.ticks) {
    const auto at = printed("%.1f", left + (width - left - right) * (tick - x.begin) / (x.end - x.begin));
    svg += "<line x1=\"" + at + "\" x2=\"" + at + "\" y1=\"" + printed("%.0f", top) + "\" y2=\"" + y_end + "\" class=\"grid\"/>";
    svg +=
        "<text x=\"" + at + "\" y=\"" + printed("%.0f", height - bottom + 14) + "\" text-anchor=\"middle\">" + x.label(tick) + "</text>\n";
  }
  for (const double tick : y.ticks) {
    const double py = height - bottom - (height - top - bottom) * (tick - y.begin) / (y.end - y.begin);
    const auto at = printed("%.1f", py);
    svg += "<line x1=\"" + printed("%.0f", left) + "\" x2=\"" + x_end + "\" y1=\"" + at + "\" y2=\"" + at + "\" class=\"grid\"/>";
    svg += "<text x=\"" + printed("%.0f", left - 5) + "\" y=\"" + printed("%.1f", py + 3.5) + "\" text-anchor=\"end\">" + y.label(tick) +
           "</text>\n";
  }
  svg += "<rect x=\"" + printed("%.0f", left) + "\" y=\"" + printed("%.0f", top) + "\" width=\"" + printed("%.0f", width - left - right) +
         "\" height=\"" + printed("%.0f", height - top - bottom) + "\" fill=\"none\" stroke=\"#888\"/>\n";
  svg += "<text x=\"" + printed("%.0f", (left + width - right) / 2) + "\" y=\"" + printed("%.0f", height - 6) +
         "\" text-anchor=\"middle\">" + escaped(plot.x_label) + "</text>\n";
  if (y.exponent != 0)
    svg += "<text x=\"" + printed("%.0f", left) + "\" y=\"12\">× 10<tspan dy=\"-5\" font-size=\"8\">" + std::to_string(y.exponent) +
           "</tspan></text>\n";
  const auto middle = printed("%.0f", (top + height - bottom) / 2);
  svg += "<text transform=\"translate(12 " + middle + ") rotate(-90)\" text-anchor=\"middle\">" + escaped(plot.y_label) + "</text>\n";
  return svg;
}

std::string legend(const LinePlot& plot) {
  if (plot.lines.size() < 2 && (plot.lines.empty() || plot.lines[0].label.empty())) return "";
  const auto colour = colours_of(plot);
  std::string result = "<div class=\"legend\">";
  for (std::size_t i = 0; i < std::min(plot.lines.size(), max_legend); ++i)
    result += "<span><b style=\"color:" + colour[i] + "\">━</b> " + escaped(plot.lines[i].label) + "</span> ";
  if (plot.lines.size() > max_legend) result += "<span>and " + std::to_string(plot.lines.size() - max_legend) + " more</span>";
  return result + "</div>";
}

/// What a reader would otherwise not know is missing.
std::string gaps(const LinePlot& plot, const Axis& y) {
  std::size_t n_gaps = 0, n_low = 0;
  for (const auto& line : plot.lines)
    for (const double value : line.y) {
      if (!std::isfinite(value)) ++n_gaps;
      if (y.logarithmic && value <= 0) ++n_low;
    }
  std::string text;
  if (n_low > 0) text += html::count(static_cast<std::int64_t>(n_low)) + " values of zero or less have no place on the logarithmic axis. ";
  if (n_gaps > 0) text += html::count(static_cast<std::int64_t>(n_gaps)) + " values are not finite. ";
  return text.empty() ? "" : "<div class=\"note\">" + text + "</div>";
}

}  // namespace

double decades(const LinePlot& plot) {
  double low = std::numeric_limits<double>::max(), high = 0;
  for (const auto& line : plot.lines)
    for (const double value : line.y) {
      if (value < 0) return -1;
      if (std::isfinite(value) && value > 0) low = std::min(low, value), high = std::max(high, value);
    }
  return high > 0 ? std::log10(high / low) : -1;
}

std::string figure(const LinePlot& plot) {
  Axis x = axis_of(plot, &PlotLine::x, false), y = axis_of(plot, &PlotLine::y, plot.logarithmic);
  set_ticks(x, 6);
  set_ticks(y, 6);
  std::string svg = "<svg viewBox=\"0 0 " + printed("%.0f ", width) + printed("%.0f", height) + "\" role=\"img\" aria-label=\"" +
                    escaped(plot.title) + "\">\n" + frame(plot, x, y);
  const auto colour = colours_of(plot);
  for (const bool faint : {true, false})
    for (std::size_t i = 0; i < plot.lines.size(); ++i)
      if (plot.lines[i].faint == faint)
        svg += path_of(plot.lines[i], x, y,
                       "stroke=\"" + colour[i] + "\" stroke-width=\"" + (faint ? "0.7" : "1.4") +
                           "\" stroke-linecap=\"round\" stroke-linejoin=\"round\"");
  return "<figure class=\"plot\"><figcaption>" + escaped(plot.title) + "</figcaption>\n" + svg + "</svg>" + legend(plot) + gaps(plot, y) +
         "</figure>\n";
}

}  // namespace snag
