#pragma once
// Pieces of the drawings of a cloth in its tests: the strip over the edge, the drape from above.
#include "observe/outline.hpp"
#include "report/drawing.hpp"
#include "textile/cantilever.hpp"
#include "textile/textile_tests.hpp"

namespace snag {

/// A picture as SVG and the name of its file.
struct NamedDrawing {
  std::string file, caption, svg;
};

std::string figure_of(const NamedDrawing& drawing);
/// Colour of the k-th line of a drawing.
std::string line_colour(std::size_t k);
/// "34.1 mm"; "+1.2 %".
std::string millimetres(double length);
std::string percent(double ratio);

/// The edge and the plane; the strip's axis lies `radius` above the edge.
Drawing over_the_edge(const TextileTests& tests, int direction, double radius);
void add_strip(const TextileTests& tests, int direction, const StripShape& shape, const std::string& colour, Drawing& drawing);

Drawing from_above(const TextileTests& tests);
/// The table and the mean measured wave size.
void add_circles(const TextileTests& tests, Drawing& drawing);
void add_outline(const Outline& outline, const std::string& colour, Drawing& drawing);

}  // namespace snag
