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
  void add_interior(const InteriorFaces& faces) const final {
    const Flow& flow = faces.flow;
    const Mesh& mesh = flow.mesh;
    const double rho = flow.density;
    for (int f = 0; f < mesh.n_interior; ++f) {
      const int P = mesh.owner[f], N = mesh.neighbour[f];
      const Vec3 &S = mesh.face_vector[f], &d = mesh.delta[f];
      const double F = rho * faces.flux[f], mu = flow.face_viscosity[f], c = conductance(S, d), D = mu * c;
      const double out = std::max(F, 0.0), in = std::max(-F, 0.0);
      faces.matrix.value[faces.matrix.place_of_owner[f]] = -in - D;
      faces.matrix.value[faces.matrix.place_of_neighbour[f]] = -out - D;
      const double from_owner = out + D, from_neighbour = in + D;
      faces.diagonal[P] += {from_owner, from_owner, from_owner};
      faces.diagonal[N] += {from_neighbour, from_neighbour, from_neighbour};

      Vec3 explicit_part = -F * Scheme::high_order_part({mesh, flow.velocity, faces.gradient, faces.psi}, f, F);
      const Mat3 G_f = blend(mesh.weight[f], faces.gradient[P], faces.gradient[N]);
      if (!flow.variable_viscosity)
        explicit_part += mu * (G_f * (S - c * d));
      else if (!faces.in_corner[P] && !faces.in_corner[N])
        explicit_part += mu * (G_f * (S - c * d) + transposed_product(G_f, S));
      faces.right_side[P] += explicit_part;
      faces.right_side[N] -= explicit_part;
    }
  }
};

}  // namespace snag
