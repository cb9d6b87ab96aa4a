#include "solver/turbulence/curvature.hpp"

#include <algorithm>
#include <cmath>

#include "solver/fields/rotating_zone.hpp"

namespace snag {

namespace {

constexpr double largest_factor = 1.25;

Mat3 symmetric(const Vec3& diagonal, const Vec3& off) {
  return {Vec3{diagonal.x, off.z, off.y}, Vec3{off.z, diagonal.y, off.x}, Vec3{off.y, off.x, diagonal.z}};
}

}  // namespace

void Curvature::Strain::find(const std::vector<Mat3>& gradient) {
  diagonal.resize(gradient.size()), off.resize(gradient.size());
  for (std::size_t c = 0; c < gradient.size(); ++c) {
    const Mat3& G = gradient[c];
    diagonal[c] = {G[0].x, G[1].y, G[2].z};
    off[c] = 0.5 * Vec3{G[1].z + G[2].y, G[0].z + G[2].x, G[0].y + G[1].x};
  }
}

void Curvature::prepare(const Mesh& mesh, const CellMoments& moments) {
  slope_.emplace(mesh, moments, std::vector<Side>(mesh.patches.size(), Side::none));
  nothing_.assign(static_cast<std::size_t>(mesh.n_faces - mesh.n_interior), {});
  slope_of_diagonal_.resize(static_cast<std::size_t>(mesh.n_all_cells())), slope_of_off_.resize(slope_of_diagonal_.size());
}

void Curvature::begin_step(const Flow& flow) { before_.find(flow.velocity_gradient); }

void Curvature::find(const Flow& flow, double dt, std::span<const double> omega, std::vector<double>& factor) {
  const Mesh& mesh = flow.mesh;
  now_.find(flow.velocity_gradient);
  slope_->gradient(std::span<const Vec3>(now_.diagonal), nothing_, slope_of_diagonal_);
  slope_->gradient(std::span<const Vec3>(now_.off), nothing_, slope_of_off_);
  const RotatingZone* zone = flow.rotating_zone;
  const Vec3 turn = zone ? zone->rotation_speed(flow.time) : Vec3{};
  factor.resize(std::max(factor.size(), static_cast<std::size_t>(mesh.n_cells)));
  for (int c = 0; c < mesh.n_cells; ++c) {
    const bool turns = zone && mesh.cell_zone[c] == zone->zone();
    const Vec3 way = flow.velocity[c] - (turns ? cross(turn, mesh.cell_centre[c] - zone->origin()) : Vec3{});
    const Mat3& G = flow.velocity_gradient[c];
    const Mat3 S = symmetric(now_.diagonal[c], now_.off[c]);
    Mat3 rate = symmetric((1 / dt) * (now_.diagonal[c] - before_.diagonal[c]) + slope_of_diagonal_[c] * way,
                          (1 / dt) * (now_.off[c] - before_.off[c]) + slope_of_off_[c] * way);
    if (turns && !zone->slides())
      for (int i = 0; i < 3; ++i) {
        const Vec3 column = cross(turn, S[i]);  // T S e_i; S T is its transpose with the other sign
        for (int j = 0; j < 3; ++j) rate[i][j] += column[j], rate[j][i] += column[j];
      }
    double strain_squared = 0, spin_squared = 0, product = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        double turned = 0;  // W_ik S_jk
        for (int k = 0; k < 3; ++k) turned += 0.5 * (G[i][k] - G[k][i]) * S[j][k];
        const double W = 0.5 * (G[i][j] - G[j][i]);
        strain_squared += 2 * S[i][j] * S[i][j], spin_squared += 2 * W * W;
        product += 2 * turned * rate[i][j];
      }
    const double W = std::sqrt(spin_squared),
                 D_squared = std::max(strain_squared, 0.09 * omega[static_cast<std::size_t>(c)] * omega[static_cast<std::size_t>(c)]);
    // Without rotation nothing curves: r* goes to infinity and r~ to zero.
    const double ratio = strain_squared > 0 ? 1 / (1 + W / std::sqrt(strain_squared)) : 0;  // r*/(1 + r*)
    const double curving = W > 0 && D_squared > 0 ? product / (W * D_squared * std::sqrt(D_squared)) : 0;
    factor[c] = std::clamp((1 + c_r1) * 2 * ratio * (1 - c_r3 * std::atan(c_r2 * curving)) - c_r1, 0.0, largest_factor);
  }
}

}  // namespace snag
