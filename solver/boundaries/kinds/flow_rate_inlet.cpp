// Inlet with a given volume flow Q over the patch, uniform along its mean normal:
//
//   u = - (Q / |sum S|) sum S / |sum S|,   sum of u.S = - Q exactly;      Q may rise in time (solver/boundaries/time_course.hpp)
//
// du/dt is the acceleration for the pressure at the inlet.
#include "base/error.hpp"
#include "parallel/sum.hpp"
#include "solver/boundaries/boundary.hpp"
#include "solver/boundaries/time_course.hpp"

namespace snag {
namespace {

struct FlowRateInlet final : Boundary {
  static constexpr const char* name = "flow_rate_inlet";
  double flow_rate = 0;
  TimeCourse course;
  Vec3 area;  // sum S of the patch, m2

  Section section() override {
    Section section{
        .name = name,
        .meaning = "Uniform velocity along the mean normal of a plane patch that gives a volume flow; negative draws fluid out.",
        .parameters = {{.key = "flow_rate",
                        .target = &flow_rate,
                        .unit = "m3/s",
                        .meaning = "Volume flow into the domain, over the whole patch.",
                        .required = true}}};
    course.add_keys(section, "flow rate");
    return section;
  }
  std::vector<double> knots() const override { return course.knots(); }
  PrescribedQuantity fixes() const override { return PrescribedQuantity::velocity; }
  bool leads_out() const override { return flow_rate < 0; }
  void prepare(const Mesh& mesh, const Patch& patch, const std::vector<PatchBoundary>&) override {
    course.check("[[boundary]] \"" + patch.name + "\"");
    std::vector<Vec3> S(mesh.face_vector.begin() + patch.first, mesh.face_vector.begin() + patch.end());
    std::vector<double> size;
    for (const Vec3& s : S) size.push_back(norm(s));
    area = sum(mesh.comm, std::span<const Vec3>(S));
    if (norm(area) <= 1e-6 * sum(mesh.comm, std::span<const double>(size)))
      throw Error(ExitCode::usage,
                  "[[boundary]] \"" + patch.name + "\": a closed or empty surface has no mean normal; give the inlet a patch of its own");
  }
  void update(const Flow& flow, const Patch& patch, double time, BoundaryValues& values) const override {
    const Vec3 whole = -flow_rate / norm_squared(area) * area;
    const Vec3 velocity = course.at(time) * whole, acceleration = course.rate(flow.time, time) * whole;
    for (int f = patch.first; f < patch.end(); ++f) {
      const int b = f - flow.mesh.n_interior;
      values.velocity[b] = velocity;
      values.flux[b] = dot(velocity, flow.mesh.face_vector[f]);
      values.acceleration[b] = acceleration;
    }
  }
};
const bool registered = boundaries().add<FlowRateInlet>();

}  // namespace
}  // namespace snag
