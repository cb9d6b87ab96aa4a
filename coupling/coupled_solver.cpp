#include "coupling/coupled_solver.hpp"

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/words.hpp"
#include "dem/particles/tile_particles.hpp"
#include "dem/templates/lattice.hpp"
#include "parallel/checkpoint.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {

// Solid fraction of a random packing of spheres: what lies denser has no room for the water that the model puts there.
constexpr double densest_packing = 0.6;

/// Collective.
bool has_turbulence(const Flow& flow) {
  return sum(flow.mesh.comm, static_cast<std::int64_t>(flow.turbulent_kinetic_energy.size())) > 0;  // none on a rank without cells
}

/// Throws Error(usage) that names the forces of the case that need k and epsilon, if the flow has none.
void require_turbulence(const FluidForces& forces, bool there) {
  std::vector<std::string> names;
  for (const auto& force : forces)
    if (const ForceDescription description = force->description(); description.samples.turbulence) names.push_back(description.name);
  if (names.empty() || there) return;
  throw Error(ExitCode::usage, "[coupling] forces: " + joined(names) + (names.size() > 1 ? " need" : " needs") +
                                   " k and epsilon, but this flow has none; give [turbulence] model = \"k_epsilon\", or remove " +
                                   (names.size() > 1 ? "the forces" : "the force"));
}

/// The drag law that takes the solid fraction, "" if none does.
std::string drag_in_packings(const FluidForces& forces) {
  for (const auto& force : forces)
    if (const ForceDescription description = force->description(); description.role == Role::drag && description.samples.solid_fraction)
      return description.name;
  return "";
}

/// Adds the time since the last lap to what it was spent on. One look at the clock a lap: the steps of a single particle take no longer
/// than some of them.
class Laps {
 public:
  void add_to(double& seconds) {
    const double now = MPI_Wtime();
    seconds += now - last_, last_ = now;
  }

 private:
  double last_ = MPI_Wtime();
};

}  // namespace

void CoupledSolver::step(double dt) {
  Laps laps;
  if (owner_) rags_.migrate([this](const std::vector<Vec3>& centres) { return owner_->owner_of(centres); });
  if (prescribed_field_) prescribed_field_->set_time(rags_.time());
  if (prediction_) prediction_->begin_step(dt);
  load_->begin_step(rags_.tiles(), rags_.time());  // weights w_bc; fluid -> particles, consistent
  laps.add_to(seconds_.coupling);

  rags_.advance(dt, load_.get());  // in sub-steps; sums the impulse of the fluid on each particle
  laps.add_to(seconds_.rags);

  spread(dt);  // particles -> fluid, conservative: solid fraction, reaction
  if (!prescribed_field_) {
    laps.add_to(seconds_.coupling);
    advance_flow_(dt);
    laps.add_to(seconds_.flow);
    if (coupling_.settings.two_way()) load_->end_step(rags_.tiles(), kernel_field_->missed_rates(given_));
    if (flow_->mesh.turning.zone >= 0) mesh_moved();
    prediction_->end_step();
  }
  write_report(dt);
  laps.add_to(seconds_.coupling);
}

CoupledSolver::CoupledSolver(Coupling coupling, RagSystem& rags, Flow& flow, std::function<void(double)> advance_flow, KnownFactors* known)
    : coupling_(std::move(coupling)), rags_(rags), flow_(&flow), advance_flow_(std::move(advance_flow)) {
  const bool turbulent = has_turbulence(flow);
  require_turbulence(coupling_.forces, turbulent);
  if (size_of(rags.comm()) > 1) owner_ = std::make_unique<CellOwner>(flow.mesh);
  const double width = coupling_.kernel_width(rags.rags());
  kernel_ = std::make_unique<Kernel>(*coupling_.shape, width, flow.mesh, known);
  prediction_ = std::make_unique<WaterPrediction>(flow, coupling_.shape->has_width() ? width : 0);
  kernel_field_ = std::make_unique<KernelField>(flow, *kernel_, rags.rags(), *prediction_, coupling_.settings.two_way());
  load_ = std::make_unique<FluidLoad>(coupling_.forces, *kernel_field_, rags.rags());
  screens_ = turbulent && coupling_.settings.two_way() && load_->gives_screen();
  exchange_ = std::make_unique<Exchange>(*kernel_, flow, coupling_.settings.two_way(), screens_);
}

