// Limiter of Venkatakrishnan on the vector of velocity instead of its components:
//
//   a = |G (x_f - x_P)|,   e = G (x_f - x_P)/a,   b = max (u_N - u_P).e over the neighbours N, at least 0,   psi of a and b as in
//   venkatakrishnan.hpp
//
// The minimum over the faces is the factor of all components: the flow does not depend on how the coordinates lie, as it does with a factor
// of each component. The velocity at a face stays within what the neighbours have along its change, not within the range of each component.
//
// That a vector should be limited by the velocities of the neighbours as vectors: Luttwak and Falcovitz (2011), Int. J. Numer. Methods
// Fluids 65, 1365, from memory; they take the hull of these velocities. The law along the change is this program's.
#include <vector>

#include "mesh/geometry.hpp"
#include "solver/convection/cell_limiter.hpp"
#include "solver/convection/limiters/venkatakrishnan.hpp"

namespace snag {
namespace {

struct VectorVenkatakrishnan final : Limiter {
  static constexpr const char* name = "vector_venkatakrishnan";

  LimiterDescription description() const override {
    return {
        "the psi of venkatakrishnan along the vector of the change to a face, the same for all components, so that the flow does not "
        "depend on how the coordinates lie",
        "after Luttwak and Falcovitz 2011"};
  }

  void limit(const LimiterInputs& inputs, std::vector<Vec3>& psi) const override {
    const auto& [mesh, has_periods, u, G, reference_speed, ranges] = inputs;
    const double per_volume = venkatakrishnan_threshold(mesh, reference_speed);
    std::vector<Vec3> differences;
    for (int c = 0; c < mesh.n_cells; ++c) {
      const std::span<const int> faces = row(mesh.cell_face_start, mesh.cell_face, c);
      differences.clear();
      for (const int f : faces)
        if (f < mesh.n_interior) differences.push_back(weight_in_cell(mesh, f, c) * (u[mesh.owner[f] + mesh.neighbour[f] - c] - u[c]));
      double smallest = 1;
      for (const int f : faces) {
        if (f >= mesh.n_interior) continue;
        const Vec3 change = G[c] * way_to_face(mesh, has_periods, c, f);
        const double a = norm(change);
        if (a == 0) continue;
        double b = 0;
        for (const Vec3& difference : differences) b = std::max(b, dot(difference, change) / a);
        const double factor = std::min(1.0, venkatakrishnan_factor(a, b, per_volume * mesh.cell_volume[c]));
        smallest = std::min(smallest, 1 - weight_in_cell(mesh, f, c) * (1 - factor));
      }
      psi[c] = {smallest, smallest, smallest};
    }
    mesh.halo.exchange(psi);
  }
};
const bool registered = limiters().add<VectorVenkatakrishnan>();

}  // namespace
}  // namespace snag
