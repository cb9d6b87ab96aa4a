#pragma once
// Drawings to scale as SVG: shapes of cloth, where a plot's free axes would lie about angles.
#include <string>
#include <vector>

namespace snag {

struct DrawingPoint {
  double x = 0, y = 0;  // m, y up
};

class Drawing {
 public:
  Drawing(DrawingPoint low, DrawingPoint high) : low_(low), high_(high) {}

  void line(const std::vector<DrawingPoint>& points, const std::string& colour, double width_px = 1.5, bool dashed = false);
  void circle(DrawingPoint centre, double radius, const std::string& stroke, const std::string& fill = "none", bool dashed = false);
  /// A filled polygon without an edge of its own.
  void area(const std::vector<DrawingPoint>& points, const std::string& fill);

  /// `<svg> ... </svg>`; complete as a file too.
  std::string svg() const;

 private:
  std::string at(DrawingPoint p) const;
  double scale() const;
  DrawingPoint low_, high_;
  std::string shapes_;
};

}  // namespace snag
