#pragma once
// Line plots as SVG inside the page: sharp in print, no other program needed.
#include <string>
#include <vector>

namespace snag {

struct PlotLine {
  std::string label;
  std::vector<double> x, y;
};

struct LinePlot {
  std::string title;
  std::string x_label, y_label;   // with units
  std::vector<PlotLine> lines;
};

/// True if the values are all positive (zeros aside) and span more than three decades: a linear axis would hide them.
bool needs_logarithm(const LinePlot& plot);

/// The plot as HTML (figure with svg and legend). Values that cannot be drawn (not finite; zero or less on a logarithmic axis) leave gaps
/// and are counted below it. Long lines are thinned to their extremes per pixel.
std::string figure(const LinePlot& plot);

}  // namespace snag
