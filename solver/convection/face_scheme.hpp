#pragma once
// The loop over the interior faces of the momentum equation, compiled for one convection scheme.
#include <algorithm>

#include "solver/convection/convection.hpp"
#include "solver/fields/face.hpp"

namespace snag {

/// A scheme that gives the value of one face by itself. `Scheme` has
///   static Vec3 high_order_part(ConvectedVelocity, int f, double F)
/// u_f^high - u_C of face f, m/s. F: flux of mass from the owner to the neighbour, kg/s; C is the owner where F > 0.
/// The spans go by value: the compiler then has them in registers, and the loop is as fast as one written for the scheme.
template <class Scheme>
class FaceScheme : public ConvectionScheme {
 public:
  void add_interior(const FaceInputs& faces, const MomentumRows& rows) const final {
    const Mesh& mesh = faces.flow.mesh;
    for (int f = 0; f < mesh.n_interior; ++f) {
      const int P = mesh.owner[f], N = mesh.neighbour[f];
      const double F = faces.flow.density * faces.flux[f], c = conductance(mesh.face_vector[f], mesh.delta[f]);
      const double D = faces.flow.face_viscosity[f] * c, out = std::max(F, 0.0), in = std::max(-F, 0.0);
      rows.matrix.value[rows.matrix.place_of_owner[f]] = -in - D;
      rows.matrix.value[rows.matrix.place_of_neighbour[f]] = -out - D;
      const double from_owner = out + D, from_neighbour = in + D;
      rows.diagonal[P] += {from_owner, from_owner, from_owner};
      rows.diagonal[N] += {from_neighbour, from_neighbour, from_neighbour};

      const MomentumFlux flux = explicit_flux(faces, f, F, c);
      const Vec3 flux_of_both = flux.convection + flux.friction;
      rows.right_side[P] -= flux_of_both;
      rows.right_side[N] += flux_of_both;
    }
  }

  void fluxes(const FaceInputs& faces, const std::vector<Vec3>& u, int first, std::span<MomentumFlux> flux) const final {
    const Mesh& mesh = faces.flow.mesh;
    for (std::size_t i = 0; i < flux.size(); ++i) {
      const int f = first + static_cast<int>(i), P = mesh.owner[f], N = mesh.neighbour[f];
      const double F = faces.flow.density * faces.flux[f], c = conductance(mesh.face_vector[f], mesh.delta[f]);
      flux[i] = explicit_flux(faces, f, F, c);
      flux[i].convection += F * u[F > 0 ? P : N];
      flux[i].friction -= faces.flow.face_viscosity[f] * c * (u[N] - u[P]);
    }
  }

 private:
  /// Part of the flux that is known from the guess.
  [[gnu::always_inline]] static MomentumFlux explicit_flux(const FaceInputs& faces, int f, double F, double c) {
    const Flow& flow = faces.flow;
    const Mesh& mesh = flow.mesh;
    const int P = mesh.owner[f], N = mesh.neighbour[f];
    const Vec3 &S = mesh.face_vector[f], &d = mesh.delta[f];
    const double mu = flow.face_viscosity[f];
    MomentumFlux flux{.convection = F * Scheme::high_order_part({mesh, faces.guess, faces.reconstruction, faces.psi}, f, F),
                      .friction = {}};
    const Mat3 G = blend(mesh.weight[f], faces.gradient[P], faces.gradient[N]);
    if (!flow.variable_viscosity)
      flux.friction -= mu * (G * (S - c * d));
    else if (!faces.in_corner[P] && !faces.in_corner[N])
      flux.friction -= mu * (G * (S - c * d) + transposed_product(G, S));
    return flux;
  }
};

}  // namespace snag
