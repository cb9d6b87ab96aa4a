#pragma once
// Line plots as SVG inside the page: sharp in print, no other program needed.
#include <string>
#include <vector>

#include "base/parameter.hpp"

namespace snag {

struct PlotLine {
  std::string label;
  std::vector<double> x, y;
  bool faint = false;      // thin and grey, behind the others
  bool dotted = false;     // a dot at each point
  bool scattered = false;  // dots alone, in any order
  bool continues = false;  // the line before after a gap: its colour, no entry in the legend
};

/// What lies between two curves, in the colour of the first line and fainter from band to band.
struct PlotBand {
  std::string label;
  std::vector<double> x, low, high;
};

/// A dashed line across the whole plot: upright at an x with a letter, which the legend explains if there is a label, or level at a y with
/// its label on it.
struct PlotMark {
  double at = 0;
  std::string label;
  bool level = false;
};

/// A stretch of x, shaded from top to bottom; its label stands in the legend.
struct PlotSpan {
  double begin = 0, end = 0;
  std::string label;
};

struct LinePlot {
  std::string title;
  std::string x_label, y_label;  // with units
  std::vector<PlotLine> lines;
  bool logarithmic = false;  // of y
  std::vector<PlotBand> bands = {};
  std::vector<PlotMark> marks = {};
  std::vector<PlotSpan> spans = {};
  double scale_from = -infinity;  // the axis of y spans the values from this x on; lines are cut where they leave it, and the page says so
  std::vector<double> x_ticks = {};  // rising; they span the axis; empty: round numbers that suit the values
};

/// `x_ticks` of a full turn, deg.
inline const std::vector<double> angle_ticks = {0, 60, 120, 180, 240, 300, 360};

/// Letter of the i-th upright mark.
std::string mark_letter(std::size_t i);

/// Decades between the smallest and the largest positive value; negative if a value is below zero or none is above.
double decades(const LinePlot& plot);

/// The plot as HTML (figure with svg and legend). Values that cannot be drawn (not finite; zero or less on a logarithmic axis) leave gaps
/// and are counted below it. Long lines are thinned to their extremes per pixel.
std::string figure(const LinePlot& plot);

}  // namespace snag
