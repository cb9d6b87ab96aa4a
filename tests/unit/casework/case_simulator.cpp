// The simulator of a diagnosis over real runs: what an effect, an uncertain input and a calibration do to a run.
// ranks: 1 3
// long ranks: 2
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <set>

#include "base/error.hpp"
#include "diagnosis/statistics/statistics.hpp"
#include "tests/unit/casework/swung_sphere.hpp"

namespace snag {
namespace {

/// Requirement: every fixed name of the candidates that this build has is listed once, with the reason where it cannot be seen.
TEST_F(CaseSimulatorTest, ListsTheLibrary) {
  const CaseSimulator simulator(MPI_COMM_WORLD, experiment_);
  std::map<std::string, std::string> blind;
  for (const Effect& effect : simulator.effects()) {
    EXPECT_TRUE(blind.emplace(effect.name, effect.blind).second) << effect.name;
    EXPECT_NE(effect.mean, 0) << effect.name << ": its signature would be nothing";
    EXPECT_GT(effect.sd, 0) << effect.name;
    EXPECT_LE(effect.minimum, effect.mean) << effect.name;
    EXPECT_GE(effect.maximum, effect.mean) << effect.name;
  }
  for (const char* name :
       {"added_mass", "pressure_gradient", "drag_magnitude", "drag_exponent", "history", "measurement", "operating_point", "flow_error"})
    EXPECT_EQ(blind.at(name), "") << name;
  for (const char* name : {"wall", "lift", "gravity", "bond_damping", "friction", "initial_pose", "inlet", "geometry", "volume_fraction",
                           "turbulent_dispersion", "sheet_drag", "shielding"})
    EXPECT_NE(blind.at(name), "") << name;
}

/// Requirement: theta = 0 is the base model to the bit, and each effect that is not blind changes the run.
TEST_F(CaseSimulatorTest, EffectsChangeTheRun) {
  CaseSimulator simulator(MPI_COMM_WORLD, experiment_);
  const auto base = values(simulator, RunRequest());
  for (const Effect& effect : simulator.effects()) {
    EXPECT_EQ(values(simulator, with(effect.name, 0)), base) << effect.name;
    if (!effect.blind.empty()) continue;
    EXPECT_NE(values(simulator, with(effect.name, effect.mean))[2], base[2]) << effect.name;
  }
}

/// Requirement: what a case with a pipe, a bend and a fibre can show beyond others: at zero the base model to the bit, else another run;
/// and the start moves towards the inside of the bend where the piece is, together with a candidate that moves it.
TEST_F(CaseSimulatorTest, EffectsOfAPipe) {
  std::string text = swung_sphere;
  const std::size_t piece = text.find("[[particle]]"), coupling = text.find("[coupling]");
  text.replace(piece, coupling - piece, R"([[fibre]]
length_m = 0.03
n_points = 6
density_kg_m3 = 1150
centre_m = [0.0, -0.5, 0.02]
[pipe_flow]
point_m = [0.3, 0.0, 0.0]
radius_m = 0.1
bend_radius_m = 0.3
bend_angle_rad = 1.5707963267948966
)");
  text.replace(text.find("velocity_m_s = [0.1, 0, 0]"), 26, "velocity_m_s = [0.1, 0.1, 0]");
  if (rank_of(MPI_COMM_WORLD) == 0) std::ofstream(folder_ / "pipe.toml") << text;
  MPI_Barrier(MPI_COMM_WORLD);
  for (OperatingPoint& point : experiment_.points) point.case_file = folder_ / "pipe.toml", point.input_u = {{"flow.amplitude", 0.05}};
  experiment_.own_candidates = {{.effect = {.name = "start_x"}, .key = "fibre.centre_m", .unit = 1, .direction = Vec3{1, 0, 0}}};
  CaseSimulator simulator(MPI_COMM_WORLD, experiment_);
  std::map<std::string, const Effect*> effects;
  for (const Effect& effect : simulator.effects()) effects[effect.name] = &effect;
  const auto base = values(simulator, RunRequest());
  for (const char* name : {"fibre_drag", "swirl", "flow_profile", "bend_vortices", "start_offset", "start_place", "start_spin"}) {
    EXPECT_EQ(effects.at(name)->blind, "") << name;
    EXPECT_EQ(values(simulator, with(name, 0)), base) << name;
    if (std::string(name) != "bend_vortices") {
      EXPECT_NE(values(simulator, with(name, effects.at(name)->mean)), base) << name;
    }
  }
  for (const char* name : {"averaging_length", "crumple_size"}) EXPECT_NE(effects.at(name)->blind, "") << name;
  RunRequest turbulent = with("flow_profile", 0.3);
  turbulent.forms = {{"flow_profile", 1}};
  EXPECT_EQ(effects.at("flow_profile")->n_forms, 2);
  EXPECT_EQ(simulator.change_of(with("flow_profile", 0.3)).overrides, std::vector<std::string>{"pipe_flow.profile=0.3"});
  EXPECT_EQ(simulator.change_of(turbulent).overrides, std::vector<std::string>{"pipe_flow.profile_power_law=0.3"});
  EXPECT_EQ(simulator.change_of(with("swirl", -0.2)).overrides, std::vector<std::string>{"pipe_flow.swirl=-0.2"});
  RunRequest both = with("start_offset", 0.01);
  both.effects["start_x"] = 0.02;
  const auto moved = simulator.change_of(both).overrides;  // before the bend its inside is on the side of x
  ASSERT_EQ(moved.size(), 1u);
  EXPECT_TRUE(moved[0].starts_with("fibre.0.centre_m=[0.03")) << moved[0];
}

/// Requirement: a run answers before the first sample of a path too, at its start and half-way: a clock that starts early looks there.
TEST_F(CaseSimulatorTest, AnswersBeforeTheFirstSample) {
  CaseSimulator simulator(MPI_COMM_WORLD, experiment_);
  std::vector<double> times;
  for (const Slot& slot : simulator.slots(0)) times.push_back(slot.time);
  EXPECT_EQ(times, (std::vector<double>{0, 0.01, 0.02, 0.05, 0.1}));
  const auto x = values(simulator, RunRequest());
  EXPECT_DOUBLE_EQ(x[0], 0.5);
  EXPECT_GT(x[1], x[0]);
  EXPECT_LT(x[1], x[2]);
}

/// Requirement: no run of a point has the seed of a run of another point.
TEST_F(CaseSimulatorTest, PointsHaveSeedsOfTheirOwn) {
  experiment_.seed = 7;
  const CaseSimulator simulator(MPI_COMM_WORLD, experiment_);
  RunRequest request = with("turbulent_dispersion", 1);
  std::set<std::vector<std::string>> changes;
  const std::uint64_t last = experiment_.seed + CaseSimulator::seeds_of_a_point - 1;
  for (request.point = 0; request.point < 2; ++request.point)
    for (request.seed = experiment_.seed; request.seed <= last; ++request.seed)
      EXPECT_TRUE(changes.insert(simulator.change_of(request).overrides).second) << request.point << ", " << request.seed;
  request.point = 0, request.seed = last + 1;
  EXPECT_THROW(static_cast<void>(simulator.change_of(request)), Error);
}

/// Requirement: a camera's scale multiplies lengths; a calibration shifts them by its uncertainty; neither takes a run of its own.
TEST_F(CaseSimulatorTest, Camera) {
  CaseSimulator simulator(MPI_COMM_WORLD, experiment_);
  const auto base = values(simulator, RunRequest());
  const int runs = simulator.n_runs();
  const auto scaled = values(simulator, with("measurement", 0.02)), shifted = values(simulator, with_input("camera", -2));
  for (std::size_t i = 0; i < base.size(); ++i) {
    EXPECT_DOUBLE_EQ(scaled[i], 1.02 * base[i]);
    EXPECT_DOUBLE_EQ(shifted[i], base[i] - 2e-3);
  }
  EXPECT_EQ(simulator.n_runs(), runs);
}

/// Requirement: an error of all set-points of the flow is what the same deviation of the whole flow field is.
TEST_F(CaseSimulatorTest, OperatingPointScalesTheFlow) {
  CaseSimulator simulator(MPI_COMM_WORLD, experiment_);
  EXPECT_EQ(values(simulator, with("operating_point", 0.1)), values(simulator, with_input("flow.amplitude", 0.1)));
}

/// Requirement: one set-point of the flow a point; one drag law everywhere; what is the same kind of sphere is half common, half each
/// point's own, and its whole variance is what was stated.
TEST_F(CaseSimulatorTest, SharesWhatIsTheSameThing) {
  const CaseSimulator simulator(MPI_COMM_WORLD, experiment_);
  std::map<std::string, int> count;
  std::array<double, 2> variance_of_density{};
  for (const Nuisance& nuisance : simulator.nuisances()) {
    ++count[nuisance.name + (nuisance.points.size() == 1 ? " of a point" : "")];
    if (nuisance.name == "particle.density_kg_m3")
      for (const int p : nuisance.points) variance_of_density[static_cast<std::size_t>(p)] += nuisance.u * nuisance.u;
  }
  EXPECT_EQ(count, (std::map<std::string, int>{{"flow.amplitude of a point", 2},
                                               {"particle.density_kg_m3", 1},
                                               {"particle.density_kg_m3 of a point", 2},
                                               {"drag_law_uncertainty", 1},
                                               {"drag_law_uncertainty.slope", 1},
                                               {"camera", 1}}));
  for (const double variance : variance_of_density) EXPECT_NEAR(std::sqrt(variance), 0.01, 1e-15);
}

/// Requirement: an error of the drag law that is each point's own is not shared, and changes the drag as the shared one does.
TEST_F(CaseSimulatorTest, TellsOwnFromSharedErrorOfTheDragLaw) {
  for (OperatingPoint& point : experiment_.points) point.input_u.emplace_back("drag_law_uncertainty_per_point", 0.05);
  CaseSimulator simulator(MPI_COMM_WORLD, experiment_);
  int own = 0;
  for (const Nuisance& nuisance : simulator.nuisances()) {
    if (nuisance.name != "drag_law_uncertainty_per_point") continue;
    ++own;
    EXPECT_EQ(nuisance.points.size(), 1u);
  }
  EXPECT_EQ(own, 2);
  EXPECT_EQ(values(simulator, with_input("drag_law_uncertainty_per_point", 0.1)),
            values(simulator, with_input("drag_law_uncertainty", 0.1)));
}

/// Requirement: two changes of one number multiply, whichever effect and input they come from.
TEST_F(CaseSimulatorTest, ChangesOfOneNumberMultiply) {
  for (auto& point : experiment_.points) point.input_u.emplace_back("flow.velocity_m_s", 0.05);
  CaseSimulator simulator(MPI_COMM_WORLD, experiment_);
  RunRequest both, once;
  both.nuisances = {{"flow.amplitude", 0.1}, {"flow.velocity_m_s", -0.1}};
  once.nuisances = {{"flow.amplitude", 0.1}};
  const PointCase base(folder_ / "case.toml");
  const auto change = base.change({}, both.nuisances, 0);
  EXPECT_EQ(std::count_if(change.overrides.begin(), change.overrides.end(),
                          [](const std::string& text) { return text.starts_with("flow.velocity_m_s="); }),
            1);
  EXPECT_NE(values(simulator, both), values(simulator, once));
  // The steady part is 1.1 x 0.9 of the base, the swinging one 1.1.
  RunRequest same;
  same.effects = {{"operating_point", -0.01}, {"flow_error", 1.1 / 0.99 - 1}};
  const auto a = values(simulator, both), b = values(simulator, same);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-9);
}

/// Requirement: a force that one point holds cannot be added; a random one of the base has the seed of the run.
TEST_F(CaseSimulatorTest, ForcesOfTheBase) {
  std::string text = swung_sphere;
  const std::string listed = "\"schiller_naumann\"";
  text.replace(text.find(listed), listed.size(), listed + ", \"added_mass\", \"turbulent_dispersion\"");
  if (rank_of(MPI_COMM_WORLD) == 0) std::ofstream(folder_ / "other.toml") << text;
  MPI_Barrier(MPI_COMM_WORLD);
  experiment_.points[1].case_file = folder_ / "other.toml";
  const CaseSimulator simulator(MPI_COMM_WORLD, experiment_);
  const auto& effects = simulator.effects();
  const auto mass = std::find_if(effects.begin(), effects.end(), [](const Effect& effect) { return effect.name == "added_mass"; });
  EXPECT_EQ(mass->blind, "the base case already contains it");
  const PointCase base(folder_ / "other.toml");
  const auto overrides = base.change({}, {}, 7).overrides;
  EXPECT_EQ(overrides, (std::vector<std::string>{"coupling.turbulent_dispersion.seed=7"}));
}

/// Requirement: uncertain inputs are found by their former names; former and present name of one input at a point contradict each other.
TEST_F(CaseSimulatorTest, ReadsFormerNamesOfInputs) {
  for (OperatingPoint& point : experiment_.points) {
    point.input_u.back().first = "drag_form";
    point.input_u.emplace_back("flow.omega_per_s", 0.01);
  }
  std::set<std::string> names;
  {
    const CaseSimulator simulator(MPI_COMM_WORLD, experiment_);
    for (const Nuisance& nuisance : simulator.nuisances()) names.insert(nuisance.name);
  }
  for (const char* name : {"drag_law_uncertainty", "drag_law_uncertainty.slope", "flow.angular_frequency_rad_s"})
    EXPECT_TRUE(names.contains(name)) << name;
  EXPECT_FALSE(names.contains("drag_form") || names.contains("flow.omega_per_s"));
  experiment_.points[0].input_u.emplace_back("drag_law_uncertainty", 0.05);
  EXPECT_THROW(CaseSimulator(MPI_COMM_WORLD, experiment_), Error);
}

/// Requirement: an uncertain drag law acts on the drag of a sheet, too, where that stands in for the drag of its particles: as the
/// candidate drag_magnitude does, and on top of it.
TEST_F(CaseSimulatorTest, DragLawOfASheetIsUncertain) {
  if (rank_of(MPI_COMM_WORLD) == 0)
    std::ofstream(folder_ / "case.toml") << R"(
[time]
end_s = 0.1
[flow]
kind = "prescribed"
density_kg_m3 = 1000
kinematic_viscosity_m2_s = 1e-6
velocity_m_s = [0.5, 0, 0]
[[rag]]
length_m = 0.03
width_m = 0.02
radius_m = 2e-3
centre_m = [0, 0, 0]
lengthwise = [0, 1, 0]
crosswise = [0, 0, 1]
[coupling]
mode = "one_way"
forces = ["recommended"]
)";
  MPI_Barrier(MPI_COMM_WORLD);
  for (OperatingPoint& point : experiment_.points) point.input_u = {{"drag_law_uncertainty", 0.2}};
  CaseSimulator simulator(MPI_COMM_WORLD, experiment_);
  const auto base = values(simulator, RunRequest());
  EXPECT_NE(values(simulator, with_input("drag_law_uncertainty", 0.2)), base);
  EXPECT_EQ(values(simulator, with_input("drag_law_uncertainty", 0.2)), values(simulator, with("drag_magnitude", 0.2)));
  RunRequest both = with("drag_magnitude", 0.5);
  both.nuisances["drag_law_uncertainty"] = 0.2;
  const auto twice = values(simulator, both), once = values(simulator, with("drag_magnitude", 0.8));
  for (std::size_t i = 0; i < base.size(); ++i) EXPECT_NEAR(twice[i], once[i], 1e-9 * std::abs(once[i]));
}

