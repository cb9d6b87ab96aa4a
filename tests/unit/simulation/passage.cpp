// ranks: 1 3
// long ranks: 2
// A rag that is led through a made-up pump by hand: events, times and outcome are known. Shaft along z, inlet above, tongue at x = 110 mm,
// outlet along +y beyond it; the rag is 80 mm long, along the shaft.
#include "simulation/setup/passage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "base/error.hpp"
#include "dem/contacts/contact_solver.hpp"
#include "dem/templates/rag_settings.hpp"
#include "dem/walls/walls.hpp"
#include "parallel/session.hpp"
#include "simulation/output/rag_forces.hpp"
#include "simulation/setup/boundary_openings.hpp"
#include "tests/structured_box.hpp"

namespace snag {
namespace {

constexpr double step = 1e-3, degree = std::numbers::pi / 180, half_length = 0.039;
constexpr double in_eye = 0.05, in_gap = 0.105, in_volute = 0.13;  // radii, m: the impeller's is 100 mm, the tongue's 110 mm

PassageSettings pump() {
  PassageSettings s;
  s.inlet_flange = {0, 0, 0.09}, s.inlet_normal = {0, 0, -2}, s.inlet_radius = 0.05;
  s.outlet_flange = {0.15, 0.3, 0.02}, s.outlet_normal = {0, 1, 0}, s.outlet_radius = 0.04;
  s.tongue = {0.11, 0, 0}, s.tongue_reach = 0.01, s.impeller_radius = 0.1;
  return s;
}

PassageGeometry geometry(const PassageSettings& settings = pump(), double speed = 125) {
  return {settings, {}, {0, 0, 1}, speed, "case.toml: [rag_passage]"};
}

Vec3 at(double degrees, double radius, double z = 0.02) {
  return {radius * std::cos(degrees * degree), radius * std::sin(degrees * degree), z};
}

/// Leads a rag along lines and arcs; its passage is looked at after every step.
class Led {
 public:
  explicit Led(std::optional<PassageGeometry> pump_geometry = geometry(), std::vector<Opening> openings = {}, bool floor_turns = false)
      : passage(MPI_COMM_WORLD, std::move(openings), std::move(pump_geometry), 1) {
    walls.add_plane("floor", {0, 0, -0.05}, {0, 0, 1},
                    WallMotion{.axis = {0, 0, 1}, .origin = {}, .speed = floor_turns ? 125.0 : 0, .velocity = {}});
    RagSettings settings;
    settings.length = 0.08, settings.width = 0.004, settings.radius = 1e-3;
    settings.lengthwise = {0, 0, 1}, settings.crosswise = {0, 1, 0};
    piece = make_piece(settings, "test");
    rags = std::make_unique<RagSystem>(MPI_COMM_WORLD, DemSettings{}, std::vector<RagPiece>{piece});
    rags->set_contacts(std::make_unique<ContactSolver>(ContactSettings{}, rags->rags(), &walls));
    if (passage.geometry())
      rags->contacts()->set_tongue({passage.geometry()->tongue(), passage.geometry()->direction(), passage.geometry()->tongue_reach()});
  }

  void look(const Vec3& centre) {
    for (Tile& tile : rags->tiles())
      for (int j = -1; j <= tile.ny; ++j)
        for (int i = -1; i <= tile.nx; ++i) {
          const int k = tile.index(i, j), column = tile.column + i, row = tile.row + j;
          if (tile.exists[k] > 0) tile.set_vector(Tile::x, k, centre + piece.pose(column, row).position + moved(column, row));
        }
    rags->evaluate_contacts();
    passage.observe(*rags, ++n_steps * step, step);
    rags->contacts()->reset_measures();
    here = centre;
  }
  void follow(double seconds, const std::function<Vec3(double)>& way) {
    const int n = static_cast<int>(std::lround(seconds / step));
    for (int i = 1; i <= n; ++i) look(way(static_cast<double>(i) / n));
  }
  void line(const Vec3& to, double seconds) {
    const Vec3 from = here;
    follow(seconds, [&](double s) { return from + s * (to - from); });
  }
  void arc(double from, double to, double radius, double seconds) {
    follow(seconds, [&](double s) { return at(from + s * (to - from), radius); });
  }
  void stay(double seconds) { line(here, seconds); }

