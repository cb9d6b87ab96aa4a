#include "report/volute_page.hpp"

#include <cmath>

#include "base/words.hpp"
#include "report/html.hpp"
#include "report/line_plot.hpp"
#include "report/page.hpp"

namespace snag {

namespace {

constexpr double bin_width = 360.0 / n_volute_bins;  // degrees

LinePlot plot_over_angle(const std::string& title, const std::string& y_label) {
  LinePlot plot{title, "angle of the rag's centroid, 0 at the tongue [deg]", y_label, {}};
  plot.x_ticks = {0, 60, 120, 180, 240, 300, 360};
  return plot;
}

/// The outline of bars, from zero: the share holds from the begin of a bin to its end.
LinePlot share_plot(const std::vector<NamedVolute>& volutes) {
  LinePlot plot = plot_over_angle("Where rags stay", "share of time [%]");
  for (const auto& [name, histogram] : volutes) {
    PlotLine line{name, {0}, {0}};
    for (int bin = 0; bin < n_volute_bins; ++bin)
      for (const int end : {bin, bin + 1}) line.x.push_back(end * bin_width), line.y.push_back(100 * histogram.share(bin));
    line.x.push_back(n_volute_bins * bin_width), line.y.push_back(0);
    plot.lines.push_back(line);
  }
  return plot;
}

LinePlot radius_plot(const std::vector<NamedVolute>& volutes) {
  LinePlot plot = plot_over_angle("Distance from the shaft", "mean distance [mm]");
  for (const auto& [name, histogram] : volutes) {
    PlotLine line{name, {}, {}};
    line.dotted = true;
    for (int bin = 0; bin < n_volute_bins; ++bin) {
      if (!(histogram.time(bin) > 0)) continue;
      line.x.push_back((bin + 0.5) * bin_width), line.y.push_back(1e3 * histogram.radius(bin));
    }
    plot.lines.push_back(line);
  }
  return plot;
}

std::string table_of_events(const std::vector<NamedVolute>& volutes) {
  std::vector<std::string> header{"Events a rag", "rags", "time [s]"};
  for (const PassageEvent event : VoluteHistogram::events) header.emplace_back(words_of(event).key);
  std::vector<std::vector<std::string>> rows;
  for (const auto& [name, histogram] : volutes) {
    rows.push_back({escaped(name), html::count(histogram.n_rags()), html::number(histogram.time())});
    for (const PassageEvent event : VoluteHistogram::events) {
      int n = 0;
      for (int bin = 0; bin < n_volute_bins; ++bin) n += histogram.n_events(event, bin);
      rows.back().push_back(html::number(static_cast<double>(n) / histogram.n_rags()));
    }
  }
  return html::table(header, rows);
}

}  // namespace

std::string volute_page(const std::vector<NamedVolute>& volutes) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>Snag: rags in the volute</title>\n<style>" +
         std::string(report_style) + "td:first-child { width: auto; }</style>\n</head>\n<body>\n<h1>Rags in the volute</h1>\n" +
         "<p>By the angle of the centroid about the shaft, counter-clockwise seen from the inlet, from wholly in the casing until past the "
         "tongue.</p>\n" +
         section("Stay", "<div class=\"plots\">\n" + figure(share_plot(volutes)) + figure(radius_plot(volutes)) + "</div>\n") +
         section("Events", table_of_events(volutes)) + "</body>\n</html>\n";
}

}  // namespace snag
