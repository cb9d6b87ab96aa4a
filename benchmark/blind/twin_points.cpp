#include "benchmark/blind/twin_points.hpp"

#include <algorithm>
#include <array>

#include "base/error.hpp"
#include "base/parameter_text.hpp"
#include "base/vec3.hpp"
#include "observe/observables.hpp"

namespace snag {

namespace {

/// One of the flows: still, oscillating along x, sheared, both; all with a little through-flow along x.
struct Flow {
  Vec3 velocity, amplitude, omega;
  double shear = 0;  // du_x/dz, 1/s
};

std::string flow_text(const Flow& flow, double viscosity) {
  return "[flow]\nkind = \"prescribed\"\ndensity_kg_m3 = 1000\nkinematic_viscosity_m2_s = " + toml_text(viscosity) +
         "\nvelocity_m_s = " + toml_text(flow.velocity) + "\ngradient_per_s = [[0.0, 0.0, " + toml_text(flow.shear) +
         "], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]\namplitude_m_s = " + toml_text(flow.amplitude) +
         "\nangular_frequency_rad_s = " + toml_text(flow.omega) + "\n";
}

Flow flow_of(int kind, NormalNumbers& random, double speed) {
  const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  Flow flow;
  flow.velocity = {between(0.1, 0.5) * speed, 0, 0};
  if (kind == 1 || kind == 3) flow.amplitude = {between(0.5, 1.5) * speed, 0, 0}, flow.omega = {between(8, 25), 0, 0};
  if (kind == 2 || kind == 3) flow.shear = between(10, 30) * speed;
  return flow;
}

std::string time_text(double end, double step) { return "[time]\nend_s = " + toml_text(end) + "\nstep_s = " + toml_text(step) + "\n"; }

/// A plane that is passed downwards at height z, or downstream at x.
std::string exit_text(char axis, const std::string& at) {
  const bool downstream = axis == 'x';
  return "[virtual_camera]\nright = [1.0, 0.0, 0.0]\nup = [0.0, 0.0, 1.0]\nexit_point_m = [" +
         (downstream ? at + ", 0.0, 0.0" : "0.0, 0.0, " + at) + "]\nexit_normal = [" + (downstream ? "1.0, 0.0, 0.0" : "0.0, 0.0, -1.0") +
         "]\n";
}

constexpr const char* fall = "[gravity]\nacceleration_m_s2 = [0, 0, -9.81]\n";
constexpr const char* drag = "[coupling]\nmode = \"one_way\"\nforces = [\"schiller_naumann\"]\n";

std::vector<double> sample_times(double end, int n) {
  std::vector<double> times;
  for (int i = 1; i <= n; ++i) times.push_back(end * i / n);
  return times;
}

/// What one picture in the x-z plane tells of a fibre or a rag, and a watch at the exit.
void add_camera(TwinExperiment& twin, double place_u, double area_u, double angle_u) {
  for (const char* id : {"x", "z"}) twin.instruments.push_back({id, "m", "gaussian", place_u, place_u, "camera"});
  twin.instruments.push_back({"area", "m2", "gaussian", area_u, 0, ""});
  twin.instruments.push_back({"orientation", "rad", "angle", angle_u, 0, ""});
  twin.instruments.push_back({"retention_time", "s", "lognormal", 0.03, 0, ""});
}

TwinExperiment sphere(NormalNumbers& random) {
  const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  TwinExperiment twin;
  const double diameter = between(4e-3, 8e-3), density = between(1100, 1800), viscosity = between(4e-6, 2e-5);
  const double end = 0.8, speed = 0.1;
  for (const int kind : {1, 2, 3, 0, 3, 1, 2}) {
    const Flow flow = flow_of(kind, random, speed * between(0.7, 1.5));
    const double from_wall = between(0.8, 1.6) * diameter;  // of the centre
    std::string text = time_text(end, 1e-3) + fall + flow_text(flow, viscosity) + drag;
    text += "[[particle]]\ndiameter_m = " + toml_text(diameter) + "\ndensity_kg_m3 = " + toml_text(density) +
            "\nshear_modulus_Pa = 1e4\nposition_m = [0.0, " + toml_text(kind == 0 || kind == 2 ? from_wall : 10 * diameter) + ", 0.0]\n";
    text += "[[wall]]\nkind = \"plane\"\npoint_m = [0, 0, 0]\nnormal = [0, 1, 0]\n";
    text += exit_text('z', "-0.04");
    twin.cases.push_back(text);
  }
  const double noise = between(1e-4, 4e-4);
  for (const char* id : {"x", "y", "z"}) twin.instruments.push_back({id, "m", "gaussian", noise, noise, "camera"});
  for (const char* id : {"vx", "vz"}) twin.instruments.push_back({id, "m/s", "gaussian", 20 * noise, 0, ""});
  twin.instruments.push_back({"retention_time", "s", "lognormal", 0.03, 0, ""});
  twin.times = sample_times(end, 16);
  twin.inputs = {"\"flow.amplitude\" = 0.05", "\"particle.density_kg_m3\" = 0.002", "\"flow.kinematic_viscosity_m2_s\" = 0.02",
                 "\"drag_law_uncertainty\" = 0.05"};
  return twin;
}

TwinExperiment fibre(NormalNumbers& random) {
  const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  TwinExperiment twin;
  const double length = between(0.02, 0.03), modulus = between(3e4, 1.5e5), density = between(1100, 1400), viscosity = between(1e-5, 4e-5);
  const double end = 0.4, speed = 0.3;
  constexpr int n_points = 12;
  for (const int kind : {1, 2, 3, 0, 3, 1, 2}) {
    const Flow flow = flow_of(kind, random, speed * between(0.7, 1.5));
    const double angle = between(-0.6, 0.6), from_wall = between(0.8, 1.6) * length / n_points;  // of the fibre's axis
    std::string text = time_text(end, 1e-3) + fall + flow_text(flow, viscosity) + drag;
    text += "[[fibre]]\nlength_m = " + toml_text(length) + "\nn_points = " + std::to_string(n_points) +
            "\nyoungs_modulus_Pa = " + toml_text(modulus) + "\ndensity_kg_m3 = " + toml_text(density) +
            "\nshear_modulus_Pa = 1e4\ncentre_m = [0.0, " + toml_text(kind == 0 || kind == 2 ? from_wall : 0.05) +
            ", 0.0]\nlengthwise = " + toml_text(Vec3{std::cos(angle), 0, std::sin(angle)}) + "\n";
    text += "[[wall]]\nkind = \"plane\"\npoint_m = [0, 0, 0]\nnormal = [0, 1, 0]\n" + exit_text('z', open_exit);
    twin.cases.push_back(text);
  }
  add_camera(twin, between(1e-4, 3e-4), 1e-6, 0.02);
  twin.times = sample_times(end, 12);
  twin.inputs = {"\"flow.amplitude\" = 0.05", "\"fibre.density_kg_m3\" = 0.005", "\"fibre.youngs_modulus_Pa\" = 0.05",
                 "\"drag_law_uncertainty\" = 0.05"};
  twin.path = 0.02, twin.tip_acceleration = 40;
  return twin;
}

TwinExperiment rag(NormalNumbers& random) {
  const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  TwinExperiment twin;
  const double viscosity = between(1e-6, 1e-5), end = 0.2, speed = 0.3;
  for (const int kind : {1, 2, 3, 3, 1, 2}) {
    const Flow flow = flow_of(kind, random, speed * between(0.7, 1.5));
    const double angle = between(-0.6, 0.6);
    std::string text = time_text(end, 1e-3) + fall + flow_text(flow, viscosity) + drag;
    text += "[[rag]]\nlength_mm = 56\nwidth_mm = 56\nradius_mm = 2\nshear_modulus_Pa = 1e4\ncentre_m = [0.0, 0.0, 0.0]\nlengthwise = " +
            toml_text(Vec3{std::cos(angle), 0, std::sin(angle)}) + "\ncrosswise = [0.0, 1.0, 0.0]\n";
    text += "[[wall]]\nkind = \"plane\"\npoint_m = [0, 0, -0.1]\nnormal = [0, 0, 1]\n" + exit_text('x', open_exit);
    twin.cases.push_back(text);
  }
  add_camera(twin, between(2e-4, 5e-4), 3e-5, 0.03);
  twin.times = sample_times(end, 8);
  twin.inputs = {"\"flow.amplitude\" = 0.05", "\"rag.mass_per_area_kg_m2\" = 0.02", "\"drag_law_uncertainty\" = 0.05"};
  twin.exit_axis = "x", twin.path = 0.02, twin.tip_acceleration = 10;
  return twin;
}

}  // namespace

TwinExperiment twin_experiment(const std::string& twin, NormalNumbers& random) {
  if (twin == "sphere") return sphere(random);
  if (twin == "fibre") return fibre(random);
  if (twin == "rag") return rag(random);
  throw Error(ExitCode::usage, "--twin " + twin + ": there is no such twin; there are sphere, fibre, rag");
}

bool in_subset(const std::string& subset, const std::string& observable) {
  if (subset == "all") return true;
  const ObservableRecord& record = *find_observable(observable);
  if (subset == "passage") return record.is_of_whole_run();
  return !record.is_of_whole_run() && record.measure != Measure::velocity && observable != "y";
}

}  // namespace snag
