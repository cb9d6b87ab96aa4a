#pragma once
// Candidates that are no forces of the water: errors of the measurement, of the set-points and of the start. One a file; each names its one
// number theta, says where a base case cannot show it, and how it changes a run.
#include <cstdint>

#include "base/registry.hpp"
#include "base/vec3.hpp"
#include "diagnosis/data/simulator.hpp"

namespace snag {

/// What a candidate may know of the base case of an operating point.
struct BaseCase {
  bool prescribed = true;                                                // the water is a formula, or stands frozen; false: it is computed
  bool wall = false, gravity = false;                                    // given in the case
  bool flows = false;                                                    // the water moves
  bool uniform = false, varies = false;                                  // it has a uniform steady part; one that changes in space or time
  bool gradient = false, turbulence = false;                             // of the velocity; k and epsilon are known
  bool bonds = false, sheet = false, several = false, oriented = false;  // of the pieces: fibres and cloth have a direction
};

/// How a run departs from the base model; as it stands here: not at all.
struct RunChange {
  double flow_factor = 1;     // of the velocity of the whole flow field
  double varying_factor = 1;  // of the part that changes in space or time
  double picture_scale = 1;   // of all lengths that a camera tells
  Vec3 picture_centre{};      // about this point, in sizes of the picture
  double turn = 0;            // of the pieces at the start, about the camera's line of sight, rad
};

class EffectModel {
 public:
  virtual ~EffectModel() = default;
  /// Its record, with the reason why this base case cannot show it, if there is one.
  virtual Effect effect(const BaseCase& base) const = 0;
  /// Adds an effect of strength theta to a run; `form`: index among its forms and deviations, `seed`: that of the run.
  virtual void change(double theta, int form, std::uint64_t seed, RunChange& run) const = 0;
};

/// All that are no forces, by the names of the candidates.
Registry<EffectModel>& effect_models();

}  // namespace snag
