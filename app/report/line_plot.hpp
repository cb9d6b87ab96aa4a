#pragma once
// Line plots as SVG inside the page: sharp in print, no other program needed.
#include <string>
#include <vector>

namespace snag {

struct PlotLine {
  std::string label;
  std::vector<double> x, y;
  bool faint = false;   // thin and grey, behind the others
  bool dotted = false;  // a dot at each point
};

struct LinePlot {
  std::string title;
  std::string x_label, y_label;  // with units
  std::vector<PlotLine> lines;
  bool logarithmic = false;  // of y
};

/// Decades between the smallest and the largest positive value; negative if a value is below zero or none is above.
double decades(const LinePlot& plot);

/// The plot as HTML (figure with svg and legend). Values that cannot be drawn (not finite; zero or less on a logarithmic axis) leave gaps
/// and are counted below it. Long lines are thinned to their extremes per pixel.
std::string figure(const LinePlot& plot);

}  // namespace snag
