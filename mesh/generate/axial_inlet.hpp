#pragma once
// The axial inlet of a radial machine: hexahedra between front casing and hub, revolved from the inner cylinder of a swept ring to a pipe.
#include <string>
#include <vector>

#include "mesh/generate/swept.hpp"

namespace snag::generate {

// Lengths in m. The front casing lies at z = 0 and the hub at z = span; the pipe comes from negative z.
//   front casing  plane, quarter circle from (r ring_radius, z 0) to (pipe_radius, -casing_fillet), pipe
//   hub           plane, quarter circle from (r hub_radius, z span) to (rod_radius, span - hub_fillet), rod in place of a nose
struct AxialInlet {
  double ring_radius, span, casing_fillet, hub_fillet, hub_radius, length;  // length: from the front casing to the inlet

  struct Column {
    double casing_radius, casing_z, hub_radius, hub_z;
  };
  double pipe_radius() const { return ring_radius - casing_fillet; }
  double rod_radius() const { return hub_radius - hub_fillet; }
  double hub_end() const { return span - hub_fillet; }  // z where the rod begins
  /// Straight lines from casing to hub, from the ring to the inlet, about `size` apart.
  std::vector<Column> columns(double size) const;
  double volume() const;
  /// Cells and patches hub, rod, casing, inlet; `circle`: edges of the ring's inner circle, counter-clockwise; levels in m.
  void add_to(SweptMesh& mesh, const std::string& volume, const std::vector<EdgeNodes>& circle, const std::vector<double>& levels,
              double size) const;
};

}  // namespace snag::generate
