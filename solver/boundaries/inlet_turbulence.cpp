#include "solver/boundaries/inlet_turbulence.hpp"

#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {
constexpr double usual_intensity = 0.05;
constexpr double length_over_diameter = 0.07;  // mixing length of developed pipe flow
}  // namespace

std::vector<Parameter> InletTurbulence::parameters() {
  return {
      {"turbulence_intensity", &intensity, "1", 0, 1, Basis::assumed,
       "Turbulence intensity of entering fluid: rms fluctuation of a velocity component over the speed, 0.05 for 5 %; by default 0.05."},
      {"turbulence_length_scale", &length_scale, "m", 1e-12, infinity, Basis::literature,
       "Length scale of the eddies of entering fluid; by default 0.07 of the diameter of a circle with the area of the patch. The patch of "
       "a half model has half the area: give the length scale there."},
      {"turbulence_k", &k, "m2/s2", 0, infinity, Basis::assumed,
       "Turbulent kinetic energy of entering fluid, instead of the intensity; with turbulence_epsilon."},
      {"turbulence_epsilon", &epsilon, "m2/s3", 0, infinity, Basis::assumed,
       "Dissipation rate of entering fluid, instead of the length scale; with turbulence_k."}};
}

bool InletTurbulence::given() const { return intensity || length_scale || k || epsilon; }

void InletTurbulence::prepare(const Mesh& mesh, const Patch& patch, const std::string& where) {
  if (k.has_value() != epsilon.has_value())
    throw Error(ExitCode::usage, where + ": of turbulence_k and turbulence_epsilon only one is given; give both or none");
  if (k && (intensity || length_scale))
    throw Error(ExitCode::usage,
                where + ": turbulence_k is given together with turbulence_intensity or turbulence_length_scale; keep one kind");
  if (k && !(*k > 0 && *epsilon > 0))
    throw Error(ExitCode::usage, where + ": turbulence_k (" + std::to_string(*k) + ") and turbulence_epsilon (" + std::to_string(*epsilon) +
                                     ") must both be positive; for nearly laminar inflow give a small turbulence_intensity");
  std::vector<double> areas;
  for (int f = patch.first; f < patch.end(); ++f) areas.push_back(norm(mesh.face_vector[f]));
  diameter = std::sqrt(4 / std::numbers::pi * sum(mesh.comm, std::span<const double>(areas)));
}

TurbulenceValues InletTurbulence::at(double speed, double C_mu) const {
  if (k) return {*k, *epsilon};
  const double fluctuation = intensity.value_or(usual_intensity) * speed, energy = 1.5 * fluctuation * fluctuation;
  return {energy, std::pow(C_mu, 0.75) * energy * std::sqrt(energy) / length_scale.value_or(length_over_diameter * diameter)};
}

}  // namespace snag
