#include "report/line_plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "base/parameter.hpp"
#include "base/words.hpp"
#include "report/html.hpp"

namespace snag {

namespace {

// pixels of the drawing and of the frame inside it
constexpr double width = 480, height = 260, left = 64, right = 12, top = 18, bottom = 40;
constexpr std::size_t max_legend = 9;
// distinguishable also without colour vision (Okabe and Ito)
const char* const colours[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#7A5195"};
constexpr std::size_t n_colours = std::size(colours);

const char* const faint_colour = "#9aa7b4";
const char* const mark_colour = "#5b6673";
const char* const span_colours[] = {"#f6ead0", "#dfeee6"};  // pale: lines and grid stay legible on them

/// Of the k-th band.
std::string opacity(std::size_t k) {
  constexpr const char* steps[] = {"0.45", "0.25", "0.12"};
  return steps[std::min(k, std::size(steps) - 1)];
}

/// Faint lines take no colour from the others.
std::vector<std::string> colours_of(const LinePlot& plot) {
  std::vector<std::string> result;
  std::size_t n = 0;
  for (const PlotLine& line : plot.lines) {
    if (line.continues && !result.empty())
      result.push_back(result.back());
    else
      result.emplace_back(line.faint ? faint_colour : colours[n++ % n_colours]);
  }
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

/// Axis that holds all values; `is_x`: they may reach the frame.
Axis axis_of(const std::vector<const std::vector<double>*>& values, bool is_x, bool logarithmic) {
  Axis axis;
  axis.logarithmic = logarithmic;
  double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
  for (const auto* list : values)
    for (const double value : *list) {
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
  const double margin = logarithmic || is_x ? 0 : 0.04 * (high - low);  // lines keep off the frame
  axis.begin = low - margin, axis.end = high + margin;
  const double size = std::max(std::abs(low), std::abs(high));
  if (!logarithmic && (size >= 1e5 || size < 1e-3)) axis.exponent = static_cast<int>(std::floor(std::log10(size) + 1e-9));
  return axis;
}

Axis x_axis(const LinePlot& plot) {
  std::vector<const std::vector<double>*> values;
  for (const PlotLine& line : plot.lines) values.push_back(&line.x);
  for (const PlotBand& band : plot.bands) values.push_back(&band.x);
  if (!plot.x_ticks.empty()) values.assign(1, &plot.x_ticks);
  Axis axis = axis_of(values, true, false);
  if (plot.x_ticks.empty())
    set_ticks(axis, 6);
  else
    axis.ticks = plot.x_ticks;
  return axis;
}

/// The values of a line that the axis of y spans.
std::vector<double> scaled_values(const PlotLine& line, double from) {
  std::vector<double> values;
  for (std::size_t i = 0; i < line.x.size(); ++i)
    if (line.x[i] >= from) values.push_back(line.y[i]);
  return values;
}

Axis y_axis(const LinePlot& plot) {
  std::vector<std::vector<double>> lines;
  for (const PlotLine& line : plot.lines) lines.push_back(scaled_values(line, plot.scale_from));
  if (std::all_of(lines.begin(), lines.end(), [](const auto& line) { return line.empty(); }))
    for (std::size_t i = 0; i < lines.size(); ++i) lines[i] = plot.lines[i].y;
  std::vector<const std::vector<double>*> values;
  for (const auto& line : lines) values.push_back(&line);
  for (const PlotBand& band : plot.bands) values.insert(values.end(), {&band.low, &band.high});
  std::vector<double> levels;
  for (const PlotMark& mark : plot.marks)
    if (mark.level) levels.push_back(mark.at);
  values.push_back(&levels);
  Axis axis = axis_of(values, false, plot.logarithmic);
  set_ticks(axis, 6);
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
  if (line.scattered) {
    const std::string points = dots(line, x, y);
    return points.empty() ? "" : "<path d=\"" + points + "\" fill=\"none\" " + style + "/>\n";
  }
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

std::string spans_of(const LinePlot& plot, const Axis& x) {
  std::string svg;
  for (std::size_t k = 0; k < plot.spans.size(); ++k) {
    const double begin = std::max(0.0, x.part(plot.spans[k].begin)), end = std::min(1.0, x.part(plot.spans[k].end));
    if (!(begin < end)) continue;
    svg += "<rect x=\"" + printed("%.1f", left + (width - left - right) * begin) + "\" y=\"" + printed("%.0f", top) + "\" width=\"" +
           printed("%.1f", (width - left - right) * (end - begin)) + "\" height=\"" + printed("%.0f", height - top - bottom) +
           "\" fill=\"" + span_colours[k % std::size(span_colours)] + "\"/>\n";
  }
  return svg;
}

/// Begins a group that is cut at the frame.
std::string cut_at_frame() {
  return "<clipPath id=\"frame\"><rect x=\"" + printed("%.0f", left) + "\" y=\"" + printed("%.0f", top) + "\" width=\"" +
         printed("%.0f", width - left - right) + "\" height=\"" + printed("%.0f", height - top - bottom) +
         "\"/></clipPath><g clip-path=\"url(#frame)\">\n";
}

/// The k-th band; what has no place on the axis reaches down to its end. Long bands are thinned to their outermost values.
std::string band_of(const PlotBand& band, const Axis& x, const Axis& y, std::size_t k) {
  constexpr std::size_t stretches = 400;
  const std::size_t n = band.x.size(), length = std::max<std::size_t>(1, n / stretches);
  const auto level = [&](double value) {
    const double at = y.part(value);
    return height - bottom - (height - top - bottom) * (std::isfinite(at) ? at : 0);
  };
  std::string there, back;
  for (std::size_t begin = 0; begin < n; begin += length) {
    const std::size_t end = std::min(n, begin + length);
    const double low = *std::min_element(band.low.begin() + begin, band.low.begin() + end),
                 high = *std::max_element(band.high.begin() + begin, band.high.begin() + end);
    const std::string px = printed("%.1f ", pixel_x(x, band.x[begin]));
    there += (begin == 0 ? "M" : "L") + px + printed("%.1f", level(high));
    back.insert(0, "L" + px + printed("%.1f", level(low)));
  }
  return n == 0 ? "" : "<path d=\"" + there + back + "Z\" fill=\"" + colours[0] + "\" fill-opacity=\"" + opacity(k) + "\"/>\n";
}

/// Upright marks carry letters in their order, level ones their label.
std::string marks_of(const LinePlot& plot, const Axis& x, const Axis& y) {
  std::string svg;
  std::size_t n = 0;
  const auto line = [&](double x1, double y1, double x2, double y2) {
    svg += "<line x1=\"" + printed("%.1f", x1) + "\" y1=\"" + printed("%.1f", y1) + "\" x2=\"" + printed("%.1f", x2) + "\" y2=\"" +
           printed("%.1f", y2) + "\" stroke=\"" + mark_colour + "\" stroke-dasharray=\"4 3\"/>";
  };
  double last = -infinity, last_level = -infinity;  // places of the letter and of the level before, pixels
  for (const PlotMark& mark : plot.marks) {
    if (mark.level) {
      const double at = pixel_y(y, mark.at);
      line(left, at, width - right, at);
      const bool is_crowded = std::abs(at - last_level) < 12;  // its label would cover the one before
      svg += "<text x=\"" + printed("%.0f", is_crowded ? left + 4 : width - right - 4) + "\" y=\"" + printed("%.1f", at - 4) +
             "\" text-anchor=\"" + (is_crowded ? "start" : "end") + "\" stroke=\"#fff\" stroke-width=\"3\" paint-order=\"stroke\">" +
             escaped(mark.label) + "</text>\n";
      last_level = is_crowded ? -infinity : at;
      continue;
    }
    const std::string name = mark_letter(n++);
    const double part = x.part(mark.at), at = pixel_x(x, mark.at);
    if (!(part >= 0 && part <= 1)) continue;
    line(at, top, at, height - bottom);
    last = std::max(at, last + 8);  // letters of events close together stand side by side
    svg += "<text x=\"" + printed("%.1f", last) + "\" y=\"" + printed("%.0f", top - 4) + "\" text-anchor=\"middle\">" + name + "</text>\n";
  }
  return svg;
}

std::string legend(const LinePlot& plot) {
  const auto colour = colours_of(plot);
  std::vector<std::string> entries;
  const auto swatch = [](const std::string& style, const std::string& sign) { return "<b style=\"" + style + "\">" + sign + "</b> "; };
  const bool is_alone = plot.lines.size() == 1 && plot.lines[0].label.empty();
  for (std::size_t i = 0; i < plot.lines.size() && !is_alone; ++i)
    if (!plot.lines[i].continues) entries.push_back(swatch("color:" + colour[i], "━") + escaped(plot.lines[i].label));
  const std::size_t n_lines = entries.size();
  if (n_lines > max_legend) {
    entries.resize(max_legend);
    entries.push_back("and " + std::to_string(n_lines - max_legend) + " more");
  }
  for (std::size_t k = 0; k < plot.bands.size(); ++k)
    entries.push_back(swatch(std::string("color:") + colours[0] + ";opacity:" + opacity(k), "█") + escaped(plot.bands[k].label));
  for (std::size_t k = 0; k < plot.spans.size(); ++k)
    entries.push_back(swatch(std::string("color:") + span_colours[k % std::size(span_colours)], "█") + escaped(plot.spans[k].label));
  std::size_t n = 0;
  for (const PlotMark& mark : plot.marks) {
    if (mark.level) continue;
    const std::string name = mark_letter(n++);
    if (!mark.label.empty()) entries.push_back("<b>" + name + "</b> " + escaped(mark.label));
  }
  if (entries.empty()) return "";
  std::string result = "<div class=\"legend\">";
  for (const auto& entry : entries) result += "<span>" + entry + "</span> ";
  return result + "</div>";
}

/// The values that lie beyond the axis of y, and between which bounds.
std::string outside(const LinePlot& plot, const Axis& y) {
  std::int64_t n = 0;
  double low = infinity, high = -infinity, last = -infinity;
  for (const auto& line : plot.lines)
    for (std::size_t i = 0; i < line.y.size(); ++i)
      if (const double part = y.part(line.y[i]); part < -1e-9 || part > 1 + 1e-9)
        ++n, low = std::min(low, line.y[i]), high = std::max(high, line.y[i]), last = std::max(last, line.x[i]);
  if (n == 0) return "";
  return "The axis spans the values after the start-up; " + html::count(n) + " values up to " + html::number(last) +
         " s lie outside it, between " + html::number(low) + " and " + html::number(high) + ". ";
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
  text += outside(plot, y);
  if (n_low > 0) text += html::count(static_cast<std::int64_t>(n_low)) + " non-positive values are omitted from the logarithmic axis. ";
  if (n_gaps > 0) text += html::count(static_cast<std::int64_t>(n_gaps)) + " values are not finite. ";
  return text.empty() ? "" : "<div class=\"note\">" + text + "</div>";
}

}  // namespace

std::string mark_letter(std::size_t i) { return std::string(1, static_cast<char>('a' + i % 26)); }

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
  const Axis x = x_axis(plot), y = y_axis(plot);
  const auto colour = colours_of(plot);
  std::string svg = "<svg viewBox=\"0 0 " + printed("%.0f ", width) + printed("%.0f", height) + "\" role=\"img\" aria-label=\"" +
                    escaped(plot.title) + "\">\n" + spans_of(plot, x) + frame(plot, x, y);
  const bool is_cut = plot.scale_from > -infinity;
  if (is_cut) svg += cut_at_frame();
  for (std::size_t k = plot.bands.size(); k-- > 0;) svg += band_of(plot.bands[k], x, y, k);
  for (const bool faint : {true, false})
    for (std::size_t i = 0; i < plot.lines.size(); ++i)
      if (plot.lines[i].faint == faint)
        svg += path_of(plot.lines[i], x, y,
                       "stroke=\"" + colour[i] + "\" stroke-width=\"" + (faint ? "0.7" : "1.4") +
                           "\" stroke-linecap=\"round\" stroke-linejoin=\"round\"");
  if (is_cut) svg += "</g>\n";
  svg += marks_of(plot, x, y);
  return "<figure class=\"plot\"><figcaption>" + escaped(plot.title) + "</figcaption>\n" + svg + "</svg>" + legend(plot) + gaps(plot, y) +
         "</figure>\n";
}

}  // namespace snag