CoupledSolver::CoupledSolver(Coupling coupling, RagSystem& rags, const PrescribedFlow& flow)
    : coupling_(std::move(coupling)), rags_(rags), advance_flow_([](double) {}) {
  prescribed_field_ = std::make_unique<PrescribedField>(flow);
  load_ = std::make_unique<FluidLoad>(coupling_.forces, *prescribed_field_, rags.rags());
}

void CoupledSolver::mesh_moved() {
  if (owner_) owner_->mesh_moved();
  if (kernel_) kernel_->mesh_moved();
}

Vec3 CoupledSolver::water_velocity(int rag) {
  std::vector<Vec3> points, velocity;
  if (prescribed_field_) {
    prescribed_field_->set_time(rags_.time());
    prescribed_field_->sample(rags_.tiles(), {});
  }
  for (std::size_t t = 0; t < rags_.tiles().size(); ++t) {
    const Tile& tile = rags_.tiles()[t];
    if (tile.rag != rag) continue;
    const FluidSamples water = prescribed_field_ ? prescribed_field_->at(t, tile, 0, 0) : FluidSamples{};
    for_particles(tile, [&](int k, int, int) {
      if (prescribed_field_)
        velocity.push_back(water.velocity[k]);
      else
        points.push_back(tile.vector(Tile::x, k));
    });
  }
  if (kernel_) {
    kernel_->locate(points);
    velocity = kernel_->average(std::span<const Vec3>(flow_->velocity));
  }
  return sum(rags_.comm(), std::span<const Vec3>(velocity)) / static_cast<double>(rags_.rags()[rag].n_particles);
}

void CoupledSolver::spread(double dt) {
  report_ = {};
  impulses_ = load_->impulses_with_unfelt(rags_.tiles());
  if (!flow_) return;
  const std::vector<Vec3> felt = load_->impulses(rags_.tiles());
  const ParticleList& particles = kernel_field_->particles();
  std::vector<double> volume(particles.size());
  for (std::size_t b = 0; b < particles.size(); ++b) volume[b] = rags_.rags()[rags_.tiles()[particles.tile(b)].rag].hydrodynamic_volume;
  std::vector<double> screen(screens_ ? particles.size() : 0);
  for (std::size_t b = 0; b < screen.size(); ++b) screen[b] = load_->screen(particles.tile(b), particles.place(b));
  given_ = coupling_.settings.two_way() ? load_->given(rags_.tiles(), prediction_->scheme()) : felt;
  const ExchangeBalance balance = exchange_->spread({.volume = volume, .screen = screen, .given = given_}, dt);
  report_.max_solid_fraction = balance.max_solid_fraction;
  judge_packing();
  if (!coupling_.settings.two_way()) return;
  check_momentum(balance);
  const Vec3 lost = (balance.on_rags + balance.on_water) / prediction_->scheme().now;
  report_.force_on_water = (lost - sum(rags_.comm(), std::span<const Vec3>(felt))) / dt;
  report_.momentum_exchange = balance.relative();
  std::vector<int> rag_of(particles.size());
  std::vector<Vec3> mean_places(particles.size());
  for (std::size_t b = 0; b < particles.size(); ++b)
    rag_of[b] = rags_.tiles()[particles.tile(b)].rag, mean_places[b] = kernel_field_->mean_place(b);
  report_.places = force_places(rags_.comm(), kernel_field_->places(), mean_places, felt, rag_of, rags_.rags().size());
  double largest = 0;
  for (std::size_t b = 0; b < particles.size(); ++b)
    largest = std::max(largest, load_->slope(particles.tile(b), particles.place(b)) * kernel_field_->response(b));
  report_.max_drag_number = maximum(rags_.comm(), largest);
}

