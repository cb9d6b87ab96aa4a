#pragma once
// A sphere in a prescribed flow in a few lines, for tests of the diagnosis: effects and nuisances as in the real one, and truths that the
// diagnosis does not know.
//
//   (1 + c r) dv/dt = (1 - r) g + (u - v) f(|u - v|)/tau + P r Du/Dt + lift + body,   r = rho_f/rho_p,   explicit Euler
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "diagnosis/diagnose.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag::formula {

struct Truth {
  std::map<std::string, double> effects{};
  std::map<std::string, double> nuisances{};  // relative, by name; per-point ones as name@point
  double form = 0;                            // relative error of form of the effects, changing sign along the path
  double body = 0;                            // m/s2, periodic force that no candidate is like
  double stratification = 0;                  // drag that grows along the path
  double gust = 0;                            // m/s2, along x and z from 0.30 s to 0.38 s
  std::optional<Gate> gate{};                 // of one of the effects
};

struct Flow {
  double amplitude = 0.3, omega = 12, mean = 0.1, shear = 0.5, diameter = 3e-3, density = 1150;
};

inline Flow flow_of(int point) {
  const double a[] = {0.3, 0.2, 0.4, 0.25, 0.35, 0.15, 0.3, 0.22, 0.38, 0.28}, w[] = {8, 14, 20, 11, 6, 25, 10, 17, 13, 22};
  const double d[] = {3e-3, 2e-3, 4e-3, 5e-3, 2.5e-3, 3.5e-3, 4.5e-3, 3e-3, 2e-3, 5e-3},
               m[] = {0.1, 0.2, 0.05, 0.15, 0.3, 0.1, 0.2, 0.12, 0.08, 0.25};
  const double rho[] = {1150, 1300, 1080, 1200, 1400, 1100, 1250, 1180, 1350, 1120};
  return {a[point % 10], w[point % 10], m[point % 10], 0.5 + 0.2 * (point % 3), d[point % 10], rho[point % 10]};
}

using Theta = std::map<std::string, double>;

// Positions x, z at the times; `form` and `body` only of truths.
inline std::vector<std::array<double, 2>> path(int point, const Theta& effects, const Theta& nuisances, const std::vector<double>& times,
                                               double step, std::uint64_t seed, const Truth* truth = nullptr,
                                               const std::optional<Restart>& restart = {}, const std::optional<Gate>& gate = {}) {
  const auto get = [](const Theta& map, const std::string& name) {
    const auto found = map.find(name);
    return found == map.end() ? 0.0 : found->second;
  };
  const Flow f = flow_of(point);
  const double flow = (1 + get(nuisances, "flow.amplitude")) * (1 + get(effects, "operating_point")),
               nu = 1e-5 * (1 + get(nuisances, "flow.viscosity"));
  const double r = 1000 / f.density, tau = f.density * f.diameter * f.diameter / (18 * 1000 * nu), g = 9.81;
  const double drag = (1 + get(nuisances, "drag_law_uncertainty")) * (1 + get(effects, "drag_magnitude")),
               scale = 1 + get(effects, "measurement");
  const double dispersion = get(effects, "turbulent_dispersion");
  Theta outside = effects;
  if (gate) outside.erase(gate->effect);
  NormalNumbers random(seed * 7919 + static_cast<std::uint64_t>(point));
  std::vector<std::array<double, 2>> result;
  double x = 0, z = 0, vx = f.mean, vz = 0, t = 0, eddy_x = 0, eddy_z = 0;
  std::size_t next = 0;
  double old_x = 0, old_z = 0;
  bool restarted = false;
  while (next < times.size()) {
    if (restart && !restarted && t >= restart->time - 1e-12) {
      restarted = true;
      x += restart->position[0], z += restart->position[2], vx += restart->velocity[0], vz += restart->velocity[2];
      old_x = x - step * vx, old_z = z - step * vz;
    }
    while (next < times.size() && times[next] <= t + 1e-12) {
      const double w = t > 0 ? (times[next] - (t - step)) / step : 1;
      result.push_back({scale * (old_x + w * (x - old_x)), scale * (old_z + w * (z - old_z))});
      ++next;
    }
    const bool open =
        !gate || (t >= gate->from && x >= gate->lower[0] && x <= gate->upper[0] && z >= gate->lower[2] && z <= gate->upper[2]);
    const Theta& acting = open ? effects : outside;
    const double added = get(acting, "added_mass") + get(acting, "entrained_water"), pressure = get(acting, "pressure_gradient"),
                 lift = get(acting, "lift");
    const double wave = truth ? 1 + truth->form * std::sin(9 * t + point) : 1;
    const double ux = flow * (f.mean + f.amplitude * std::sin(f.omega * t) + f.shear * z) + eddy_x,
                 uz = flow * 0.3 * f.amplitude * std::cos(f.omega * t) + eddy_z;
    const double dux = flow * f.amplitude * f.omega * std::cos(f.omega * t),
                 duz = -flow * 0.3 * f.amplitude * f.omega * std::sin(f.omega * t);
    const double wx = ux - vx, wz = uz - vz, Re = std::hypot(wx, wz) * f.diameter / nu;
    const double k = drag * (1 + 0.15 * std::pow(Re, 0.687)) / tau * (truth ? 1 + truth->stratification * std::abs(z) : 1);
    const double mass = 1 + added * wave * r, L = lift * wave * r * f.shear * flow;
    const double ax = (wx * k + pressure * wave * r * dux + L * wz + (truth ? truth->body * std::sin(15 * t) : 0)) / mass;
    const double az = ((r - 1) * g + wz * k + pressure * wave * r * duz - L * wx + (truth ? truth->body * std::cos(15 * t) : 0)) / mass;
    const double gust = truth && t > 0.30 && t < 0.38 ? truth->gust : 0;
    old_x = x, old_z = z;
    vx += step * (ax + gust), vz += step * (az + gust), x += step * vx, z += step * vz, t += step;
    if (dispersion > 0) {
      constexpr double memory = 0.1;
      eddy_x += -eddy_x * step / memory + dispersion * std::sqrt(2 * step / memory) * random();
      eddy_z += -eddy_z * step / memory + dispersion * std::sqrt(2 * step / memory) * random();
    }
  }
  return result;
}

