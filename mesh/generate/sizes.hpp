#pragma once
// Sizes of tetrahedra as a function of the distance d from faces:  h(d) = near for d <= from, linear to far at d = to.
// The mesh takes the minimum over all faces; beyond `to` a face asks for nothing unless it is the background.
#include <string>
#include <vector>

namespace snag::generate {

struct Growth {
  double near = 0, far = 0;  // m, edge length at the faces and away from them
  double from = 0, to = 0;   // m, distances
};

class SizeField {
 public:
  /// Sizes about faces. `background`: `far` holds at any larger distance.
  void around(const std::vector<int>& faces, const Growth& growth, bool background = false);
  /// A size as a formula in x, y, z (m).
  void formula(const std::string& expression);
  /// Make the minimum of all the only source of sizes; curvature, points and boundaries are ignored.
  void apply() const;

 private:
  std::vector<double> fields_;
};

}  // namespace snag::generate
