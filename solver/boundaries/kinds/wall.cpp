// Wall:   at rest   u = 0,   or turning with the turning zone   u = omega x (x - x_0)
//
// A face of a cell that turns (solver/fields/rotating_zone.hpp) turns with it, unless the case keeps the wall at rest: a casing wall that
// is a surface of revolution about the axis. In either case the flux is the volume that the mesh face sweeps.
#include "solver/boundaries/turning_wall.hpp"

namespace snag {
namespace {

struct Wall final : Boundary {
  static constexpr const char* name = "wall";
  bool stationary = false;
  double roughness_height = 0;  // m

  Section section() override {
    return {
        .name = name,
        .meaning = "No slip on a wall at rest, or turning with the turning zone where it is part of that.",
        .parameters = {renamed(setting("stationary", &stationary,
                                       "The wall stays at rest although its cells turn: a casing wall that is a surface of revolution."),
                               {.key = "fixed"}),
                       roughness_parameter(&roughness_height)}};
  }
  PrescribedQuantity fixes() const override { return PrescribedQuantity::velocity; }
  bool is_wall() const override { return true; }
  double roughness() const override { return roughness_height; }
  void update(const Flow& flow, const Patch& patch, double time, BoundaryValues& values) const override {
    set_wall_of_zone(stationary, flow, patch, time, values);
  }
};
const bool registered = boundaries().add<Wall>();

}  // namespace
}  // namespace snag
