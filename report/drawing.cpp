#include "report/drawing.hpp"

#include <cstdio>

namespace snag {

namespace {

constexpr double width_px = 420;

std::string printed(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

}  // namespace

double Drawing::scale() const { return width_px / (high_.x - low_.x); }

std::string Drawing::at(DrawingPoint p) const { return printed((p.x - low_.x) * scale()) + " " + printed((high_.y - p.y) * scale()); }

void Drawing::line(const std::vector<DrawingPoint>& points, const std::string& colour, double line_px, bool dashed) {
  std::string path;
  for (const DrawingPoint& p : points) path += (path.empty() ? "M" : "L") + at(p);
  shapes_ += "<path d=\"" + path + "\" fill=\"none\" stroke=\"" + colour + "\" stroke-width=\"" + printed(line_px) + "\"" +
             (dashed ? " stroke-dasharray=\"5 4\"" : "") + "/>\n";
}

void Drawing::circle(DrawingPoint centre, double radius, const std::string& stroke, const std::string& fill, bool dashed) {
  shapes_ += "<circle cx=\"" + printed((centre.x - low_.x) * scale()) + "\" cy=\"" + printed((high_.y - centre.y) * scale()) + "\" r=\"" +
             printed(radius * scale()) + "\" fill=\"" + fill + "\" stroke=\"" + stroke + "\"" +
             (dashed ? " stroke-dasharray=\"5 4\"" : "") + "/>\n";
}

void Drawing::area(const std::vector<DrawingPoint>& points, const std::string& fill) {
  std::string path;
  for (const DrawingPoint& p : points) path += (path.empty() ? "M" : "L") + at(p);
  // An edge of the same colour closes the hairlines between neighbours.
  shapes_ += "<path d=\"" + path + "z\" fill=\"" + fill + "\" stroke=\"" + fill + "\" stroke-width=\"0.5\"/>\n";
}

std::string Drawing::svg() const {
  const std::string height = printed((high_.y - low_.y) * scale());
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + printed(width_px) + " " + height + "\">\n" + shapes_ + "</svg>\n";
}

}  // namespace snag
