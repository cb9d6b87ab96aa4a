// Hertz-Mindlin contact with adhesion: cloth that was pressed to a wall stays there until it is pulled off.
//
//   F_n = F_h - F_a,   F_a = 2 pi w R*  while the bodies touch (d > 0)         F_h: normal force of hertz_mindlin.cpp
//   |S_t xi| <= mu max(F_h, 0),  |F_t| <= mu max(F_h, 0): a load F on the contact, F = F_n, gives the limit mu (F + F_a)
//
//   w    work of adhesion of the two surfaces, J/m2
//   F_a  pull-off force, N: at rest without load the overlap is d_0 = (F_a/k)^(2/3), F_h = k d^(3/2), and the contact ends at a pull of F_a
//
// Source: Derjaguin, Muller and Toporov (1975), J. Colloid Interface Sci. 53, 314-326, for stiff bodies and forces of short range; friction
// limit: Derjaguin (1934), Z. Phys. 88, 661-675.
//
// Of a cloth every particle has this force, so that its pull-off stress is pi w/(2 r_p) with a wall: w = 2 r_p s/pi gives a stress s on any
// lattice. What holds by a pressure difference across the cloth (suction) is not part of it.
//
//   elastic impact at speed u from touching:  1/2 m* u^2 = P(D),  P(d) = 2/5 k d^(5/2) - F_a d      deepest overlap D, by Newton's method
//   its duration, touching to touching                2 int_0^D dd / sqrt(2 (P(D) - P(d))/m*)
#include "dem/contacts/laws/hertz_mindlin.hpp"

#include <numbers>

namespace snag {

namespace {

struct HertzDmtForce {
  HertzMindlinForce hertz;
  double pull_off = 0;  // F_a, N

  HertzDmtForce(const ContactBodies& bodies, double work_of_adhesion)
      : hertz(bodies), pull_off(2 * std::numbers::pi * work_of_adhesion * bodies.radius) {}
  [[gnu::always_inline]] ContactForce operator()(const ContactMotion& contact, double step) const {
    const double pull = contact.overlap > 0 ? pull_off : 0;
    ContactForce result = hertz(contact, step);
    result.force += pull * contact.normal, result.normal -= pull;
    return result;
  }
};

class HertzDmtPair final : public BlockLaw<HertzDmtForce> {
 public:
  HertzDmtPair(const ContactBodies& bodies, double work_of_adhesion)
      : BlockLaw(HertzDmtForce(bodies, work_of_adhesion)), mass_(bodies.mass) {}

  double deepest_overlap(double speed) const override {
    const double k = force_.hertz.normal, F = force_.pull_off, energy = 0.5 * mass_ * speed * speed;
    double d = std::pow(2.5 * energy / k, 0.4) + std::pow(2.5 * F / k, 2.0 / 3);  // above the root of the convex P(d) - energy
    for (int i = 0; i < 60; ++i) d -= (potential(d) - energy) / (k * d * std::sqrt(d) - F);
    return d;
  }
  double impact_time(double speed) const override {
    constexpr int n = 400;
    const double D = deepest_overlap(speed), top = potential(D);
    double time = 0;  // with d = D (1 - s^2) the integrand is smooth
    for (int i = 0; i < n; ++i) {
      const double s = (i + 0.5) / n;
      time += 2 * D * s / n / std::sqrt(2 * (top - potential(D * (1 - s * s))) / mass_);
    }
    return 2 * time;
  }
  ContactRates rates(double overlap, double step) const override { return force_.hertz.rates(overlap, mass_, step); }

 private:
  double potential(double d) const { return 0.4 * force_.hertz.normal * d * d * std::sqrt(d) - force_.pull_off * d; }
  double mass_;
};

struct HertzDmt final : ContactLaw {
  static constexpr const char* name = "hertz_dmt";
  double wall_adhesion = 0.05, adhesion = 0;  // w, J/m2

  ContactLawDescription description() const override {
    return {.name = name,
            .equation = "F_n = F_h - 2 pi w R* in contact, F_h and F_t of hertz_mindlin, F_t at most mu F_h",
            .source = "Derjaguin, Muller and Toporov (1975)",
            .valid_for =
                "stiff bodies; of a cloth the pull-off stress from a wall is pi w/(2 r_p), so that w goes with the lattice; no suction"};
  }
  std::vector<Parameter> parameters() override {
    return {{"wall_adhesion", &wall_adhesion, "J/m2", 0, 100, Basis::assumed,
             "w: work of adhesion of cloth and wall; no value for wet cloth on steel was found."},
            {"adhesion", &adhesion, "J/m2", 0, 100, Basis::assumed, "w of particles with each other."}};
  }
  std::shared_ptr<const PairLaw> between(const ContactBodies& bodies) const override {
    return std::make_shared<HertzDmtPair>(bodies, bodies.with_wall ? wall_adhesion : adhesion);
  }
  std::vector<ContactReference> reference_cases() const override {
    // Defaults: w = 0.05 J/m2 with walls, so that F_a = 2 pi 0.05 1e-3 N; k = 4/3 E* sqrt(R*) = 4.2164e4 N/m^1.5.
    const ContactBodies bodies{.normal_modulus = 1e6, .shear_modulus = 4e5, .radius = 1e-3, .mass = 1e-6, .with_wall = true};
    return {{.what = "a particle about to leave a wall",
             .source = "pull-off force 2 pi w R* (Derjaguin, Muller and Toporov 1975)",
             .bodies = bodies,
             .overlap = 1e-10,
             .force = -3.1415926535897932e-4,
             .impact_time = reference_impact_time,
             .tolerance = 1e-5},
            {.what = "an overlap at which Hertz gives 8 times the pull-off force",
             .source = "F = 7 F_a at d = 4 (F_a/k)^(2/3)",
             .bodies = bodies,
             .overlap = 1.5259281401e-5,
             .force = 2.1991148575128552e-3,
             .impact_time = reference_impact_time,
             .tolerance = 1e-5}};
  }
  static constexpr double reference_impact_time =
      1.8227233e-4;  // s, of the integral by Gauss' quadrature with 400 points; Hertz: 1.80969e-4
};
[[maybe_unused]] const bool registered = contact_laws().add<HertzDmt>();

}  // namespace
}  // namespace snag