/// Requirement: candidates of the experiment file add to a number of the case, several of one key add up, a random one is another deviate
/// of the scatter theta in each run, and none leaves the base case as it is. In a uniform flow a path starts elsewhere and is the same.
TEST_F(CaseSimulatorTest, OwnCandidates) {
  const auto own = [](const char* name, const char* key, std::optional<Vec3> direction, bool random = false) {
    return OwnCandidate{
        {.name = name, .unit = "mm", .minimum = -100, .maximum = 100, .random = random}, key, 1e-3, direction, "[candidate]"};
  };
  experiment_.own_candidates = {own("start", "particle.position_m", Vec3{1, 0, 0}),
                                own("start_askew", "particle.position_m", Vec3{2, 1, 0}),
                                own("scatter", "particle.position_m", Vec3{1, 0, 0}, true), own("size", "particle.diameter_m", {})};
  CaseSimulator simulator(MPI_COMM_WORLD, experiment_);
  const auto base = values(simulator, RunRequest());
  EXPECT_EQ(values(simulator, with("start", 0)), base);
  RunRequest both = with("start", 4);
  both.effects["start_askew"] = 3;
  for (const auto& [request, shift] : {std::pair(with("start", 4), 4e-3), std::pair(both, 10e-3)}) {
    const auto moved = values(simulator, request);
    for (std::size_t i = 0; i < base.size(); ++i) EXPECT_NEAR(moved[i] - base[i], shift, 1e-12);
  }
  RunRequest scattered = with("scatter", 5);
  for (scattered.seed = 1; scattered.seed < 4; ++scattered.seed)
    EXPECT_NEAR(values(simulator, scattered)[0] - base[0], 5e-3 * even_normal_deviate(scattered.seed), 1e-12);
  EXPECT_NE(values(simulator, with("size", 1)), base);
  const auto refused = [&](const OwnCandidate& candidate) {
    experiment_.own_candidates = {candidate};
    try {
      const CaseSimulator again(MPI_COMM_WORLD, experiment_);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(refused(own("start", "particle.place_m", {})).find("\"particle.place_m\" is not a number of"), std::string::npos);
  EXPECT_NE(refused(own("start", "particle.position_m", {})).find("direction"), std::string::npos);
  EXPECT_NE(refused(own("start", "particle.diameter_m", Vec3{1, 0, 0})).find("is no vector"), std::string::npos);
  EXPECT_NE(refused(own("lift", "particle.diameter_m", {})).find("that of another candidate"), std::string::npos);
}

/// Requirement: an uncertain input that is no number of the case is refused by name.
TEST_F(CaseSimulatorTest, RefusesUnknownInputs) {
  experiment_.points[1].input_u.emplace_back("particle.colour", 0.1);
  EXPECT_THROW(CaseSimulator(MPI_COMM_WORLD, experiment_), Error);
}

}  // namespace
}  // namespace snag
