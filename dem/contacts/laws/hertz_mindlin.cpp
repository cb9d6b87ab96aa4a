// Hertz-Mindlin contact of two elastic spheres, damped, with the history of slip:
//
//   F_n = 4/3 E* sqrt(R*) d^(3/2) + 2 sqrt(5/6) |B| sqrt(S_n m*) u_n       S_n = 2 E* sqrt(R* d)
//   F_t = -S_t xi - 2 sqrt(5/6) |B| sqrt(S_t m*) u_t                       S_t = 8 G* sqrt(R* d)
//   |S_t xi| <= mu max(F_n, 0),  |F_t| <= mu max(F_n, 0)                   B = ln e / sqrt(ln^2 e + pi^2)
//   (the tangential dashpot is eased for long steps: dem/contacts/contact_law.hpp)
//
//   F_n > 0 pushes apart; it also pulls at the end of a damped impact, as published: only so is the restitution e.
//   d    overlap, m
//   n    unit normal from body 1 to body 2
//   u    velocity of body 1 relative to body 2 at the contact, u_n = u.n (rate of d), u_t = u - u_n n
//   xi   slip (elastic tangential displacement), m: turned with the normal, grows by u_t dt, cut back where the spring alone would exceed
//        the Coulomb limit
//   E*, G*, R*, m*: of the two bodies (dem/contacts/contact_law.hpp)
//
// Source: Jensen (2018) Eqs. 3.3-3.9 and 3.23, after Tsuji et al. (1992). The damping makes d^(5/4) a damped oscillator, so that e is exact
// for every speed (Antypov and Elliott 2011). An elastic impact at speed u lasts 2.9432 (m*^2/(k^2 u))^(1/5), k = 16/15 E* sqrt(R*).
//
//   Hertz time (of an elastic impact at speed u)      T_H = 2.9432 (m*^2/(k^2 u))^(1/5)
//   deepest overlap of that impact                    d = (m* u^2/k)^(2/5)
//   springs at d, for the stability of a step          normal 3/2 F_n/d, tangential S_t
// Source of the impact: Johnson (1985) section 11.4.
#include "dem/contacts/laws/hertz_mindlin.hpp"

namespace snag {

namespace {

class HertzMindlinPair final : public BlockLaw<HertzMindlinForce> {
 public:
  explicit HertzMindlinPair(const ContactBodies& bodies) : BlockLaw(HertzMindlinForce(bodies)), bodies_(bodies) {}

  double impact_time(double speed) const override { return 2.943175 * deepest_overlap(speed) / speed; }
  double deepest_overlap(double speed) const override { return std::pow(bodies_.mass * speed * speed / (0.8 * force_.normal), 0.4); }
  ContactRates rates(double overlap, double step) const override { return force_.rates(overlap, bodies_.mass, step); }

 private:
  ContactBodies bodies_;
};

struct HertzMindlin final : ContactLaw {
  static constexpr const char* name = "hertz_mindlin";

  ContactLawDescription description() const override {
    return {.name = name,
            .equation =
                "F_n = 4/3 E* sqrt(R*) d^(3/2) + 2 sqrt(5/6) |B| sqrt(S_n m*) u_n, S_n = 2 E* sqrt(R* d); "
                "F_t = -S_t xi - 2 sqrt(5/6) |B| sqrt(S_t m*) u_t, S_t = 8 G* sqrt(R* d), at most mu F_n",
            .source = "Jensen (2018) Eqs. 3.3-3.9 and 3.23, after Tsuji et al. (1992)",
            .valid_for = "elastic spheres, overlaps small against the radius; the restitution holds at every speed"};
  }
  std::shared_ptr<const PairLaw> between(const ContactBodies& bodies) const override { return std::make_shared<HertzMindlinPair>(bodies); }

  std::vector<ContactReference> reference_cases() const override {
    // Chung and Ooi (2011), benchmark 1: two glass spheres of 10 mm, 48 GPa, nu = 0.2, 2800 kg/m3: E* = 25 GPa, R* = 5 mm, m* = 5.8643 g.
    // At 20 m/s they overlap by (15 m* u^2/(16 E* sqrt(R*)))^(2/5); T_H goes as u^(-1/5).
    const ContactBodies glass{.normal_modulus = 25e9, .shear_modulus = 5.5556e9, .radius = 5e-3, .mass = 5.8643e-3};
    return {{.what = "two glass spheres pressed together by 10 um",
             .source = "Hertz (1882): F = 4/3 E* sqrt(R*) d^(3/2)",
             .bodies = glass,
             .overlap = 1e-5,
             .force = 74.5356,
             .impact_time = 7.3438e-5,
             .tolerance = 1e-4}};
  }
};
[[maybe_unused]] const bool registered = contact_laws().add<HertzMindlin>();

}  // namespace
}  // namespace snag
