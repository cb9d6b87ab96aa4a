// Linear springs and dashpots between two bodies in contact:
//
//   F_n = k_n d + c_n u_n      c_n = 2 |B| sqrt(k_n m*)       k_n = s E* R*
//   F_t = -k_t xi - c_t u_t    c_t = 2 |B| sqrt(k_t m*)       k_t = 4 (G*/E*) k_n, the ratio of Mindlin's stiffnesses
//   |k_t xi| <= mu max(F_n, 0),  |F_t| <= mu max(F_n, 0)      B = ln e / sqrt(ln^2 e + pi^2)
//
// with the symbols of dem/contacts/laws/hertz_mindlin.cpp; s is a number without unit, by which the spring is as stiff as Hertz's at one
// overlap, 4/3 sqrt(d/R*) = s: 0.4 at d = 0.09 R*. Over an impact d is half a period of a damped oscillator: it lasts
// pi/(omega sqrt(1 - B^2)), omega^2 = k_n/m*, and gives back exactly the share e of the speed, at every speed. An elastic impact at speed u
// goes as deep as u/omega.
// Source: Cundall and Strack (1979), Geotechnique 29, 47; coefficient of restitution: Schafer, Dippel and Wolf (1996), J. Phys. I 6, 5.
#include <numbers>

#include "dem/contacts/contact_blocks.hpp"

namespace snag {

namespace {

struct LinearSpringForce {
  double normal = 0, tangential = 0;                  // k_n, k_t; N/m
  double normal_damping = 0, tangential_damping = 0;  // c_n, c_t; N s/m
  double easing = 0;                                  // of the tangential dashpot, 1/kg
  double friction = 0;                                // mu

  LinearSpringForce(const ContactBodies& b, double stiffness) {
    const double damping = damping_of_restitution(b.restitution);
    normal = stiffness * b.normal_modulus * b.radius;
    tangential = 4 * b.shear_modulus / b.normal_modulus * normal;
    normal_damping = 2 * damping * std::sqrt(normal * b.mass), tangential_damping = 2 * damping * std::sqrt(tangential * b.mass);
    easing = dashpot_easing(b.mass), friction = b.friction;
  }
  [[gnu::always_inline]] ContactForce operator()(const ContactMotion& contact, double step) const {
    const double touching = contact.overlap > 0 ? 1 : 0;
    const double F_n = normal * contact.overlap + touching * normal_damping * dot(contact.velocity, contact.normal);
    return with_friction(contact, F_n, tangential, eased(tangential_damping, easing, step), friction, step);
  }
};

class LinearSpringPair final : public BlockLaw<LinearSpringForce> {
 public:
  LinearSpringPair(const ContactBodies& bodies, double stiffness) : BlockLaw(LinearSpringForce(bodies, stiffness)), mass_(bodies.mass) {}

  double impact_time(double) const override { return std::numbers::pi * std::sqrt(mass_ / force_.normal); }
  double deepest_overlap(double speed) const override { return speed * std::sqrt(mass_ / force_.normal); }
  ContactRates rates(double, double step) const override {
    return {normal_rates(force_.normal, force_.normal_damping, mass_),
            force_.friction > 0 ? tangential_rates(force_.tangential, force_.tangential_damping, mass_, step) : StepRates{}};
  }

 private:
  double mass_;
};

struct LinearSpring final : ContactLaw {
  static constexpr const char* name = "linear_spring";
  double stiffness_over_modulus = 0.4;

  ContactLawDescription description() const override {
    return {.name = name,
            .equation =
                "F_n = k_n d + 2 |B| sqrt(k_n m*) u_n, k_n = s E* R*; F_t = -k_t xi - 2 |B| sqrt(k_t m*) u_t, "
                "k_t = 4 (G*/E*) k_n, at most mu F_n",
            .source = "Cundall and Strack (1979)",
            .valid_for = "spheres of which neither overlaps nor impact times matter; the restitution holds at every speed"};
  }
  std::vector<Parameter> parameters() override {
    return {{"stiffness_over_modulus", &stiffness_over_modulus, "1", 1e-6, 1e3, Basis::assumed,
             "s: normal stiffness over E* R*; 0.4 is the stiffness F_n/d of Hertz at an overlap of 0.09 R*."}};
  }
  std::shared_ptr<const PairLaw> between(const ContactBodies& bodies) const override {
    return std::make_shared<LinearSpringPair>(bodies, stiffness_over_modulus);
  }
  std::vector<ContactReference> reference_cases() const override {
    const ContactBodies bodies{.normal_modulus = 1e6, .shear_modulus = 2e5, .radius = 1e-3, .mass = 1e-6, .restitution = 1};
    ContactBodies damped = bodies;
    damped.restitution = std::exp(-std::numbers::pi / std::sqrt(3.0));  // damping ratio 1/2
    return {{.what = "spring alone",
             .source = "F = k_n d, T = pi sqrt(m*/k_n), k_n = 400 N/m",
             .bodies = bodies,
             .overlap = 1e-5,
             .force = 4e-3,
             .impact_time = std::numbers::pi * 5e-5,
             .tolerance = 1e-12},
            {.what = "with its dashpot at a damping ratio of 1/2",
             .source = "c_n = sqrt(k_n m*) = 0.02 N s/m",
             .bodies = damped,
             .overlap = 1e-5,
             .approach = 0.1,
             .force = 6e-3,
             .impact_time = std::numbers::pi * 5e-5,
             .tolerance = 1e-12}};
  }
};
[[maybe_unused]] const bool registered = contact_laws().add<LinearSpring>();

}  // namespace
}  // namespace snag
