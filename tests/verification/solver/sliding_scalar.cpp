// ranks: 1 2
// long ranks: 3
#include <gtest/gtest.h>

#include "solver/turbulence/scalar_transport.hpp"
#include "tests/verification/solver/turning_rings.hpp"

using namespace snag;
using namespace snag::test;

namespace {

const Vec3 stream{1, -0.4, 0.3};                             // m/s
constexpr double speed = 50, dt = 2e-3, diffusivity = 1e-4;  // rad/s, s, m2/s
constexpr int steps = 40;

/// A scalar in a uniform stream through turning rings with a lid; what enters has the value `entering`.
class CarriedScalar {
 public:
  CarriedScalar(bool tetrahedra, const std::function<double(const Vec3&)>& start, double entering)
      : shells_{.rotor = {14, 2, 3}, .stator = {17, 3, 4}, .tetrahedra = tetrahedra},
        mesh_(ring_mesh(shells_)),
        solver_(make_solver()),
        workspace_(mesh_),
        transport_(mesh_, solver_->boundary(), Side::slope, workspace_, 0),
        entering_(mesh_.n_faces - mesh_.n_interior, entering),
        zero_(mesh_.n_cells) {
    for (int c = 0; c < mesh_.n_all_cells(); ++c) phi.push_back(start(mesh_.cell_centre[c]));
    old_ = older_ = phi;
    transport_.tolerance = 1e-15;
  }

  /// One step with `guesses` solutions, each the first guess of the next.
  void advance(int guesses) {
    time_ = bdf(dt, solver_->flow.time_step > 0 ? dt : 0);
    solver_->advance(dt);
    older_ = old_, old_ = phi;
    workspace_.mesh_turned(mesh_), transport_.mesh_turned();
    transport_.begin(solver_->flow, time_);
    const std::vector<double> gamma(mesh_.n_faces, diffusivity);
    for (int i = 0; i < guesses; ++i) {
      const std::vector<double> guess = phi;
      transport_.solve({old_, older_, guess}, {zero_, zero_, gamma, entering_}, {}, phi);
    }
  }
  /// Change of the scalar's content in the step, by the formula of the scheme, and what came in through the boundary.
  double gained() const {
    double total = 0;
    for (int c = 0; c < mesh_.n_cells; ++c)
      total += mesh_.cell_volume[c] * (time_.now * phi[c] + time_.old * old_[c] + time_.older * older_[c]);
    return sum(mesh_.comm, total);
  }
  double entered() const {
    double total = 0;
    for (int f = mesh_.n_interior; f < mesh_.n_faces; ++f) {
      const double F = solver_->flow.flux[f] - solver_->flow.mesh_flux[f], inside = phi[mesh_.owner[f]];
      const Vec3 &S = mesh_.face_vector[f], &d = mesh_.delta[f];
      const double given = entering_[f - mesh_.n_interior];
      total -= dt * (F < 0 ? F * given - diffusivity * norm_squared(S) / dot(S, d) * (given - inside) : F * inside);
    }
    return sum(mesh_.comm, total);
  }
  double content() const {
    double total = 0;
    for (int c = 0; c < mesh_.n_cells; ++c) total += mesh_.cell_volume[c] * phi[c];
    return sum(mesh_.comm, total);
  }
  double largest_difference(double value) const {
    double worst = 0;
    for (int c = 0; c < mesh_.n_all_cells(); ++c) worst = std::max(worst, std::abs(phi[c] - value));
    return maximum(mesh_.comm, worst);
  }
  std::vector<double> phi;  // [n_all_cells]

 private:
  std::unique_ptr<FlowSolver> make_solver() {
    auto zone = turning_rotor(mesh_, shells_, speed);
    std::vector<PatchBoundary> boundary;
    for (const Patch& patch : mesh_.patches)
      add_exact(
          boundary, patch.name, [](const Vec3&, double) { return stream; }, true);
    FlowSettings settings = sharp_settings();
    settings.initial_velocity = stream;
    return std::make_unique<FlowSolver>(mesh_, settings, std::move(boundary), nullptr, std::move(zone));
  }
  Shells shells_;
  Mesh mesh_;
  std::unique_ptr<FlowSolver> solver_;
  Workspace workspace_;
  ScalarTransport transport_;
  std::vector<double> entering_, zero_, old_, older_;
  TimeScheme time_;
};

}  // namespace

// What a scalar gains is what came in through the boundary: nothing is made or lost at the interface.
TEST(SlidingScalar, is_conserved) {
  const auto blob = [](const Vec3& x) { return 1 + std::exp(-norm_squared(x - Vec3{-0.045, 0.01, 0.03}) / (0.02 * 0.02)); };
  for (const bool tetrahedra : {false, true}) {
    SCOPED_TRACE(tetrahedra);
    CarriedScalar scalar(tetrahedra, blob, 1);
    const double content = scalar.content();
    double worst = 0, exchanged = 0;
    for (int i = 0; i < steps / 2; ++i) {
      scalar.advance(25);
      worst = std::max(worst, std::abs(scalar.gained() - scalar.entered()) / content);
      exchanged = std::max(exchanged, std::abs(scalar.entered()) / content);
    }
    if (rank_of(MPI_COMM_WORLD) == 0) std::printf("scalar lost in a step, of all: %.1e; came in: %.1e\n", worst, exchanged);
    EXPECT_LT(worst, 1e-12);
    EXPECT_GT(exchanged, 1e-4) << "the blob must leave, else the test shows nothing";
  }
}

// A constant stays constant.
TEST(SlidingScalar, stays_constant) {
  CarriedScalar scalar(
      true, [](const Vec3&) { return 3.0; }, 3);
  for (int i = 0; i < steps; ++i) scalar.advance(1);
  EXPECT_LT(scalar.largest_difference(3), 1e-11);
}
