// Inlet with a given velocity:   u = s U,  or  u = - s U_n n  with n the normal out of the domain;   flux = u.S
// s: profile over the patch with mean 1 (solver/boundaries/inlet_profile.hpp), times a factor of time (solver/boundaries/time_course.hpp)
// du/dt is the acceleration for the pressure at the inlet.
#include <optional>

#include "base/choice.hpp"
#include "base/error.hpp"
#include "parallel/sum.hpp"
#include "solver/boundaries/boundary.hpp"
#include "solver/boundaries/inlet_profile.hpp"
#include "solver/boundaries/time_course.hpp"

namespace snag {
namespace {

struct VelocityInlet final : Boundary {
  static constexpr const char* name = "velocity_inlet";
  Vec3 velocity;
  std::optional<double> normal_speed;
  Choice<Profile> profile{Profile::uniform, {"uniform", "laminar", "turbulent"}};
  TimeCourse course;
  std::vector<double> shape;  // s of each face
  bool draws_out = false;

  Section section() override {
    Section section{
        .name = name,
        .meaning = "Velocity, uniform or with the profile of a developed flow.",
        .parameters = {
            {"velocity", &velocity, "m/s", -infinity, infinity, Basis::assumed, "Velocity of the fluid."},
            {"normal_speed", &normal_speed, "m/s", -infinity, infinity, Basis::assumed,
             "Speed into the domain along the normal, instead of velocity."},
            setting("profile", &profile,
                    "Profile of the speed over the patch; laminar and turbulent: slower near a wall, and velocity is the mean.")}};
    course.add_keys(section, "velocity");
    return section;
  }
  std::vector<double> knots() const override { return course.knots(); }
  PrescribedQuantity fixes() const override { return PrescribedQuantity::velocity; }
  bool leads_out() const override { return draws_out; }
  void prepare(const Mesh& mesh, const Patch& patch, const std::vector<PatchBoundary>& all) override {
    course.check("[[boundary]] \"" + patch.name + "\"");
    if (normal_speed && norm(velocity) > 0)
      throw Error(ExitCode::usage, "[[boundary]] \"" + patch.name + "\": velocity and normal_speed are both given; give one of them");
    std::vector<Patch> walls;
    for (std::size_t p = 0; p < all.size(); ++p)
      if (all[p].boundary->is_wall()) walls.push_back(mesh.patches[p]);
    shape = inlet_profile(mesh, patch, walls, profile);
    const std::vector<Vec3> S(mesh.face_vector.begin() + patch.first, mesh.face_vector.begin() + patch.end());
    draws_out = normal_speed ? *normal_speed < 0 : dot(velocity, sum(mesh.comm, std::span<const Vec3>(S))) > 0;
  }
  void update(const Flow& flow, const Patch& patch, double time, BoundaryValues& values) const override {
    const double factor = course.at(time), rate = course.rate(flow.time, time);
    for (int f = patch.first; f < patch.end(); ++f) {
      const int b = f - flow.mesh.n_interior;
      const Vec3& S = flow.mesh.face_vector[f];
      const Vec3 whole = shape[f - patch.first] * (normal_speed ? -*normal_speed * unit(S) : velocity);
      values.velocity[b] = factor * whole;
      values.flux[b] = dot(values.velocity[b], S);
      values.acceleration[b] = rate * whole;
    }
  }
};
const bool registered = boundaries().add<VelocityInlet>();

}  // namespace
}  // namespace snag
