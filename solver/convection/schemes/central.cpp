// Linear interpolation, corrected for the skewness s of the face:   u_f^high = w u_P + (1 - w) u_N + G_f s
// w, G_f and s as in solver/fields/face.hpp. Not bounded: it oscillates where the Reynolds number of a cell is above 2.
// Source: Ferziger and Peric (2002), Computational Methods for Fluid Dynamics, section 4.4 (the number of
// the section is not checked against the book).
#include "solver/convection/face_scheme.hpp"

namespace snag {
namespace {

struct Central final : FaceScheme<Central> {
  static constexpr const char* name = "central";

  ConvectionDescription description() const override {
    return {"u_f interpolated linearly between C and D, not bounded", "Ferziger and Peric 2002", 2};
  }
  bool is_bounded() const override { return false; }
  static Vec3 high_order_part(ConvectedVelocity velocity, int f, double F) {
    const Mesh& mesh = velocity.mesh;
    const int P = mesh.owner[f], N = mesh.neighbour[f];
    const double w = mesh.weight[f];
    const Vec3 u_f = blend(w, velocity.u[P], velocity.u[N]) + blend(w, velocity.G[P], velocity.G[N]) * counted_skewness(mesh, f);
    return u_f - velocity.u[F > 0 ? P : N];
  }
};
const bool registered = convection_schemes().add<Central>();

}  // namespace
}  // namespace snag
