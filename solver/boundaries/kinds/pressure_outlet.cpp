// Outlet with a given static pressure, or with a given flow:
//
//   p = p_out,   du/dn = 0
//
// Where fluid enters instead, it comes along the normal, u = (flux/|S|) n, and from rest: p_out is its total pressure there
// (solver/boundaries/entering_head.hpp).
//
// p_out is as the case gives it, or with a target of the flow the level that leads there (solver/boundaries/flow_target.hpp).
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "base/words.hpp"
#include "parallel/sum.hpp"
#include "solver/boundaries/boundary.hpp"
#include "solver/boundaries/entering_head.hpp"
#include "solver/boundaries/flow_target.hpp"
#include "solver/boundaries/time_course.hpp"
#include "solver/boundaries/water_column.hpp"

namespace snag {
namespace {

constexpr double usual_response = 20;         // steps
constexpr double shortest_response = 4;       // steps: stable with an inertance up to four times the true one
constexpr double tolerated_deviation = 0.05;  // of the flow at the end of a run from its target

struct PressureOutlet final : Boundary {
  static constexpr const char* name = "pressure_outlet";
  double pressure = 0;
  std::optional<double> target_flow_rate, response_time;
  TimeCourse course;
  std::optional<FlowTarget> control;
  EnteringHead head;

  Section section() override {
    Section section{
        .name = name,
        .meaning =
            "Static pressure; fluid leaves with zero normal gradient. Where it enters it comes along the normal and from rest, with this "
            "pressure as its total pressure.",
        .parameters = {
            {"pressure", &pressure, "Pa", -infinity, infinity, Basis::assumed,
             "Static pressure, relative; with target_flow_rate the initial level, unless the initial field has a pressure."},
            {"target_flow_rate", &target_flow_rate, "m3/s", -infinity, infinity, Basis::assumed,
             "Volume flow out of the domain; a controller sets the pressure level for it. Another patch must prescribe the pressure."},
            {"response_time", &response_time, "s", 0, infinity, Basis::assumed,
             "Time constant of the flow controller; by default 20 time steps. If it is longer than the period of the fluctuations, the "
             "flow may fluctuate; where friction holds the flow, in narrow channels, the target takes many times as long: shorten it."}}};
    course.add_keys(section, "pressure (with target_flow_rate: the target)");
    return section;
  }
  std::vector<double> knots() const override { return course.knots(); }
  PrescribedQuantity fixes() const override { return PrescribedQuantity::pressure; }
  bool pressure_is_prescribed() const override { return !target_flow_rate; }
  /// p_out at a time; with a target that of the controller's last step.
  double given_pressure(double time) const override { return control ? control->level() : pressure * course.at(time); }

  void prepare(const Mesh& mesh, const Patch& patch, const std::vector<PatchBoundary>& all) override {
    const std::string where = "[[boundary]] \"" + patch.name + "\"";
    course.check(where);
    if (response_time && !target_flow_rate)
      throw Error(ExitCode::usage, where + ": response_time is given without target_flow_rate; remove it or give the target");
    if (!target_flow_rate) return;
    if (std::none_of(all.begin(), all.end(), [](const PatchBoundary& other) { return other.boundary->pressure_is_prescribed(); }))
      throw Error(ExitCode::usage, where +
                                       ": target_flow_rate needs another patch where the pressure is given, from which the fluid comes; "
                                       "use kind = \"pressure_inlet\", or remove target_flow_rate");
    control.emplace(column_conductance(mesh, all, patch, ControlledOutlets::closed), pressure);
  }

  void respond(const Flow& flow, const Patch& patch, double time) override {
    head.begin_step(flow, patch, time, given_pressure(flow.time));
    if (!control) return;
    const double dt = time - flow.time;
    if (!(dt > 0)) {
      start_level(flow, patch);
      return;
    }
    const double response = response_time.value_or(usual_response * dt);
    // A hair's breadth for the rounding of time.
    if (response < shortest_response * dt * (1 - 1e-6))
      throw Error(ExitCode::usage, "[[boundary]] \"" + patch.name + "\": response_time (" + number_text(response) +
                                       " s) must be at least " + number_text(shortest_response) + " time steps of " + number_text(dt) +
                                       " s; make it longer or the steps shorter");
    const double now = through(flow, patch, flow.flux_old), before = through(flow, patch, flow.flux);
    control->advance({.flow = now, .flow_before = before, .dt = dt, .dt_before = flow.time_step > 0 ? flow.time_step_size : 0},
                     *target_flow_rate * course.at(time), flow.density, response);
  }

  void update(const Flow& flow, const Patch& patch, double time, BoundaryValues& values) const override {
    for (int f = patch.first; f < patch.end(); ++f) values.pressure[f - flow.mesh.n_interior] = given_pressure(time) - head.at(flow, f);
  }

  std::string unmet(const Flow& flow, const Patch& patch) const override {
    if (!control) return {};
    const double target = *target_flow_rate * course.at(flow.time), now = through(flow, patch, flow.flux);
    if (std::abs(now - target) <= tolerated_deviation * std::abs(*target_flow_rate)) return {};
    const double response = response_time.value_or(usual_response * flow.time_step_size);
    return "[[boundary]] \"" + patch.name + "\": at the end of the run " + number_text(1e3 * now) +
           " L/s flow out, target_flow_rate asks for " + number_text(1e3 * target) + " L/s; run longer, or give a response_time below " +
           number_text(response) + " s";
  }

  std::vector<double> state() const override { return control ? control->state() : std::vector<double>{}; }
  void restore(const std::vector<double>& state) override {
    if (control) control->restore(state);
  }

 private:
  static double through(const Flow& flow, const Patch& patch, const std::vector<double>& flux) {
    return sum(flow.mesh.comm, std::span(flux).subspan(static_cast<std::size_t>(patch.first), static_cast<std::size_t>(patch.count)));
  }

  /// Of an initial field the mean pressure of the cells at the outlet, so that a run goes on where another one ended.
  void start_level(const Flow& flow, const Patch& patch) {
    const Mesh& mesh = flow.mesh;
    const bool given = std::any_of(flow.pressure.begin(), flow.pressure.begin() + mesh.n_cells, [](double p) { return p != 0; });
    if (sum(mesh.comm, std::int64_t{given}) == 0) return;
    std::vector<double> area, weighted;
    for (int f = patch.first; f < patch.end(); ++f) {
      area.push_back(norm(mesh.face_vector[f]));
      weighted.push_back(area.back() * flow.pressure[mesh.owner[f]]);
    }
    control->set_level(sum(mesh.comm, std::span<const double>(weighted)) / sum(mesh.comm, std::span<const double>(area)));
  }
};
const bool registered = boundaries().add<PressureOutlet>();

}  // namespace
}  // namespace snag
