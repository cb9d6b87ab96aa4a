#pragma once
// Candidates that are no forces of the water: errors of the measurement, of the set-points and of the start. One a file; each names its one
// number theta, says where a base case cannot show it, and how it changes a run.
#include <array>
#include <cstdint>
#include <string>

#include "base/registry.hpp"
#include "base/vec3.hpp"
#include "diagnosis/data/simulator.hpp"

namespace snag {

/// What a candidate may know of the base case of an operating point.
struct CaseFeatures {
  bool prescribed = true;                     // the water is a formula, or stands frozen; false: it is computed
  bool wall = false, gravity = false;         // given in the case
  bool flows = false;                         // the water moves
  bool uniform = false, varies = false;       // it has a uniform steady part; one that changes in space or time
  bool gradient = false, turbulence = false;  // of the velocity; k and epsilon are known
  bool bonds = false, sheet = false, fibre = false, several = false, oriented = false;  // of the pieces: fibres and cloth have a direction
  bool hertz = false;                                                                   // contacts by the law of Hertz
  bool pipe = false, bend = false;          // [pipe_flow] of water that is not computed, and its bend
  bool crumple = false, averaging = false;  // a piece starts crumpled by a pipe; water of cells is averaged over a width that is given
};

/// What of several cases at least one has; prescribed: all of them.
CaseFeatures any_of(CaseFeatures a, const CaseFeatures& b);

/// A run of a case that effects change. As it is handed to them, it is the base model.
class RunEdit {
 public:
  virtual ~RunEdit() = default;
  /// What effects may know of the case.
  virtual const CaseFeatures& base() const = 0;
  /// Gives a key a value, "section.key=value"; the last one counts.
  virtual void set(const std::string& text) = 0;
  /// Multiplies the numbers that the case has at a key; factors on one key multiply. Nothing where the case has no such number.
  virtual void scale(const std::string& key, double factor) = 0;
  /// The velocity of the whole flow field, or of the part that changes in space or time: of computed water, its set-points.
  void scale_flow(double factor);
  void scale_varying_flow(double factor);
  /// Adds to the vectors that the case has at a key; what is added to one key adds up. Nothing where the case has no such vector.
  virtual void add(const std::string& key, const Vec3& vector) = 0;
  /// Moves the pieces at the start, m, and adds to their angular velocity, rad/s.
  void move_pieces(const Vec3& way);
  void spin_pieces(const Vec3& spin);
  /// Moves the pieces at the start towards the inside of the bend of [pipe_flow], m.
  virtual void move_pieces_inside(double way) = 0;
  /// The pieces at the start, about the camera's line of sight, rad.
  virtual void turn_pieces(double angle) = 0;
  /// Multiplies all lengths that a camera measures. The fixed point lies one picture size along `axis`, or at the origin (axis -1).
  virtual void scale_picture(double factor, int axis) = 0;
};

/// Places and angular velocities of the pieces at the start.
inline constexpr std::array piece_places{"rag.centre_m", "disc.centre_m", "fibre.centre_m", "particle.position_m"};
inline constexpr std::array piece_spins{"rag.spin_rad_s", "disc.spin_rad_s", "fibre.spin_rad_s", "particle.spin_rad_s"};

/// What sets the flow of water that is computed.
inline constexpr std::array set_points{"boundary.flow_rate_m3_s", "boundary.target_flow_rate_m3_s", "boundary.velocity_m_s",
                                       "flow.initial_velocity_m_s"};

class EffectModel {
 public:
  virtual ~EffectModel() = default;
  /// Its record, with the reason why this base case cannot show it, if there is one.
  virtual Effect effect(const CaseFeatures& base) const = 0;
  /// Adds an effect of strength theta to a run; `form`: index among its forms and deviations, `seed`: that of the run.
  virtual void change(double theta, int form, std::uint64_t seed, RunEdit& run) const = 0;
};

/// All that are no forces, by the names of the candidates.
Registry<EffectModel>& effect_models();

}  // namespace snag