class Sphere final : public Simulator {
 public:
  explicit Sphere(const Experiment& experiment, bool with_random = false, bool with_twin = false, bool with_gates = false)
      : experiment_(experiment) {
    effects_ = {{.name = "added_mass", .parameter = "", .mean = 0.5, .sd = 0.25, .minimum = 0, .maximum = 2},
                {.name = "drag_magnitude", .parameter = "", .mean = 0.3, .sd = 0.2, .minimum = -0.6, .maximum = 2},
                {.name = "lift", .parameter = "", .mean = 1, .sd = 0.5, .minimum = 0, .maximum = 4},
                {.name = "measurement", .parameter = "", .mean = 0, .sd = 0.02, .minimum = -0.1, .maximum = 0.1},
                {.name = "operating_point", .parameter = "", .mean = 0, .sd = 0.15, .minimum = -0.5, .maximum = 1},
                {.name = "pressure_gradient", .parameter = "", .mean = 1, .sd = 0.4, .minimum = 0, .maximum = 2}};
    if (with_twin) effects_.push_back({.name = "entrained_water", .parameter = "", .mean = 0.5, .sd = 0.25, .minimum = 0, .maximum = 2});
    for (Effect& effect : effects_)
      effect.may_be_local = with_gates && (effect.name == "added_mass" || effect.name == "lift" || effect.name == "pressure_gradient");
    effects_.push_back({.name = "wall", .parameter = "", .blind = "the case has no wall"});
    if (with_random)
      effects_.push_back({.name = "turbulent_dispersion",
                          .parameter = "",
                          .unit = "m/s",
                          .mean = 0.02,
                          .sd = 0.01,
                          .minimum = 0,
                          .maximum = 0.2,
                          .random = true});
    std::vector<int> all;
    slots_.resize(experiment.points.size());
    for (int p = 0; p < static_cast<int>(experiment.points.size()); ++p) {
      all.push_back(p);
      for (const auto& [name, u] : experiment.points[p].input_u)
        if (name == "flow.amplitude") nuisances_.push_back({name, u, {p}});
    }
    nuisances_.push_back({"drag_law_uncertainty", 0.05, all}), nuisances_.push_back({"flow.viscosity", 0.02, all});
    for (const Datum& d : experiment.data) {
      auto& slots = slots_[d.point];
      const bool there =
          std::any_of(slots.begin(), slots.end(), [&](const Slot& s) { return s.observable == d.observable && s.time == d.time; });
      if (!there) slots.push_back({d.observable, d.time});
    }
  }
  const std::vector<Effect>& effects() const override { return effects_; }
  const std::vector<Nuisance>& nuisances() const override { return nuisances_; }
  const std::vector<Slot>& slots(int point) const override { return slots_[point]; }
  std::vector<RunResult> run(std::span<const RunRequest> requests) override {
    std::vector<RunResult> results;
    for (const RunRequest& request : requests) {
      constexpr std::array<double, 3> none{};
      const auto key =
          std::tuple(request.point, request.effects, request.nuisances, request.effects.contains("turbulent_dispersion") ? request.seed : 0,
                     request.step_factor, request.restart ? request.restart->time : 0, request.restart ? request.restart->position : none,
                     request.restart ? request.restart->velocity : none, key_of(request.gate));
      const auto found = kept_.find(key);
      if (found != kept_.end()) {
        results.push_back(found->second);
        continue;
      }
      ++n_runs_;
      const auto& slots = slots_[request.point];
      std::vector<double> times;
      for (const Slot& s : slots)
        if (s.observable == slots.front().observable) times.push_back(s.time);
      const auto at = path(request.point, request.effects, request.nuisances, times, 1e-3 * request.step_factor, request.seed, nullptr,
                           request.restart, request.gate);
      RunResult result;
      for (std::size_t i = 0; i < slots.size(); ++i)
        result.values.push_back(at[i % times.size()][experiment_.observables[slots[i].observable].id == "z"]);
      kept_[key] = result;
      results.push_back(result);
    }
    return results;
  }
  bool restarts(int) const override { return true; }
  int n_runs() const override { return n_runs_; }

