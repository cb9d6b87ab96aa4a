// Inlet with a given pressure:
//
//   total:    p = p_0 - 1/2 rho u_n^2,   u_n = flux/|S| where fluid enters;  p = p_0 where it leaves
//   static:   p = p_0
//
// du/dn = 0; the fluid enters along the normal, u = u_n n. The dynamic head h = 1/2 rho u_n^2 comes from the flux of the step before. Taken
// whole it swings from cell to cell where fluid crosses more than a cell in a step. So its mean over the patch, m(h), is taken whole, and
// of what a face has beyond the mean, h' = h - m(h), each step takes a share of the change:
//
//   q' <- q' + (h' - q')/(1 + C),   p = p_0 - m(h) - q'       C = dt |u_n| / (d.n),   d: way from the cell's centre to the face
//
// The error is of the order of C dt and gone in a steady flow. Linear analysis of a face against its cell (inertance rho |d|): stable for
// any C; of the mean against the column of length L: stable while water does not cross the column in less than half a step. Measured on
// tetrahedra: steady to round-off at a Courant number of 5; at 12 the flow of single faces swings by a tenth and more after a hundred
// steps.
#include <cmath>
#include <span>

#include "parallel/sum.hpp"
#include "solver/boundaries/boundary.hpp"
#include "solver/boundaries/time_course.hpp"

namespace snag {
namespace {

struct PressureInlet final : Boundary {
  static constexpr const char* name = "pressure_inlet";
  double pressure = 0;
  bool total = true;
  TimeCourse course;

  Section section() override {
    Section section{
        .name = name,
        .meaning = "Pressure of the fluid that enters, along the normal; its velocity follows from the flow.",
        .parameters = {{"pressure", &pressure, "Pa", -infinity, infinity, Basis::assumed, "Total or static pressure, relative."},
                       setting("total", &total,
                               "The pressure is the total one, as of a large tank: where fluid enters, its dynamic head is "
                               "subtracted. false: static.")}};
    course.add_keys(section, "pressure");
    return section;
  }
  std::vector<double> knots() const override { return course.knots(); }
  PrescribedQuantity fixes() const override { return PrescribedQuantity::pressure; }
  bool is_outlet() const override { return false; }
  void prepare(const Mesh&, const Patch& patch, const std::vector<PatchBoundary>&) override {
    course.check("[[boundary]] \"" + patch.name + "\"");
  }
  void respond(const Flow& flow, const Patch& patch, double time) override {
    mean_head_ = mean_before_ = 0;
    if (!total || !(time > flow.time)) return;  // before the first step no flux is known
    std::vector<double> area, head, before;
    for (int f = patch.first; f < patch.end(); ++f) {
      area.push_back(norm(flow.mesh.face_vector[f]));
      head.push_back(area.back() * dynamic_head(flow, f));
      before.push_back(area.back() * head_before(flow, f));
    }
    const double whole = sum(flow.mesh.comm, std::span<const double>(area));
    mean_head_ = sum(flow.mesh.comm, std::span<const double>(head)) / whole;
    mean_before_ = sum(flow.mesh.comm, std::span<const double>(before)) / whole;
  }
  void update(const Flow& flow, const Patch& patch, double time, BoundaryValues& values) const override {
    const double given = pressure * course.at(time), dt = time - flow.time;
    for (int f = patch.first; f < patch.end(); ++f) {
      double head = 0;
      if (total && dt > 0) {
        const double beyond = dynamic_head(flow, f) - mean_head_, beyond_before = head_before(flow, f) - mean_before_;
        head = mean_head_ + beyond_before + (beyond - beyond_before) / (1 + courant(flow, f, dt));
      }
      values.pressure[f - flow.mesh.n_interior] = given - head;
    }
  }

 private:
  static double dynamic_head(const Flow& flow, int f) {
    const double speed = flow.flux_old[f] / norm(flow.mesh.face_vector[f]);
    return speed < 0 ? 0.5 * flow.density * speed * speed : 0;
  }
  /// m(q) + q' of the last step, which its pressure at the face tells.
  double head_before(const Flow& flow, int f) const {
    return pressure * course.at(flow.time) - flow.boundary_pressure[f - flow.mesh.n_interior];
  }
  static double courant(const Flow& flow, int f, double dt) {
    return dt * std::abs(flow.flux_old[f]) / dot(flow.mesh.delta[f], flow.mesh.face_vector[f]);
  }
  double mean_head_ = 0, mean_before_ = 0;  // m(h), m(q)
};
const bool registered = boundaries().add<PressureInlet>();

}  // namespace
}  // namespace snag
