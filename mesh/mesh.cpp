#include "mesh/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"

namespace snag {

double TurningPose::distance(const Vec3& x) const {
  const double z = dot(x - origin, axis), r = norm(x - origin - z * axis);
  const InterfacePart* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity(), side = 0;
  for (const InterfacePart& part : parts) {
    const double across = part.sign * ((part.is_disc ? z : r) - part.level), along = part.is_disc ? r : z;
    const double distance = std::hypot(across, std::max({part.lower - along, along - part.upper, 0.0}));
    constexpr double round_off = 1e-9;
    if (nearest && nearest->is_disc != part.is_disc && std::abs(distance - least) <= round_off * least) {
      // A rim is nearest. Where the other part leads to the inner side of this one, the zone lies inside of both.
      const double end = std::abs(nearest->lower - part.level) > std::abs(nearest->upper - part.level) ? nearest->lower : nearest->upper;
      side = part.sign * (end - part.level) < 0 ? std::max(side, across) : std::min(side, across);
    } else if (distance < least) {
      nearest = &part, least = distance, side = across;
    }
  }
  return std::copysign(least, side);
}

int Mesh::patch_index(const std::string& name) const {
  std::string known;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (patches[i].name == name) return static_cast<int>(i);
    known.append(known.empty() ? "" : ", ").append(patches[i].name);
  }
  throw Error(ExitCode::mesh, "patch \"" + name + "\" is not in the mesh; its patches are " + (known.empty() ? "none" : known));
}

}  // namespace snag
