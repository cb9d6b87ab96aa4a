#pragma once
// Turbulence of the fluid that enters through a patch, from its speed U there:
//
//   k = 3/2 (I U)^2,   epsilon = C_mu^(3/4) k^(3/2) / l          I: intensity;  l: length scale, 0.07 D;  D = sqrt(4 A / pi) of the patch
//
// or k and epsilon as given. Source: usual practice for developed duct flow, e.g. Versteeg and Malalasekera (2007), section 3.7.2.
#include <optional>
#include <string>
#include <vector>

#include "base/parameter.hpp"
#include "mesh/mesh.hpp"

namespace snag {

/// k, m2/s2, and epsilon, m2/s3, of one place.
struct TurbulenceValues {
  double k = 0, epsilon = 0;
};

struct InletTurbulence {
  std::optional<double> intensity;     // I, 0.05 if not given
  std::optional<double> length_scale;  // l, m
  std::optional<double> k, epsilon;    // m2/s2, m2/s3
  double diameter = 0;                 // D, m

  /// Keys in a [[boundary]] table; they point into this object.
  std::vector<Parameter> parameters();
  /// True if the case says anything about the turbulence of this patch.
  bool given() const;
  /// Finds D. Throws Error(usage) if the keys contradict each other; `where` for the message. Collective.
  void prepare(const Mesh& mesh, const Patch& patch, const std::string& where);
  /// What enters with a speed U, m/s.
  TurbulenceValues at(double speed, double C_mu) const;
};

}  // namespace snag