 private:
  static std::vector<double> key_of(const std::optional<Gate>& gate) {
    return gate ? std::vector{gate->from, gate->lower[0], gate->upper[0], gate->lower[2], gate->upper[2]} : std::vector<double>{};
  }

  const Experiment& experiment_;
  std::vector<Effect> effects_;
  std::vector<Nuisance> nuisances_;
  std::vector<std::vector<Slot>> slots_;
  std::map<std::tuple<int, Theta, Theta, std::uint64_t, double, double, std::array<double, 3>, std::array<double, 3>, std::vector<double>>,
           RunResult>
      kept_;
  int n_runs_ = 0;
};

/// Measurements of a truth: paths x, z at 40 times of `n_train` + `n_withheld` points.
inline Experiment experiment(const Truth& truth, int n_train, int n_withheld, int n_replicates, double noise, std::uint64_t seed) {
  Experiment e;
  e.name = "formula";
  e.observables = {{.id = "x", .unit = "m", .noise_u = noise, .calibration_group = ""},
                   {.id = "z", .unit = "m", .noise_u = noise, .calibration_group = ""}};
  std::vector<double> times;
  for (int i = 1; i <= 40; ++i) times.push_back(0.02 * i);
  NormalNumbers random(seed);
  const double viscosity = 0.02 * random(), drag = 0.05 * random();
  for (int p = 0; p < n_train + n_withheld; ++p) {
    e.points.push_back({.id = std::string(1, static_cast<char>('A' + p)),
                        .case_file = std::string(1, static_cast<char>('a' + p)),
                        .withheld = p >= n_train,
                        .input_u = {{"flow.amplitude", 0.05}}});
    Theta nuisances{{"flow.amplitude", 0.05 * random()}, {"flow.viscosity", viscosity}, {"drag_law_uncertainty", drag}};
    for (const auto& [name, value] : truth.nuisances) nuisances[name] = value;
    std::vector<std::vector<std::array<double, 2>>> paths;
    for (int r = 0; r < n_replicates; ++r)
      paths.push_back(
          path(p, truth.effects, nuisances, times, 0.7e-3, seed * 1000 + static_cast<std::uint64_t>(r) + 1, &truth, {}, truth.gate));
    for (int o = 0; o < 2; ++o)
      for (int r = 0; r < n_replicates; ++r)
        for (std::size_t k = 0; k < times.size(); ++k) e.data.push_back({p, o, r, times[k], paths[r][k][o] + noise * random()});
  }
  e.seed = 5;
  e.max_runs = 3000;
  return e;
}

inline Verdict judged(const Experiment& experiment) {
  Sphere sphere(experiment);
  return diagnose(experiment, sphere);
}

/// Names of the effects as one hypothesis, "added_mass+lift"; else none, outside, tie or blind.
inline std::string said(const Verdict& verdict) {
  std::string name;
  for (const std::string& effect : verdict.effects) name += (name.empty() ? "" : "+") + effect;
  return verdict.verdict == VerdictKind::effects ? name : word(verdict.verdict);
}

}  // namespace snag::formula
