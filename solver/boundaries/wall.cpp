// Wall at rest, or fixed to a turning mesh:   u = u_wall,   flux = the volume that the face itself sweeps
#include "solver/boundary.hpp"

namespace snag {
namespace {

struct Wall final : Boundary {
  static constexpr const char* name = "wall";

  Section section() override { return {.name = name, .meaning = "No slip on a wall at rest.", .parameters = {}}; }
  Fixes fixes() const override { return Fixes::velocity; }
  bool is_wall() const override { return true; }
  void update(const Flow& flow, const Patch& patch, double, BoundaryValues& values) const override {
    for (int f = patch.first; f < patch.end(); ++f) {
      const int b = f - flow.mesh.n_interior;
      values.velocity[b] = {};
      values.flux[b] = flow.mesh_flux[f];
    }
  }
};
const bool registered = boundaries().add<Wall>();

}  // namespace
}  // namespace snag
