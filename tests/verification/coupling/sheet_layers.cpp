// Friction of boundary layers along a sheet: plates of laminar and turbulent flow, in a prescribed stream.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "coupling/coupled_solver.hpp"

namespace snag {
namespace {

struct Plate {
  double length = 0.1, width = 0.08, radius = 1e-3;  // m
  double degrees = 0;                                // of the stream to the length, in the plane
};

/// Drag along the stream over that of the area times rho U^2/2, both sides together.
double friction(const Plate& plate, double Re, const std::string& more = "") {
  RagSettings settings(RagSettings::Shape::rag);
  settings.length = plate.length, settings.width = plate.width, settings.radius = plate.radius;
  RagSystem rags(MPI_COMM_SELF, {}, {make_piece(settings, "test")});
  PrescribedFlow flow;
  flow.dynamic_viscosity = 1e-6 * flow.density;
  const double angle = plate.degrees * std::numbers::pi / 180, U = Re * 1e-6 / plate.length;
  const Vec3 stream{std::cos(angle), std::sin(angle), 0};
  flow.velocity = U * stream;
  CoupledSolver solver(
      read_coupling(CaseFile::parse("[coupling]\nforces = [\"sheet_drag\"]\n[coupling.sheet_drag]\nform = \"viscous\"\n" + more).root(),
                    false),
      rags, flow);
  rags.clamp([](std::int64_t) { return true; });
  solver.step(1e-6);
  return dot(solver.report().force_on_rags, stream) / (0.5 * flow.density * U * U * plate.length * plate.width);
}

// Requirement: both sides together have twice the mean friction of a laminar plate, whatever the radius of the particles, along rows and
// along columns.
TEST(SheetLayers, LaminarPlate) {
  for (const double Re : {1e3, 1e4, 1e5}) {
    const double exact = 2 * (1.328 / std::sqrt(Re) + 2.67 * std::pow(Re, -7.0 / 8));
    for (const double radius : {1e-3, 2e-3}) EXPECT_NEAR(friction({.radius = radius}, Re), exact, 1e-3 * exact) << Re;
    EXPECT_NEAR(friction({.length = 0.08, .width = 0.1, .degrees = 90}, 0.8 * Re), exact, 1e-3 * exact) << "the water runs along the width";
  }
}

// Requirement: layers that are turbulent from the edge on have the friction 0.074/Re^(1/5) on each side, and one that turns turbulent on
// its way lies between.
TEST(SheetLayers, TurbulentPlate) {
  const double Re = 1e6, turbulent = 2 * 0.074 * std::pow(Re, -0.2), laminar = 2 * 1.328 / std::sqrt(Re);
  EXPECT_NEAR(friction({}, Re, "transition_reynolds = 0\n"), turbulent, 1e-3 * turbulent);
  const double between = friction({}, Re);
  EXPECT_GT(between, laminar);
  EXPECT_LT(between, turbulent);
}

// Requirement: a stream across the corner of a sheet has the friction of strips that begin at the edges it comes from.
TEST(SheetLayers, ObliqueStream) {
  const double Re = 1e4, degrees = 30, angle = degrees * std::numbers::pi / 180, length = 0.1, width = 0.08;
  double sum = 0;
  const int n = 400;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double x = std::min((i + 0.5) / n * length / std::cos(angle), (j + 0.5) / n * width / std::sin(angle)), Re_x = Re * x / length;
      sum += 0.664 / std::sqrt(Re_x) + 2.67 / 8 * std::pow(Re_x, -7.0 / 8);
    }
  const double strips = 2 * sum / (n * n);
  EXPECT_NEAR(friction({.degrees = degrees}, Re), strips, 0.02 * strips);
}

// Requirement: across itself in creeping flow a sheet has the drag of the disc of its area, 16 mu a U (Lamb 1932, section 339), whatever
// the radius of its particles.
TEST(SheetLayers, SlowFlowAcross) {
  for (const double radius : {1e-3, 2e-3}) {
    RagSettings settings(RagSettings::Shape::rag);
    settings.length = 0.1, settings.width = 0.08, settings.radius = radius;
    RagSystem rags(MPI_COMM_SELF, {}, {make_piece(settings, "test")});
    PrescribedFlow flow;
    const double viscosity = 1, U = 1e-6;  // Pa s, m/s
    flow.dynamic_viscosity = viscosity;
    flow.velocity = {0, 0, U};
    CoupledSolver solver(
        read_coupling(CaseFile::parse("[coupling]\nforces = [\"sheet_drag\"]\n[coupling.sheet_drag]\nform = \"viscous\"\n").root(), false),
        rags, flow);
    rags.clamp([](std::int64_t) { return true; });
    solver.step(1e-6);
    const double exact = 16 * viscosity * std::sqrt(settings.length * settings.width / std::numbers::pi) * U;
    EXPECT_NEAR(solver.report().force_on_rags.z, exact, 2e-3 * exact);  // 20.4 for 64/pi
  }
}

}  // namespace
}  // namespace snag
