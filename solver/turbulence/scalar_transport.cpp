// Assembly and solution of one equation; the scheme stands in the header.
//
// Second order where phi is smooth, by the limited linear scheme (solver/fields/face.hpp).
//
// Rows are divided by a_PP phi*_P, so that residuals are relative changes: epsilon differs by many powers of ten between wall and core.
#include "solver/turbulence/scalar_transport.hpp"

#include <algorithm>
#include <array>

#include "solver/fields/face.hpp"

namespace snag {

namespace {

std::vector<Side> sides(const Mesh& mesh, const BoundarySet& boundary, Side at_walls) {
  std::vector<Side> sides;
  for (std::size_t patch = 0; patch < mesh.patches.size(); ++patch) {
    const int p = static_cast<int>(patch);
    sides.push_back(boundary.is_wall(p) ? at_walls : boundary.velocity_is_given(p) ? Side::value : Side::slope);
  }
  return sides;
}

}  // namespace

ScalarTransport::ScalarTransport(const Mesh& mesh, const BoundarySet& boundary, Side at_walls, Workspace& workspace, int place)
    : mesh_(mesh),
      squares_(mesh, workspace.moments, sides(mesh, boundary, at_walls)),
      matrix_(workspace.matrix),
      diagonal_(workspace.scalar[0]),
      right_side_(workspace.scalar[1]),
      gradient_(workspace.vector.at(static_cast<std::size_t>(place))),
      known_(mesh.n_faces - mesh.n_interior) {
  for (std::size_t patch = 0; patch < mesh.patches.size(); ++patch) {
    const int p = static_cast<int>(patch);
    open_.push_back(boundary.is_open(p));
    velocity_is_given_.push_back(boundary.velocity_is_given(p));
  }
}

void ScalarTransport::mesh_turned() { squares_.update(); }

SweepReport ScalarTransport::solve(const ScalarHistory& history, const ScalarTerms& terms, const GivenCells& given,
                                   std::vector<double>& phi) {
  if (!gradient_is_new_) gradient(history.guess, terms.entering);
  gradient_is_new_ = false;
  start_rows(history, terms);
  add_interior(history.guess, terms.diffusivity);
  add_boundary(terms);
  scale_rows(history.guess, given);
  std::copy(history.guess.begin(), history.guess.end(), phi.begin());
  return solve_rows<double>(mesh_, matrix_, diagonal_, right_side_, phi, tolerance, max_sweeps, true);
}

const std::vector<Vec3>& ScalarTransport::gradient(std::span<const double> guess, std::span<const double> entering) {
  known_at_boundary(guess, entering);
  squares_.gradient(guess, known_, gradient_);
  gradient_is_new_ = true;
  return gradient_;
}

/// Values where fluid enters by a given velocity; elsewhere the slope zero, and at such a patch where it leaves, the value inside.
void ScalarTransport::known_at_boundary(std::span<const double> guess, std::span<const double> entering) {
  for (std::size_t p = 0; p < mesh_.patches.size(); ++p) {
    const bool by_value = squares_.side(p) == Side::value;
    for (int f = mesh_.patches[p].first; f < mesh_.patches[p].end(); ++f) {
      const int b = f - mesh_.n_interior;
      known_[b] = !by_value ? 0 : flux(f) < 0 ? entering[b] : guess[mesh_.owner[f]];
    }
  }
}

void ScalarTransport::start_rows(const ScalarHistory& history, const ScalarTerms& terms) {
  for (int c = 0; c < mesh_.n_cells; ++c) {
    const double V = mesh_.cell_volume[c];
    const bool collapsed = history.older[c] * time_.ratio > (1 + time_.ratio) * history.old[c];
    const TimeScheme time = collapsed ? TimeScheme{.dt = time_.dt} : time_;
    const double past = -V / time.dt * (time.old * history.old[c] + time.older * history.older[c]);
    diagonal_[c] = V * (time.now / time.dt + terms.sink[c]) + std::max(-past, 0.0) / history.guess[c];
    right_side_[c] = V * terms.production[c] + std::max(past, 0.0);
  }
}

/// Some faces at once: what they take from their cells, and what comes out of it. The loop between has neither addresses nor jumps, so that
/// the faces, with their four divisions each, go side by side.
struct ScalarTransport::FaceBlock {
  static constexpr int size = 8;
  using Values = std::array<double, size>;
  Values S_S{}, S_d{}, G_S{}, G_d{};        // of S and d with each other, and with the gradient G at the face
  Values owner{}, neighbour{}, change{};    // first guess, and its change from owner to neighbour
  Values slope_owner{}, slope_neighbour{};  // G.d of the cells
  Values weight{}, diffusivity{}, flux{};   // w, Gamma, F
  Values diffusion{}, out{}, in{}, beta{};  // D, max(F, 0), max(-F, 0), and beta of the header

