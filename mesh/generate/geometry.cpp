#include "mesh/generate/geometry.hpp"

namespace snag::generate {

Registry<Geometry>& geometries() {
  static Registry<Geometry> all("geometry");
  return all;
}

}  // namespace snag::generate
