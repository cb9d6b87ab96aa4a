#include "coupling/kernel_shape.hpp"

namespace snag {

Registry<KernelShape>& kernel_shapes() {
  static Registry<KernelShape> registry("kernel");
  return registry;
}

}  // namespace snag
