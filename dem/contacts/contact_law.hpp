#pragma once
// Laws of contact: one law a file of dem/contacts/laws/, chosen by name for a case (`[contact] law`).
//
// A law makes a PairLaw of two bodies. It evaluates a block of contacts of that pair in one call: which law it is, is decided once a block,
// never once a contact (dem/contacts/contact_blocks.hpp).
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/parameter.hpp"
#include "base/registry.hpp"
#include "base/vec3.hpp"
#include "dem/particles/step_rates.hpp"

namespace snag {

struct ContactBlock;
struct RollingFriction;

/// Two elastic bodies that may touch.
///   1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2,  1/G* = (2 - nu_1)/G_1 + (2 - nu_2)/G_2,  E = 2 G (1 + nu)
///   1/R* = 1/R_1 + 1/R_2,  1/m* = 1/m_1 + 1/m_2
struct ContactBodies {
  double normal_modulus = 0, shear_modulus = 0;  // E*, G*; Pa
  double radius = 0;                             // R*, m
  double mass = 0;                               // m*, kg
  double restitution = 1;                        // e
  double friction = 0;                           // mu
  bool with_wall = false;                        // body 2 is a wall
};

/// |B| = |ln e| / sqrt(ln^2 e + pi^2): damping ratio of a linear oscillator that keeps the share e of its speed over half a period.
double damping_of_restitution(double restitution);

/// State of one contact.
struct ContactMotion {
  double overlap = 0;  // d >= 0, m
  Vec3 normal;         // n, unit, from body 1 to body 2
  Vec3 velocity;       // u of body 1 relative to body 2 at the contact, m/s
  Vec3 slip;           // xi before, m
};

struct ContactForce {
  Vec3 force;         // on body 1, N
  double normal = 0;  // F_n, N
  Vec3 slip;          // xi after, m
};

inline constexpr double smallest_square =
    1e-300;  // keeps 0/0 from being formed; far below the square of any length, speed or force that matters

/// Force on body 1 and the slip after `step` seconds, of a normal force F_n (N, > 0 pushes apart) and a tangential spring S_t (N/m) and
/// dashpot c_t (N s/m), with Coulomb's limit:
///   F_t = -S_t xi - c_t u_t,   |S_t xi| <= mu max(F_n, 0),   |F_t| <= mu max(F_n, 0)
/// xi is turned with the normal, grows by u_t dt, and is cut back where the spring alone would exceed the limit. Branch-free.
[[gnu::always_inline]] inline ContactForce with_friction(const ContactMotion& contact, double F_n, double S_t, double c_t, double friction,
                                                         double step) {
  const Vec3& n = contact.normal;
  const double u_n = dot(contact.velocity, n);
  const Vec3 u_t = contact.velocity - u_n * n;
  const double limit = friction * std::max(F_n, 0.0);

  // Slip is turned into the present tangent plane without change of length.
  const Vec3 tangent = contact.slip - dot(contact.slip, n) * n;
  const Vec3 turned = std::sqrt(norm_squared(contact.slip) / (norm_squared(tangent) + smallest_square)) * tangent;
  Vec3 slip = turned + step * u_t;
  slip *= std::min(1.0, limit / (S_t * std::sqrt(norm_squared(slip)) + smallest_square));

  Vec3 F_t = -S_t * slip - c_t * u_t;
  F_t *= std::min(1.0, limit / std::sqrt(norm_squared(F_t) + smallest_square));
  return {F_t - F_n * n, F_n, slip};
}

/// Of a contact of two bodies, over their reduced mass m*; tangential: without the rotation, zero without friction.
struct ContactRates {
  StepRates normal, tangential;
};

/// The law between two given bodies.
class PairLaw {
 public:
  virtual ~PairLaw() = default;
  /// Forces, rolling torques and slips of a block of contacts.
  virtual void evaluate(ContactBlock& block, const RollingFriction& rolling, double step) const = 0;
  /// Of an elastic impact at `speed` (m/s): how long it lasts, s, and the deepest overlap, m.
  virtual double impact_time(double speed) const = 0;
  virtual double deepest_overlap(double speed) const = 0;
  /// Of the springs and dashpots at this overlap, m, for steps up to `step`, s.
  virtual ContactRates rates(double overlap, double step) const = 0;
  /// Largest step at impacts of this speed, s: the impact is resolved and the damped springs are stable.
  double stable_step(double speed) const;
};

inline constexpr double impact_steps = 8;      // sub-steps that resolve an impact: restitution then holds to some percent
inline constexpr double turning_sphere = 3.5;  // 1 + m r^2/I of a solid sphere, which also turns under a tangential force

// A tangential dashpot also acts on the rotation of the spheres: it alone would determine the step, in proportion to the number of
// contacts of a particle. It is reduced as an implicit step would do, for up to eight contacts:
//   c_t' = c_t/(1 + N q c_t dt/(2 m*)),  N = 8,  q = turning_sphere
// For short steps this is c_t (an error of first order, as that of the lagging velocity), and dt/2 q c_t'/m* stays below 1/N.
inline constexpr double easing_contacts = 8;

/// q N/(2 m*), 1/kg.
inline double dashpot_easing(double mass) { return easing_contacts * turning_sphere / (2 * mass); }

[[gnu::always_inline]] inline double eased(double dashpot, double easing, double step) { return dashpot / (1 + easing * dashpot * step); }

/// Rates of a spring and a dashpot: K = k/m*, C = c/m*.
inline StepRates normal_rates(double stiffness, double dashpot, double mass) { return {stiffness / mass, dashpot / mass, 0}; }
/// The same with an eased dashpot, for steps up to `step`, s.
inline StepRates tangential_rates(double stiffness, double dashpot, double mass, double step) {
  return {stiffness / mass, 0, 0.5 * step * eased(dashpot, dashpot_easing(mass), step) / mass};
}

/// What a law is, for the manual.
struct ContactLawDescription {
  std::string name, equation, source, valid_for;
};

/// A normal contact known from outside this code: an exact limit or a published number.
struct ContactReference {
  std::string what, source;
  ContactBodies bodies;
  double overlap = 0;      // m
  double approach = 0;     // u_n, m/s
  double force = 0;        // F_n, N
  double impact_time = 0;  // of an elastic impact at 1 m/s, s
  double tolerance = 0;    // 1
};

class ContactLaw {
 public:
  virtual ~ContactLaw() = default;
  virtual ContactLawDescription description() const = 0;
  /// Table [contact.NAME] of the case file.
  virtual std::vector<Parameter> parameters() { return {}; }
  virtual std::shared_ptr<const PairLaw> between(const ContactBodies& bodies) const = 0;
  virtual std::vector<ContactReference> reference_cases() const = 0;
};

Registry<ContactLaw>& contact_laws();
inline constexpr const char* default_contact_law = "hertz_mindlin";
/// Tables of the laws, for the manual.
std::vector<Section> contact_law_sections();

}  // namespace snag
