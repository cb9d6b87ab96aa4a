// Sources of observables: every struct that an observable is read from has its file, and a source with its observables is one file.
#include "casework/observable_source.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>

#include "casework/case_run.hpp"
#include "casework/mesh_run.hpp"
#include "dem/particles/tile_particles.hpp"
#include "tests/sources.hpp"

namespace snag {
namespace {

/// A source as a file of casework/sources/ would have it, with two observables of a time and one of the whole run.
struct Energy {
  double kinetic = 0, potential = 0;  // J
};

Energy energy_of(const RagSystem& rags) {
  Energy sum;
  for (const Tile& tile : rags.tiles()) {
    const double m = rags.rags()[static_cast<std::size_t>(tile.rag)].mass;
    for_particles(tile, [&](int k, int, int) {
      const Vec3 v = tile.vector(Tile::vx, k);
      sum.kinetic += 0.5 * m * dot(v, v), sum.potential += m * 9.81 * tile.vector(Tile::x, k).z;
    });
  }
  return sum;
}

struct FileCount {
  int n = 0;
};

double kinetic(const Energy& energy) { return energy.kinetic; }
double total(const Energy& energy) { return energy.kinetic + energy.potential; }
double count(const FileCount& files) { return files.n; }

const bool energy_is_a_source =
    add_observable_source<Energy>({.in_memory = [](const RunInMemory& run) -> std::any { return energy_of(*run.simulation.rags); }});
const bool files_are_a_source =
    add_observable_source<FileCount>({.in_memory = [](const RunInMemory&) -> std::any { return FileCount{7}; },
                                      .in_folder = [](const std::filesystem::path& folder) -> std::any {
                                        if (!std::filesystem::exists(folder)) return {};
                                        return FileCount{static_cast<int>(std::distance(std::filesystem::directory_iterator(folder), {}))};
                                      }});
const bool their_observables =
    add_observables(1000, {{"kinetic_energy", "J", Measure::ratio, -1, kinetic, Needs::nothing, "of all pieces"},
                           {"energy", "J", Measure::ratio, -1, total, Needs::nothing, "of all pieces"},
                           {"n_files", "1", Measure::count, -1, count, Needs::nothing, "in the folder of the run"}});
constexpr int n_observables_here = 3, n_sources_here = 2;

constexpr const char* falling_sphere = R"(
[time]
end_s = 0.1
step_s = 1e-3
[gravity]
acceleration_m_s2 = [0, 0, -9.81]
[[particle]]
diameter_m = 5e-3
density_kg_m3 = 1150
position_m = [0, 0, 0]
)";

/// Requirement: the registry of sources is the folder, and every observable has its source.
TEST(ObservableSources, RegistryHoldsTheFolder) {
  EXPECT_EQ(observable_sources().size(), n_sources("casework/sources") + n_sources_here);
  for (const ObservableRecord& one : observables()) EXPECT_TRUE(observable_sources().contains(one.read.source())) << one.id;
}

/// Requirement: a run in memory answers an observable of a new source at the ends of steps and between them, and one of its whole run.
TEST(ObservableSources, ANewSourceIsReadInMemory) {
  const double mass = 1150 * 4. / 3 * std::acos(-1.) * std::pow(2.5e-3, 3);
  const auto seen =
      run_in_memory(CaseFile::parse(falling_sphere),
                    {{"kinetic_energy", 0.05}, {"energy", 0.05}, {"kinetic_energy", 0.0505}, {"kinetic_energy", 0.051}, {"n_files"}});
  const double v = 9.81 * 0.05;
  EXPECT_NEAR(seen[0], 0.5 * mass * v * v, 1e-3 * 0.5 * mass * v * v);
  EXPECT_LT(std::abs(seen[1]), 0.03 * seen[0]);  // its step is first order in the place
  EXPECT_NEAR(seen[2], 0.5 * (seen[0] + seen[3]), 1e-12 * seen[0]);
  EXPECT_GT(seen[3], 1.01 * seen[0]);
  EXPECT_EQ(seen[4], 7);
}

/// Requirement: the force of a hold on what hangs from it is its weight, and runs without a hold have none.
TEST(ObservableSources, ForceOfAHold) {
  const double mass = 1150 * 4. / 3 * std::acos(-1.) * std::pow(2.5e-3, 3);
  const std::string held = std::string(falling_sphere) + "[[hold]]\nparticles = [0]\n";
  const auto seen = run_in_memory(CaseFile::parse(held), {{"force_x", 0.05}, {"force_z", 0.05}});
  EXPECT_NEAR(seen[0], 0, 1e-12 * mass);
  EXPECT_NEAR(seen[1], 9.81 * mass, 1e-9 * mass);
  EXPECT_TRUE(std::isnan(run_in_memory(CaseFile::parse(falling_sphere), {{"force_z", 0.05}})[0]));
}

/// Requirement: of a run in a folder, what the camera sees is without a time the mean over the time in its window; a monitor that has
/// nothing to do with the camera is the mean over the last half. Angles are averaged as axes.
TEST(ObservableSources, MeansInAFolderAreThoseOfTheWindow) {
  const auto folder = std::filesystem::temp_directory_path() / "snag_window";
  std::filesystem::create_directories(folder / "monitors");
  std::ofstream(folder / "monitors" / "rags.csv") << "time [s],rag [1],x [m],y [m],z [m],vz [m/s]\n0,0,0,0,0,1\n0,1,9,9,9,50\n"
                                                     "1,0,0.1,0,0,2\n2,0,0.2,0,0,4\n3,0,0.3,0,0,8\n4,0,0.4,0,0,16\n";
  std::ofstream(folder / "monitors" / "silhouettes.csv") << "time [s],rag [1],orientation [rad]\n0,0,0\n1,0,1.5\n2,0,-1.5\n4,0,0\n";
  std::ofstream(folder / "monitors" / "pump.csv") << "time [s],head [m]\n0,1\n1,2\n2,3\n3,5\n4,7\n";
  ObserveSettings camera;
  camera.window_lower = {0.05, -1, -1}, camera.window_upper = {0.25, 1, 1};
  const auto seen = read_observables(folder, {{"vz"}, {"orientation"}, {"head"}}, camera);
  EXPECT_NEAR(seen[0], 3, 1e-12);
  EXPECT_NEAR(std::abs(seen[1]), std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(seen[2], 5, 1e-12);
  EXPECT_NEAR(read_observables(folder, {{"vz"}}, {}).front(), 28.0 / 3, 1e-12);
  std::filesystem::remove_all(folder);
}

/// Requirement: a rag that has not come yet, or has left, has no silhouette; an axis turns on between two samples, and its mean is that of
/// axes.
TEST(ObservableSources, SilhouettesInAFolder) {
  const auto folder = std::filesystem::temp_directory_path() / "snag_silhouettes";
  std::filesystem::create_directories(folder / "monitors");
  std::ofstream(folder / "monitors" / "silhouettes.csv")
      << "time [s],rag [1],area [m2],elongation_ratio [1],orientation [rad]\n0,0,0,0,0\n1,0,2,3,1.5\n2,0,4,5,-1.5\n3,0,0,0,0\n";
  const auto seen = read_observables(
      folder, {{"area"}, {"orientation"}, {"area", 0.5}, {"area", 1.5}, {"area", 2.5}, {"orientation", 1.5}, {"elongation_ratio", 1}}, {});
  EXPECT_NEAR(seen[0], 3, 1e-12);
  EXPECT_NEAR(std::abs(seen[1]), std::numbers::pi / 2, 1e-12);
  EXPECT_TRUE(std::isnan(seen[2]));
  EXPECT_NEAR(seen[3], 3, 1e-12);
  EXPECT_TRUE(std::isnan(seen[4]));
  EXPECT_NEAR(std::abs(seen[5]), std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(seen[6], 3, 1e-12);
  std::filesystem::remove_all(folder);
}

/// Requirement: a run in a folder answers an observable of the whole run by the source's own function, not a number where the run lacks it.
TEST(ObservableSources, ANewSourceIsReadInAFolder) {
  const auto folder = std::filesystem::temp_directory_path() / "snag_observable_sources";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "one"), std::ofstream(folder / "two");
  EXPECT_EQ(read_observables(folder, {{"n_files"}}, {}).front(), 2);
  EXPECT_TRUE(std::isnan(read_observables(folder, {{"exited"}}, {}).front()));
  std::filesystem::remove_all(folder);
  EXPECT_TRUE(std::isnan(read_observables(folder, {{"n_files"}}, {}).front()));
}

/// Requirement: the tutorial on the diagnosis names every observable.
TEST(ObservableSources, TutorialNamesTheirObservables) {
  std::ifstream file(in_sources("docs/tutorial-diagnosis.md"));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  int n_missing = 0;
  for (const ObservableRecord& one : observables())
    if (text.find("| `" + std::string(one.id) + "` |") == std::string::npos) ++n_missing;
  EXPECT_EQ(n_missing, n_observables_here);
}

}  // namespace
}  // namespace snag