  double time() const { return n_steps * step; }
  PassageResult verdict() const { return passage.verdict(0); }
  std::string story() const {
    std::string all;
    for (const auto& event : verdict().events) all += (all.empty() ? "" : ", ") + std::string(words_of(event.what).key);
    return all;
  }
  PassageResult::Event event(PassageEvent what) const {
    for (const auto& one : verdict().events)
      if (one.what == what) return one;
    return {};
  }

  RagPiece piece;
  WallSet walls;
  Passage passage;
  std::unique_ptr<RagSystem> rags;
  std::function<Vec3(int column, int row)> moved = [](int, int) { return Vec3{}; };
  Vec3 here;
  int n_steps = 0;
};

void lead_in(Led& rag) {
  rag.look(at(180, 0.03, 0.2));
  rag.line(at(180, 0.03), 0.36);  // at 0.5 m/s
}

void lead_out(Led& rag) { rag.line({in_volute, 0.5, 0.02}, 0.25); }  // at 2 m/s

TEST(Passage, StraightThrough) {
  Led rag;
  lead_in(rag);
  rag.line(at(180, in_volute), 0.1);
  rag.arc(180, 360, in_volute, 0.18);
  const double at_tongue = rag.time();
  lead_out(rag);
  EXPECT_EQ(rag.story(), "entered, wholly in the casing, tongue passed, reached the outlet, exited");
  const PassageResult v = rag.verdict();
  EXPECT_EQ(v.outcome, Outcome::exited);
  EXPECT_TRUE(rag.passage.all_exited_at());
  const double entered = step + (0.2 - 0.09 - half_length) / 0.5, inside = entered + 2 * half_length / 0.5, out = at_tongue + 0.301 / 2;
  EXPECT_NEAR(rag.event(PassageEvent::entered).time, entered, step);
  EXPECT_NEAR(rag.event(PassageEvent::entered).angle.value(), 180, 1e-9);
  EXPECT_NEAR(v.time_to_enter.value(), inside - entered, step);
  EXPECT_NEAR(v.retention_time.value(), out - inside, 2 * step);
  EXPECT_EQ(v.recirculations.value(), 0);
  EXPECT_NEAR(rag.event(PassageEvent::tongue_passed).angle.value(), 360, 2);
  EXPECT_EQ(v.stuck_on_tongue.value(), 0);
  EXPECT_EQ(v.wall_contact, 0);

  ASSERT_TRUE(v.volute);
  double total = 0;
  for (const double time : v.volute->time) total += time;
  EXPECT_NEAR(total, rag.event(PassageEvent::tongue_passed).time - rag.event(PassageEvent::wholly_in).time, 1.5 * step);
  EXPECT_NEAR(v.volute->time[13], 0.02, 1e-12);  // of 260 to 280 degrees
  EXPECT_NEAR(v.volute->radius_time[13] / v.volute->time[13], in_volute, 1e-12);
  EXPECT_EQ(v.volute->time[4], 0);
}

TEST(Passage, TwiceRoundTheVolute) {
  Led rag;
  lead_in(rag);
  rag.line(at(180, in_gap), 0.1);
  rag.arc(180, 350, in_gap, 0.1);
  EXPECT_EQ(rag.verdict().outcome, Outcome::in_domain) << "on its way";
  rag.arc(350, 900, in_gap, 0.4);
  EXPECT_EQ(rag.verdict().outcome, Outcome::recirculating);
  EXPECT_EQ(rag.verdict().recirculations.value(), 2);
  rag.line(at(900, in_volute), 0.1);
  rag.arc(900, 1080, in_volute, 0.2);
  lead_out(rag);
  EXPECT_EQ(rag.story(), "entered, wholly in the casing, recirculated, recirculated, tongue passed, reached the outlet, exited");
  const auto events = rag.verdict().events;
  EXPECT_NEAR(events[2].angle.value(), 380, 2);
  EXPECT_NEAR(events[3].angle.value(), 740, 2);
  EXPECT_NEAR(events[4].angle.value(), 1080, 2);
  EXPECT_EQ(rag.verdict().recirculations.value(), 2);
}

TEST(Passage, TurningInTheEyeIsNoRecirculation) {
  Led rag;
  lead_in(rag);
  rag.arc(180, 180 + 5 * 360, in_eye, 0.5);
  EXPECT_EQ(rag.verdict().recirculations.value(), 0);
  EXPECT_EQ(rag.verdict().outcome, Outcome::in_domain);
}

TEST(Passage, SwingingAtTheTongueIsOneRecirculation) {
  Led rag;
  rag.look(at(200, in_gap));
  rag.arc(200, 365, in_gap, 0.2);
  for (int i = 0; i < 5; ++i) rag.arc(365, 340, in_gap, 0.02), rag.arc(340, 365, in_gap, 0.02);
  EXPECT_EQ(rag.verdict().recirculations.value(), 0) << "it has not got past yet";
  rag.arc(365, 480, in_gap, 0.1), rag.arc(480, 350, in_gap, 0.1), rag.arc(350, 370, in_gap, 0.1);
  EXPECT_EQ(rag.verdict().recirculations.value(), 1) << "it went back past the tongue in between";
}

TEST(Passage, HangingOnTheTongueAndPulledOutIsNoRecirculation) {
  Led rag;
  rag.look(at(200, in_gap));
  rag.arc(200, 370, in_gap, 0.2);
  rag.line({in_volute, 0.02, 0.02}, 0.1);
  lead_out(rag);
  EXPECT_EQ(rag.verdict().recirculations.value(), 0);
  EXPECT_EQ(rag.story(), "entered, wholly in the casing, tongue passed, reached the outlet, exited");
}

TEST(Passage, ImpellerThatTurnsTheOtherWay) {
  // The same pump in a mirror.
  PassageSettings mirrored = pump();
  mirrored.outlet_flange.y *= -1, mirrored.outlet_normal.y *= -1;
  Led rag(geometry(mirrored, -125));
  rag.look(at(150, in_gap));
  rag.arc(150, -200, in_gap, 0.4);
  EXPECT_EQ(rag.verdict().recirculations.value(), 1);
  EXPECT_NEAR(rag.event(PassageEvent::recirculated).angle.value(), -20, 2);
  rag.line(at(-200, in_volute), 0.1);
  rag.arc(-200, -360, in_volute, 0.2);
  rag.line({in_volute, -0.5, 0.02}, 0.2);
  EXPECT_EQ(rag.verdict().outcome, Outcome::exited);
  EXPECT_EQ(rag.story(), "entered, wholly in the casing, recirculated, tongue passed, reached the outlet, exited");
}

TEST(Passage, StuckOnTheTongue) {
  const Vec3 above{0.113, 0.004, 0}, on_it{0.113, 0.004, -0.05 + half_length + 0.9e-3};
  Led rag;
  rag.look(above);
  rag.look(on_it);
  const double begin = rag.time() - step;
  rag.stay(0.599);
  rag.look(above), rag.line(above, 0.029);  // short enough
  rag.look(on_it), rag.line(on_it, 0.869);
  EXPECT_EQ(rag.verdict().outcome, Outcome::stuck_on_tongue);
  EXPECT_NEAR(rag.event(PassageEvent::stuck_on_tongue).time, begin + 1, 1.5 * step);
  EXPECT_GT(rag.passage.sightings()[0].touching[WallRegion::tongue], 0);
  rag.look(above), rag.line(above, 0.099);
  EXPECT_EQ(rag.verdict().outcome, Outcome::in_domain);
  rag.look(on_it), rag.line(on_it, 0.499);
  EXPECT_EQ(rag.story(), "entered, wholly in the casing, tongue passed, stuck on tongue");
  const PassageResult v = rag.verdict();
  EXPECT_NEAR(v.stuck_on_tongue.value(), 1.5, 1e-9) << "short gaps included, the last half second not";
  EXPECT_NEAR(v.tongue_contact.value(), 1.47 + 0.5, 1e-9);
  EXPECT_NEAR(v.wall_contact, 1.47 + 0.5, 1e-9);
  EXPECT_EQ(v.other_contact, 0);
  EXPECT_EQ(v.impeller_contact, 0);
  EXPECT_EQ(v.stuck_on_impeller.value(), 0);
}

TEST(Passage, StuckOnTheImpeller) {
  Led rag(geometry(), {}, true);
  const Vec3 on_it = at(90, in_eye, -0.05 + half_length + 0.9e-3);
  rag.look(on_it);
  rag.stay(1.2);
  EXPECT_EQ(rag.verdict().outcome, Outcome::stuck_on_impeller);
  EXPECT_EQ(rag.story(), "entered, wholly in the casing, stuck on impeller");
  EXPECT_NEAR(rag.verdict().impeller_contact, 1.201, 1e-9);
  EXPECT_EQ(rag.verdict().tongue_contact.value(), 0);
}

/// Led round the volute on a floor that turns as the impeller, `turns` in the time, counter-clockwise.
PassageResult led_round(double turns, double seconds) {
  Led rag(geometry(), {}, true);
  const auto on_it = [](double degrees) { return at(degrees, in_gap, -0.05 + half_length + 0.9e-3); };
  rag.look(on_it(180));
  rag.follow(seconds, [&](double s) { return on_it(180 + 360 * turns * s); });
  EXPECT_NEAR(rag.verdict().impeller_contact, seconds, 2 * step);
  return rag.verdict();
}

TEST(Passage, GoingRoundIsNotStuck) {
  const PassageResult slow = led_round(7, 1.4), with_the_impeller = led_round(1.4 * 125 / (2 * std::numbers::pi), 1.4);
  EXPECT_EQ(slow.outcome, Outcome::recirculating);
  EXPECT_EQ(slow.recirculations.value(), 7);
  EXPECT_EQ(slow.stuck_on_impeller.value(), 0);
  EXPECT_EQ(with_the_impeller.outcome, Outcome::stuck_on_impeller);
  EXPECT_NEAR(with_the_impeller.stuck_on_impeller.value(), 1.4, 2 * step);
}

TEST(Passage, NeverEntered) {
  Led rag;
  rag.look(at(180, 0.03, 0.2));
  rag.line(at(180, 0.03, 0.14), 0.5);
  EXPECT_EQ(rag.story(), "");
  EXPECT_EQ(rag.verdict().outcome, Outcome::upstream);
  rag.line(at(180, 0.03, 0.1), 0.1);
  EXPECT_EQ(rag.story(), "entered");
  const PassageResult v = rag.verdict();
  EXPECT_EQ(v.outcome, Outcome::upstream);
  EXPECT_FALSE(v.retention_time);
  EXPECT_FALSE(v.time_to_enter);
  EXPECT_FALSE(rag.passage.all_exited_at());
}

TEST(Passage, LargestTensionAndItsPlace) {
  Led rag;
  rag.look(at(90, in_eye));
  rag.moved = [](int column, int row) { return Vec3{0, 0, column == 30 && row == 1 ? 1e-4 : 0.0}; };
  rag.look(at(120, in_eye));
  rag.moved = [](int column, int row) { return Vec3{0, 0, column == 5 && row == 0 ? 0.5e-4 : 0.0}; };
  rag.look(at(130, in_eye));
  const PassageResult v = rag.verdict();
  const Rag& cloth = rag.piece.rag;
  EXPECT_NEAR(v.max_tension, cloth.bond[0].normal_stiffness * std::numbers::pi * 1e-6 * 1e-4, 0.02 * v.max_tension);
  EXPECT_EQ(v.max_tension_time.value(), 2 * step);
  const Vec3 place = at(120, in_eye) + rag.piece.pose(29, 1).position + Vec3{0, 0, 1.05e-3};  // between columns 29 and 30
  EXPECT_LT(norm(v.max_tension_place - place), 1e-12);
  EXPECT_NEAR(v.max_tension_angle.value(), geometry().angle(place) / degree, 1e-9);
}

TEST(Passage, RestoredInMidWayItGoesOnTheSame) {
  Led whole, resumed;
  for (Led* rag : {&whole, &resumed}) {
    lead_in(*rag);
    rag->line(at(180, in_gap), 0.1);
    rag->arc(180, 500, in_gap, 0.2);
  }
  const std::vector<double> kept = resumed.passage.state();
  resumed.passage = Passage(MPI_COMM_WORLD, {}, geometry(), 1);
  resumed.passage.restore(kept);
  for (Led* rag : {&whole, &resumed}) {
    rag->arc(500, 600, in_gap, 0.1);
    rag->line(at(600, in_volute), 0.1);
    rag->arc(600, 720, in_volute, 0.1);
    lead_out(*rag);
  }
  EXPECT_EQ(whole.verdict().outcome, Outcome::exited);
  EXPECT_EQ(whole.story(), resumed.story());
  EXPECT_EQ(whole.passage.state(), resumed.passage.state());
}

TEST(Passage, WithoutAPumpByItsOpenings) {
  const std::vector<Opening> openings{{"tank", {0, 0, 0.09}, {0, 0, 1}, 0.05, false}, {"drain", {0.15, 0.3, 0.02}, {0, 1, 0}, 0.04, true}};
  Led rag({}, openings);
  rag.look(at(180, 0.03, 0.2));
  EXPECT_EQ(rag.verdict().outcome, Outcome::upstream);
  EXPECT_EQ(rag.passage.n_out()[0], 0) << "beyond an inlet nothing has left";
  rag.line(at(180, 0.03), 0.1);
  EXPECT_EQ(rag.verdict().outcome, Outcome::in_domain);
  rag.line({0.13, 0, 0.02}, 0.1);
  lead_out(rag);
  EXPECT_EQ(rag.verdict().outcome, Outcome::exited);
  EXPECT_EQ(rag.story(), "reached the outlet, exited");
  EXPECT_EQ(rag.passage.n_out()[0], 80);
  EXPECT_FALSE(rag.verdict().recirculations);
  EXPECT_FALSE(rag.event(PassageEvent::exited).angle);
}

TEST(Passage, AnglesAreSeenFromTheInlet) {
  EXPECT_NEAR(geometry().angle({0, 0.1, 0}), 90 * degree, 1e-12);
  EXPECT_EQ(geometry().angle({-1e-21, -2e-21, 0.1}), 0) << "on the axis, to rounding";
  EXPECT_NEAR(geometry().height({0, 0.1, 0.03}), 0.03, 1e-15);
  EXPECT_EQ(geometry().sense(), 1);
  PassageSettings below = pump();
  below.inlet_flange.z = -0.09, below.inlet_normal = {0, 0, 1};
  EXPECT_NEAR(geometry(below).angle({0, 0.1, 0}), -90 * degree, 1e-12) << "from below it is clockwise";
  EXPECT_EQ(geometry(below).sense(), -1);
}

TEST(Passage, WrongTablesAreRefused) {
  const auto refused = [](const std::function<void(PassageSettings&)>& change) {
    PassageSettings settings = pump();
    change(settings);
    EXPECT_THROW(geometry(settings), Error);
  };
  refused([](PassageSettings& s) { s.inlet_normal = {}; });
  refused([](PassageSettings& s) { s.inlet_normal = {1, 0, 0}; });
  refused([](PassageSettings& s) { s.outlet_normal = {}; });
  refused([](PassageSettings& s) { s.tongue = {0, 0, 0.05}; });
  refused([](PassageSettings& s) { s.outlet_radius = 0; });
  refused([](PassageSettings& s) { s.impeller_radius = 0; });
  EXPECT_THROW(read_passage(CaseFile::parse("[rag_passage]\n").root(), {}), Error);
}

TEST(RagForces, QuantilesOfMagnitudes) {
  Led rag;
  RagForces forces;
  for (const Tile& tile : rag.rags->tiles())
    for (int j = 0; j < tile.ny; ++j)
      for (int i = 0; i < tile.nx; ++i) {
        const auto id = static_cast<double>(particle_id(rag.rags->rags()[0], tile, i, j));  // 0 .. 79
        forces.fluid.push_back({0, id + 1, 0});
        forces.contact.push_back({id < 10 ? id + 1 : 0, 0, 0});
      }
  const RagForceSpread spread = force_spreads(*rag.rags, forces).at(0);
  if (rank_of(MPI_COMM_WORLD) != 0) return;
  EXPECT_EQ(spread.fluid.mean, 40.5);
  EXPECT_EQ(spread.fluid.p50, 41);
  EXPECT_EQ(spread.fluid.p90, 73);
  EXPECT_EQ(spread.fluid.p99, 80);
  EXPECT_EQ(spread.fluid.largest, 80);
  EXPECT_EQ(spread.n_in_contact, 10);
  EXPECT_EQ(spread.contact.mean, 5.5);
  EXPECT_EQ(spread.contact.largest, 10);
}

// Requirement: an opening reaches as far as its patch does, also where that is a single face.
TEST(Openings, HoldTheirPatch) {
  for (const int n : {1, 3}) {
    const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {3, 0.6, 0.8}, {4, n, n});
    const BoundarySet boundary(mesh, read_boundaries(CaseFile::parse("[[boundary]]\npatch = \"x1\"\nkind = \"pressure_outlet\"\n"
                                                                     "[[boundary]]\npatches = [\"x0\", \"y0\", \"y1\", \"z0\", \"z1\"]\n"
                                                                     "kind = \"wall\"\n")
                                                         .root()));
    const auto found = openings(mesh, boundary);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].name, "x1");
    EXPECT_NEAR(found[0].radius, 0.5, 1e-12);
    EXPECT_LT(norm(found[0].centre - Vec3{3, 0.3, 0.4}), 1e-12);
  }
}

}  // namespace
}  // namespace snag
