#pragma once
// Turbulence models: one model, one file in solver/turbulence/models/, chosen by [turbulence] model = "...".
//
// What a model transports, and how it treats walls, is its own affair (scalar_transport.hpp, wall_functions.hpp are there to be used). What
// others read of turbulence is the same for all models, and each fills it: flow.turbulent_kinetic_energy, dissipation_rate (a model of k
// and omega: epsilon = C_mu k omega) and eddy_viscosity, y_plus and wall_function; forces on rags, field files and monitors take them from
// there. Among stored() there are "k" and "epsilon": a run may start from the water of another model.
//
// A model gives the momentum equation the viscosity of the faces, mu + mu_t, with the shear of wall functions at walls; flow.pressure then
// holds p + 2/3 rho k. Within a step it follows each correction of velocity and pressure: with one outer correction mu_t is that of the
// last step (first order in time where the turbulence changes), with more it is of the present one.
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "solver/boundaries/boundary.hpp"
#include "solver/fields/time_scheme.hpp"
#include "solver/operators/workspace.hpp"

namespace snag {

/// What a model did in one correction.
struct TurbulenceReport {
  struct Equation {
    std::string symbol;  // of what it transports: "k", "epsilon"
    SweepReport sweeps;
  };
  std::vector<Equation> equations;
  std::int64_t raised_cells = 0;  // where one of them was below what can be computed with, and was raised: none in a sound run
  double largest_viscosity = 0;   // mu_t / mu, the largest of all cells

  /// Of the equation of this symbol; that of nothing to solve if the model has none.
  SweepReport of(std::string_view symbol) const;
  int sweeps() const;  // of all equations
};

/// A cell field that a checkpoint keeps.
struct StoredField {
  std::string name;
  std::vector<double>* values;  // [n_all_cells]
};

/// How a model treats walls: what y+ of their cells may be follows from it.
enum class WallTreatment { none, wall_functions, automatic };

class Turbulence {
 public:
  virtual ~Turbulence() = default;
  /// Its keys in [turbulence]; the records point into this object.
  virtual Section section() = 0;
  /// Once, when the solver is built: fields of the flow, what depends on the mesh. The workspace is the model's in correct(). Collective,
  /// as are all functions below.
  virtual void prepare(Flow& flow, const BoundarySet& boundary, Workspace&) { refuse_rough_walls(flow, boundary); }
  /// Before the first step, with velocity and fluxes known. Throws Error(usage) if no initial state is known.
  virtual void start(Flow&, const BoundarySet&) {}
  /// Again after the mesh has turned, at the begin of a step; then flow.face_viscosity holds for its facets too.
  virtual void mesh_turned(Flow&, const BoundarySet&) {}
  /// Shift the history.
  virtual void begin_step(Flow&, const TimeScheme&) {}
  /// Transport through one step with the velocity and fluxes as they are; then flow.face_viscosity.
  virtual TurbulenceReport correct(Flow&, const BoundarySet&, const TimeScheme&, int /*outer*/) { return {}; }
  /// Velocity at the boundary faces for gradients of velocity in the cells, [n_faces - n_interior], m/s: at a wall function not that of the
  /// wall but that which the slope in the wall cell leads to.
  virtual const std::vector<Vec3>& velocity_for_gradient(const Flow&, const BoundarySet& boundary) { return boundary.values().velocity; }
  virtual WallTreatment wall_treatment() const { return WallTreatment::none; }
  /// What a resume needs; after reading it, restore() sets up all that follows from it.
  virtual std::vector<StoredField> stored() { return {}; }
  virtual void restore(Flow&, const BoundarySet&) {}

 protected:
  /// Of a model that has no law for them: throws Error(usage) if there are some.
  void refuse_rough_walls(const Flow& flow, const BoundarySet& boundary);
};

Registry<Turbulence>& turbulence_models();

/// The table [turbulence]; laminar if absent. Throws Error(usage) for an unknown model.
std::unique_ptr<Turbulence> read_turbulence(const Table& root);
/// The table as sections for the manual: the choice of the model, then one section a model.
std::vector<Section> turbulence_sections();

}  // namespace snag
