#include "coupling/kernel_shape.hpp"

#include <cmath>

namespace snag {

Registry<KernelShape>& kernel_shapes() {
  static Registry<KernelShape> registry("kernel");
  return registry;
}

double KernelShape::disturbance_width(double width, double side) const { return std::hypot(overlap_width(width), width_of_cell(side)); }

}  // namespace snag