  void find() {
    for (int k = 0; k < size; ++k) {
      const double c = S_S[k] / S_d[k], cross = G_S[k] - c * G_d[k], ratio = cross / change[k];
      diffusion[k] = diffusivity[k] * (c + (change[k] == 0 ? 0 : std::min(std::max(ratio, -c), c)));
      const bool forward = flux[k] > 0;
      const double way = forward ? 1 : -1, slope = forward ? slope_owner[k] : slope_neighbour[k],
                   upwind = forward ? owner[k] : neighbour[k];
      const double high = limited_linear(way * change[k], way * slope, forward ? 1 - weight[k] : weight[k]) / upwind;
      out[k] = std::max(flux[k], 0.0), in[k] = std::max(-flux[k], 0.0), beta[k] = 1 + std::min(high, 1.0);
    }
  }
};

void ScalarTransport::add_interior(std::span<const double> guess, std::span<const double> diffusivity) {
  FaceBlock block;
  for (int first = 0; first < mesh_.n_interior; first += FaceBlock::size) {
    const int n = std::min(FaceBlock::size, mesh_.n_interior - first);
    for (int k = 0; k < n; ++k) {
      const int f = first + k, P = mesh_.owner[f], N = mesh_.neighbour[f];
      const Vec3 &S = mesh_.face_vector[f], &d = mesh_.delta[f], &G_P = gradient_[P], &G_N = gradient_[N];
      const Vec3 G = blend(mesh_.weight[f], G_P, G_N);
      block.S_S[k] = dot(S, S), block.S_d[k] = dot(S, d), block.G_S[k] = dot(G, S), block.G_d[k] = dot(G, d);
      block.owner[k] = guess[P], block.neighbour[k] = guess[N], block.change[k] = guess[N] - guess[P];
      block.slope_owner[k] = dot(G_P, d), block.slope_neighbour[k] = dot(G_N, d);
      block.weight[k] = mesh_.weight[f], block.diffusivity[k] = diffusivity[f], block.flux[k] = flux(f);
    }
    block.find();
    for (int k = 0; k < n; ++k) {
      const int f = first + k;
      const double D = block.diffusion[k], out = block.out[k], in = block.in[k], beta = block.beta[k];
      matrix_.value[matrix_.place_of_owner[f]] = -(D + in * beta);
      matrix_.value[matrix_.place_of_neighbour[f]] = -(D + out * beta);
      diagonal_[mesh_.owner[f]] += D + in + out * (beta - 1);
      diagonal_[mesh_.neighbour[f]] += D + out + in * (beta - 1);
    }
  }
}

void ScalarTransport::add_boundary(const ScalarTerms& terms) {
  for (std::size_t p = 0; p < mesh_.patches.size(); ++p) {
    if (!open_[p]) continue;
    for (int f = mesh_.patches[p].first; f < mesh_.patches[p].end(); ++f) {
      if (!enters(p, f)) continue;
      const int P = mesh_.owner[f];
      const double D = velocity_is_given_[p] ? terms.diffusivity[f] * conductance(mesh_.face_vector[f], mesh_.delta[f]) : 0;
      const double in = D - flux(f);
      diagonal_[P] += in;
      right_side_[P] += in * terms.entering[f - mesh_.n_interior];
    }
  }
}

void ScalarTransport::scale_rows(std::span<const double> guess, const GivenCells& given) {
  for (int c = 0; c < mesh_.n_cells; ++c) {
    const double scale = 1 / (diagonal_[c] * guess[c]);
    diagonal_[c] *= scale, right_side_[c] *= scale;
    for (int k = matrix_.row_start[c]; k < matrix_.row_start[c + 1]; ++k) matrix_.value[k] *= scale;
  }
  for (std::size_t i = 0; i < given.cell.size(); ++i) {
    const int c = given.cell[i];
    right_side_[c] = diagonal_[c] * given.value[i];
    for (int k = matrix_.row_start[c]; k < matrix_.row_start[c + 1]; ++k) matrix_.value[k] = 0;
  }
}

}  // namespace snag
