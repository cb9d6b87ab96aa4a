// Inlet with a given pressure:
//
//   total:    p = p_0 - 1/2 rho u_n^2 where fluid enters (solver/boundaries/entering_head.hpp);  p = p_0 where it leaves
//   static:   p = p_0
//
// du/dn = 0; the fluid enters along the normal, u = u_n n.
#include "solver/boundaries/boundary.hpp"
#include "solver/boundaries/entering_head.hpp"
#include "solver/boundaries/time_course.hpp"
#include "solver/boundaries/water_column.hpp"

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
                               "subtracted. false: static; the water may then diverge at the inlet, for the pressure does not hold "
                               "the speed of single faces.")}};
    course.add_keys(section, "pressure");
    return section;
  }
  std::vector<double> knots() const override { return course.knots(); }
  PrescribedQuantity fixes() const override { return PrescribedQuantity::pressure; }
  bool is_outlet() const override { return false; }
  std::string advice() const override {
    return total ? "" : "total = true, with the dynamic head added to pressure: a static pressure does not hold the speed of single faces";
  }
  void prepare(const Mesh& mesh, const Patch& patch, const std::vector<PatchBoundary>& all) override {
    course.check("[[boundary]] \"" + patch.name + "\"");
    if (total) head_ = EnteringHead(column_conductance(mesh, all, patch, ControlledOutlets::open));
  }
  double given_pressure(double time) const override { return pressure * course.at(time); }
  void respond(const Flow& flow, const Patch& patch, double time) override {
    if (total) head_.begin_step(flow, patch, time, given_pressure(flow.time));
  }
  void update(const Flow& flow, const Patch& patch, double time, BoundaryValues& values) const override {
    for (int f = patch.first; f < patch.end(); ++f)
      values.pressure[f - flow.mesh.n_interior] = given_pressure(time) - (total ? head_.at(flow, f) : 0);
  }

 private:
  EnteringHead head_;
};
const bool registered = boundaries().add<PressureInlet>();

}  // namespace
}  // namespace snag