// Solid fraction enters the equations of the water nowhere; of the forces, those of suspensions hold up to a dense packing only.
void CoupledSolver::judge_packing() {
  if (report_.max_solid_fraction <= densest_packing || warned_of_packing_) return;
  const double width = coupling_.kernel_width(rags_.rags());
  const std::string kernel = coupling_.shape->has_width() ? "kernel_width is " + number_text(1e3 * width) + " mm" : "kernel is \"cell\"";
  const std::string found = "the particles fill " + number_text(report_.max_solid_fraction) + " of a cell at " + number_text(rags_.time()) +
                            " s, more than the " + number_text(densest_packing) + " of a dense packing; " + kernel;
  const std::string remedy = "widen it until max_solid_fraction of monitors/coupling.csv stays below";
  if (const std::string law = drag_in_packings(coupling_.forces); !law.empty())
    throw Error(ExitCode::usage, "[coupling] forces: " + law + " is a law for packings up to " + number_text(densest_packing) + ", but " +
                                     found + ": " + remedy + ", or take a drag law without the solid fraction");
  warned_of_packing_ = true;
  log::warning("coupling: " + found + ": " + remedy + " (said once)");
}

void CoupledSolver::write_report(double dt) {
  const MPI_Comm comm = rags_.comm();
  report_.time = rags_.time();
  report_.max_stiffness = maximum(comm, load_->max_stiffness(rags_.tiles()));
  report_.force_on_rags = sum(comm, std::span<const Vec3>(impulses_)) / dt;
  if (!kernel_) return;
  const auto [least, largest] = kernel_->width_over_cell_size();
  report_.width_over_cell_least = least, report_.width_over_cell_largest = largest;
  report_.particles_outside = kernel_->n_outside();
  report_.points_outside = kernel_->n_points_outside();
}

std::vector<Column<CouplingReport>> CoupledSolver::columns() {
  using Report = const CouplingReport&;
  std::vector<Column<CouplingReport>> all{{"time", "s", [](Report r) { return r.time; }}};
  add_components(all, "force_on_rags_", "", "N", [](Report r) { return r.force_on_rags; });
  add_components(all, "force_on_water_", "", "N", [](Report r) { return r.force_on_water; });
  all.insert(all.end(), {{"momentum_exchange_rel", "1", [](Report r) { return r.momentum_exchange; }},
                         {"force_displacement", "m", [](Report r) { return r.places.displacement; }},
                         {"couple_lost_rel", "1", [](Report r) { return r.places.relative(); }},
                         {"max_solid_fraction", "1", [](Report r) { return r.max_solid_fraction; }},
                         {"max_drag_number", "1", [](Report r) { return r.max_drag_number; }},
                         {"max_stiffness", "1", [](Report r) { return r.max_stiffness; }},
                         {"kernel_width_over_cell_least", "1", [](Report r) { return r.width_over_cell_least; }},
                         {"kernel_width_over_cell_largest", "1", [](Report r) { return r.width_over_cell_largest; }},
                         {"particles_outside_cells", "1", [](Report r) { return static_cast<double>(r.particles_outside); }},
                         {"kernel_points_outside_cells", "1", [](Report r) { return static_cast<double>(r.points_outside); }}});
  return all;
}

void CoupledSolver::save(CheckpointWriter& writer) const {
  if (prediction_) prediction_->save(writer);
  const int n = load_->n_particle_state();
  if (n == 0) return;
  std::vector<std::int64_t> ids;
  std::vector<double> values;
  for (const Tile& tile : rags_.tiles())
    for_particles(tile, [&](int k, int i, int j) {
      ids.push_back(particle_id(rags_.rags()[tile.rag], tile, i, j));
      for (int f = 0; f < n; ++f) values.push_back(tile.particle_state.empty() ? 0 : tile.particle_state[f * tile.exists.size() + k]);
    });
  writer.rows("coupling/memory", ids, values, n);
}

void CoupledSolver::load(CheckpointReader& reader) {
  if (prediction_) prediction_->load(reader);
  if (const int n = load_->n_particle_state(); n > 0) {
    std::vector<std::int64_t> ids;
    for (const Tile& tile : rags_.tiles())
      for_particles(tile, [&](int, int i, int j) { ids.push_back(particle_id(rags_.rags()[tile.rag], tile, i, j)); });
    const std::vector<double> values = reader.rows("coupling/memory", ids, n);
    const double* row = values.data();
    for (Tile& tile : rags_.tiles()) {
      tile.particle_state.assign(n * tile.exists.size(), 0.0);
      for_particles(tile, [&](int k, int, int) {
        for (int f = 0; f < n; ++f) tile.particle_state[f * tile.exists.size() + k] = *row++;
      });
    }
  }
  mesh_moved();  // the water was loaded before: a turning zone is not where it was when the kernel was made
}

}  // namespace snag
