// ranks: 1 3
// Screens that sheets put to the turbulence of the water, through the whole coupled step.
#include <gtest/gtest.h>

#include "coupling/coupled_solver.hpp"
#include "parallel/sum.hpp"
#include "tests/structured_box.hpp"

namespace snag {
namespace {

constexpr double radius = 1e-3;  // m, of the particles of the sheet

/// Two steps of a sheet, one corner of it at a wall, and a sphere in water at rest. Sum over the cells of V s, m2; no value without
/// screens.
std::optional<double> screen_of_a_sheet(bool turbulent, const std::string& keys) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {0, 0, 0}, {0.06, 0.04, 0.08}, {12, 8, 16});
  Flow flow(mesh);
  if (turbulent) flow.turbulent_kinetic_energy.assign(static_cast<std::size_t>(mesh.n_all_cells()), 1e-3);
  RagSettings sheet(RagSettings::Shape::rag), sphere(RagSettings::Shape::particle);
  sheet.length = 40e-3, sheet.width = 30e-3, sheet.radius = radius;
  sheet.position = {0.03, 0.02, 0.045}, sheet.lengthwise = {0, 0.2, 1}, sheet.crosswise = {1, 0.3, 0};
  sphere.diameter = 3e-3, sphere.position = {0.01, 0.03, 0.01};
  RagSystem rags(MPI_COMM_WORLD, {}, {make_piece(sheet, "test"), make_piece(sphere, "test")});
  const std::string text =
      "[coupling]\nkernel_width_mm = 5\nforces = [\"free_stream_drag\", \"sheet_drag\"]\n[coupling.sheet_drag]\n" + keys;
  CoupledSolver solver(read_coupling(CaseFile::parse(text).root()), rags, flow, [](double) {});
  for (int n = 0; n < 2; ++n) solver.step(5e-4);
  if (sum(mesh.comm, static_cast<std::int64_t>(flow.screen.size())) == 0) return {};
  std::vector<double> terms;
  for (int c = 0; c < mesh.n_cells; ++c) terms.push_back(mesh.cell_volume[c] * flow.screen[c]);
  return sum(mesh.comm, std::span<const double>(terms));
}

// Requirement: the cells have the screens of all particles, sum over the cells of V s = sum over the particles of the sheet of
// theta A ((1 + K)^(1/2) - 1).
TEST(Screens, CellsHaveThoseOfTheParticles) {
  const double area = 20 * 15 * 4 * radius * radius;
  for (const auto& [keys, share] : {std::pair{"normal_coefficient = 3\n", 1.0}, {"normal_coefficient = 99\nshare = 0.25\n", 0.25 * 9}}) {
    const std::optional<double> found = screen_of_a_sheet(true, keys);
    ASSERT_TRUE(found) << keys;
    EXPECT_NEAR(*found, share * area, 1e-12 * share * area) << keys;
  }
}

// Requirement: laminar water has no screens, which nobody would read.
TEST(Screens, NoneInLaminarWater) { EXPECT_FALSE(screen_of_a_sheet(false, "normal_coefficient = 3\n")); }

}  // namespace
}  // namespace snag
