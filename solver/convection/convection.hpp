#pragma once
// Convection schemes of the momentum equation: one scheme, one file in solver/convection/schemes/, chosen by [flow] convection = "...".
//
//   F u_f = F u_C + F (u_f^high - u_C)        C: the cell upwind of the face
//
// The first part is implicit and the same for all schemes. A scheme says what u_f^high - u_C is, from the guess of the velocity; that part
// is explicit. Which scheme it is, is decided once for all faces of an assembly, never once a face (solver/convection/face_scheme.hpp).
#include <span>
#include <string>
#include <vector>

#include "base/registry.hpp"
#include "solver/fields/flow.hpp"
#include "solver/operators/cell_matrix.hpp"

namespace snag {

/// What a scheme takes the value at a face from; as in FaceInputs.
struct ConvectedVelocity {
  const Mesh& mesh;
  std::span<const Vec3> u;    // m/s
  std::span<const Mat3> G;    // 1/s
  std::span<const Vec3> psi;  // 1
};

/// What the interior faces of the momentum equation read.
struct FaceInputs {
  const Flow& flow;                            // density, viscosity of the faces
  const std::vector<Vec3>& guess;              // of the velocity, [n_all_cells], m/s
  const std::vector<double>& flux;             // F, relative to the mesh, [n_faces], m3/s
  const std::vector<Mat3>& gradient;           // G of the guess, [n_all_cells], 1/s
  const std::vector<Mat3>& reconstruction;     // what a scheme takes for G (TetrahedronReconstruction), [n_all_cells], 1/s
  const std::vector<Vec3>& psi;                // factor of each row of G by the limiter, [n_all_cells]; 1 where the scheme takes none
  const std::vector<std::uint8_t>& in_corner;  // [n_all_cells] 1 for cells that take no explicit viscous stress
};

/// The rows that they add to.
struct MomentumRows {
  CellMatrix& matrix;                       // kg/s
  std::vector<Vec3>&diagonal, &right_side;  // [n_all_cells], kg/s and N
};

/// Momentum that passes an interior face from the owner to the neighbour, N: carried by the water, and by friction.
struct MomentumFlux {
  Vec3 convection, friction;
};

/// What a scheme is, for the manual.
struct ConvectionDescription {
  std::string equation, source;
  int order = 0;  // of accuracy where the velocity is smooth
};

class ConvectionScheme {
 public:
  virtual ~ConvectionScheme() = default;
  virtual ConvectionDescription description() const = 0;
  /// True if the scheme takes its gradients times the factors of the limiter.
  virtual bool is_limited() const { return false; }
  /// True if no value at a face lies beyond those of the cells around it; of a limited scheme: with a limiter that bounds.
  virtual bool is_bounded() const = 0;
  /// Convection and diffusion through the interior faces. Local.
  virtual void add_interior(const FaceInputs& faces, const MomentumRows& rows) const = 0;
  /// The same as fluxes of the faces first, first + 1 ... with the solution u of the rows, [n_all_cells]. Local.
  virtual void fluxes(const FaceInputs& faces, const std::vector<Vec3>& u, int first, std::span<MomentumFlux> flux) const = 0;
};

Registry<ConvectionScheme>& convection_schemes();
/// Meaning of the key `convection`, with what each scheme is.
std::string convection_meaning();

}  // namespace snag
