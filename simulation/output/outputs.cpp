#include "simulation/output/outputs.hpp"

#include <algorithm>
#include <cmath>

#include "dem/contacts/contact_solver.hpp"
#include "parallel/checkpoint.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"
#include "simulation/output/wall_cells.hpp"
#include "solver/fields/rotating_zone.hpp"

namespace snag {

namespace fs = std::filesystem;

namespace {

// Without intervals in the case: enough pictures for a film of the rags, few enough fields for a disk.
constexpr int default_n_fields = 20, default_n_rag_pictures = 100;

std::vector<Column<WaterRecord>> residual_columns() {
  using Record = const WaterRecord&;
  return {{"time", "s", [](Record r) { return r.time; }},
          {"time_step", "1", [](Record r) { return static_cast<double>(r.time_step); }},
          {"courant_max", "1", [](Record r) { return r.step.courant_max; }},
          {"courant_mean", "1", [](Record r) { return r.step.courant_mean; }},
          {"momentum_residual", "1", [](Record r) { return r.outer.momentum.final; }},
          {"momentum_sweeps_iterations", "1", [](Record r) { return static_cast<double>(r.outer.momentum.sweeps); }},
          {"pressure_residual", "1", [](Record r) { return r.outer.continuity.final; }},
          {"pressure_iterations", "1", [](Record r) { return static_cast<double>(r.outer.continuity.iterations); }},
          {"continuity_local", "1", [](Record r) { return r.step.continuity_local; }},
          {"continuity_global", "m3/s", [](Record r) { return r.step.continuity_global; }}};
}

std::vector<Column<HoldReaction>> hold_columns() {
  using Record = const HoldReaction&;
  std::vector<Column<HoldReaction>> all{{"time", "s", [](Record r) { return r.time; }},
                                        {"hold", "1", [](Record r) { return static_cast<double>(r.hold); }},
                                        {"rag", "1", [](Record r) { return static_cast<double>(r.rag); }},
                                        {"particles", "1", [](Record r) { return static_cast<double>(r.n_particles); }}};
  add_components(all, "", "", "m", [](Record r) { return r.point; });
  add_components(all, "force_", "", "N", [](Record r) { return r.force; });
  add_components(all, "moment_", "", "N m", [](Record r) { return r.moment; });
  return all;
}

std::vector<Column<PatchRecord>> patch_columns(const Mesh& mesh) {
  using Record = const PatchRecord&;
  std::vector<Column<PatchRecord>> all{{"time", "s", [](Record r) { return r.time; }}};
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    const std::string& name = mesh.patches[p].name;
    all.push_back({name + "_flow", "m3/s", [p](Record r) { return r.flow[p]; }});
    all.push_back({name + "_pressure", "Pa", [p](Record r) { return r.pressure[p]; }});
    add_components(all, name + "_force_", "", "N", [p](Record r) { return r.load[p].force(); });
    add_components(all, name + "_torque_", "", "N m", [p](Record r) { return r.load[p].torque(); });
  }
  return all;
}

std::vector<Column<SilhouetteRecord>> silhouette_columns() {
  using Record = const SilhouetteRecord&;
  return {{"time", "s", [](Record r) { return r.time; }},
          {"rag", "1", [](Record r) { return static_cast<double>(r.rag); }},
          {"area", "m2", [](Record r) { return r.seen.area; }},
          {"x", "m", [](Record r) { return r.seen.x; }},
          {"y", "m", [](Record r) { return r.seen.y; }},
          {"elongation_ratio", "1", [](Record r) { return r.seen.elongation_ratio; }},
          {"orientation", "rad", [](Record r) { return r.seen.orientation; }}};
}

std::vector<Column<EffortRecord>> timing_columns() {
  using Record = const EffortRecord&;
  return {{"time", "s", [](Record r) { return r.time; }},
          {"flow_s", "s", [](Record r) { return r.spent.flow; }},
          {"dem_s", "s", [](Record r) { return r.spent.rags; }},
          {"coupling_s", "s", [](Record r) { return r.spent.coupling; }},
          {"output_s", "s", [](Record r) { return r.spent.output; }}};
}

/// Walls on which a turbulence model gives y+. Collective.
std::vector<int> walls_with_y_plus(const FlowSolver& water) {
  std::vector<int> walls;
  if (sum(MPI_COMM_WORLD, static_cast<std::int64_t>(water.flow.y_plus.size())) == 0) return walls;
  for (int p = 0; p < static_cast<int>(water.flow.mesh.patches.size()); ++p)
    if (water.boundary().is_wall(p)) walls.push_back(p);
  return walls;
}

std::vector<Column<WallRecord>> wall_columns(const Mesh& mesh, const std::vector<int>& walls) {
  using Record = const WallRecord&;
  std::vector<Column<WallRecord>> all{{"time", "s", [](Record r) { return r.time; }}};
  for (std::size_t w = 0; w < walls.size(); ++w)
    for (const auto& [end, value] : {std::pair{"min", &YPlus::lowest}, {"mean", &YPlus::mean}, {"max", &YPlus::highest}})
      all.push_back({mesh.patches[walls[w]].name + "_y_plus_" + end, "1", [w, value = value](Record r) { return r.y_plus[w].*value; }});
  return all;
}

RotorState rotor_state(const RotatingZone& zone, double time) {
  return {{zone.origin(), zone.axis(), zone.speed(time)}, zone.angle(time), zone.slides()};
}

/// Area of all patches but walls; of a closed domain that of a cut, by its volume. m2. Collective.
double cross_section(const FlowSolver& water) {
  double openings = 0;
  for (int p = 0; p < static_cast<int>(water.flow.mesh.patches.size()); ++p)
    if (!water.boundary().is_wall(p)) openings += patch_area(water.flow, p);
  if (openings > 0) return openings;
  return std::pow(sum(MPI_COMM_WORLD, std::span(water.flow.mesh.cell_volume).first(water.flow.mesh.n_cells)), 2. / 3);
}

}  // namespace

Outputs::Outputs(fs::path folder, const CaseFile& file, Simulation& simulation, bool resume, double begun)
    : folder_(std::move(folder)), file_(file), simulation_(simulation), checkpoint_clock_(simulation), begun_(begun) {
  const double end = simulation.time_settings.end;
  fields_interval_ = simulation.output_settings.fields_interval.value_or(end / default_n_fields);
  rags_interval_ = simulation.output_settings.rags_interval.value_or(end / default_n_rag_pictures);
  if (simulation.water) {
    walls_with_y_plus_ = walls_with_y_plus(*simulation.water);
    cross_section_ = cross_section(*simulation.water);
    if (simulation.coupled) cells_at_walls_ = cells_at_walls(*simulation.water);
  }
  on_all_ranks(MPI_COMM_WORLD, [&] {
    if (rank_of(MPI_COMM_WORLD) != 0) return;
    write_atomically(folder_ / "case.resolved.toml", file.resolved());
    if (simulation.poses) simulation.poses->write(folder_ / "rags");
    open_monitors(resume);
  });
  const std::shared_ptr<const FieldWriter> writer = field_writers().make(simulation.output_settings.format, "[output] format");
  if (simulation.water) open_water(writer, resume);
  if (simulation.rags) open_rags(writer, resume);
}

/// Those that this class writes itself. Rank 0 only.
void Outputs::open_monitors(bool resume) {
  const auto open = [&]<class Record>(Monitor<Record>& monitor, const char* name, std::vector<Column<Record>> columns) {
    monitor = Monitor<Record>(folder_ / "monitors" / name, std::move(columns), resume, simulation_.time());
  };
  open(timing_, "timing.csv", timing_columns());
  if (simulation_.water) {
    open(residuals_, "residuals.csv", residual_columns());
    open(patches_, "patches.csv", patch_columns(*simulation_.mesh));
    if (!walls_with_y_plus_.empty()) open(wall_, "wall.csv", wall_columns(*simulation_.mesh, walls_with_y_plus_));
  }
  if (simulation_.rags) open(silhouettes_, "silhouettes.csv", silhouette_columns());
  if (simulation_.holds) open(holds_, "holds.csv", hold_columns());
  if (simulation_.coupled) open(coupling_, "coupling.csv", CoupledSolver::columns());
}

SeriesPlace Outputs::series_in(const char* name, bool resume) const {
  return {.folder = folder_ / name, .name = {}, .resume = resume, .from_time = simulation_.time()};
}

/// Fields, walls, and what a turning zone has: balances, and the pump. Collective.
void Outputs::open_water(const std::shared_ptr<const FieldWriter>& writer, bool resume) {
  FlowSolver& water = *simulation_.water;
  const double from = simulation_.time();
  fields_ =
      std::make_unique<FieldOutput>(*writer, series_in("fields", resume), *simulation_.mesh, simulation_.output_settings.single_precision);
  walls_ = std::make_unique<WallOutput>(writer, series_in("walls", resume), water.flow);
  if (!water.flow.rotating_zone) return;
  const RotatingZone& zone = *water.flow.rotating_zone;
  const RotorState start = rotor_state(zone, 0);
  if (simulation_.pump) pump_ = std::make_unique<PumpOutput>(folder_ / "monitors", water.flow, *simulation_.pump, start, resume, from);
  water.keep_balances(zone.origin(), zone.axis());
  balance_ = std::make_unique<BalanceOutput>(folder_ / "monitors", water, start, resume, from);
}

/// Collective.
void Outputs::open_rags(const std::shared_ptr<const FieldWriter>& writer, bool resume) {
  RagSystem& rags = *simulation_.rags;
  const double from = simulation_.time();
  rag_monitors_ = std::make_unique<RagMonitors>(folder_ / "monitors", rags, simulation_.passage->geometry().has_value(), resume, from);
  free_motion_.emplace(rags.rags().size());
  elongation_at_start_.resize(rags.rags().size());
  rag_output_ = std::make_unique<RagOutput>(*writer, series_in("rags", resume), simulation_.observe_settings.view());
  forces_ = rag_forces(rags, nullptr, 0);
  const RotatingZone* zone = simulation_.water ? simulation_.water->flow.rotating_zone : nullptr;
  const Shaft shaft = zone ? Shaft{zone->origin(), zone->axis(), zone->full_speed()} : Shaft{};
  wall_contacts_ =
      std::make_unique<WallContactOutput>(folder_ / "monitors", rags, simulation_.walls, zone ? &shaft : nullptr, resume, from);
}

void Outputs::initial() {
  if (walls_) walls_->initial(simulation_.water->flow);
  if (fields_) fields_->write(simulation_.water->flow);
  if (rag_output_) write_rags();
}

bool Outputs::due(double interval) const {
  if (interval <= 0) return true;
  // Counted in whole intervals, so that it does not depend on where a run was resumed.
  const double step = simulation_.time_settings.step, time = simulation_.time();
  return std::floor(time / interval + 1e-6) > std::floor((time - step) / interval + 1e-6);
}

void Outputs::after_step() {
  const double begun = MPI_Wtime();
  write_monitors();
  on_all_ranks(MPI_COMM_WORLD, [&] {
    for (const Series* each : series()) each->check();
  });
  const bool last = simulation_.has_ended();
  if (fields_ && (last || due(fields_interval_))) {
    fields_->write(simulation_.water->flow);
    walls_->write(simulation_.water->flow);
  }
  if (rag_output_ && (last || due(rags_interval_))) write_rags();
  seconds_ += MPI_Wtime() - begun;
  if (!last && checkpoint_clock_.is_due()) write_checkpoint();
}

void Outputs::write_checkpoint() const {
  sync();  // a checkpoint is never ahead of the monitors
  CheckpointWriter writer(MPI_COMM_WORLD, folder_ / "checkpoint",
                          {.case_sha256 = file_.resume_sha256(),
                           .ranks = size_of(MPI_COMM_WORLD),
                           .time_step = simulation_.time_step(),
                           .time = simulation_.time()});
  simulation_.save(writer);
  save(writer);
  writer.finish();
}

void Outputs::write_rags() {
  rag_output_->write(*simulation_.rags, forces_, simulation_.time_step(), simulation_.time());
  if (rank_of(MPI_COMM_WORLD) != 0) return;
  for (std::size_t rag = 0; rag < rag_output_->silhouettes().size(); ++rag) {
    const Silhouette& seen = rag_output_->silhouettes()[rag];
    if (elongation_at_start_[rag] == 0 && seen.area > 0) elongation_at_start_[rag] = seen.elongation_ratio;
    silhouettes_.add({simulation_.time(), rag, seen});
  }
}

void Outputs::write_monitors() {
  const double time = simulation_.time();
  const bool root = rank_of(MPI_COMM_WORLD) == 0;
  if (wall_contacts_) wall_contacts_->after_step(*simulation_.rags, time);
  if (simulation_.water) write_water_monitors();
  if (simulation_.water && simulation_.water->flow.rotating_zone) write_rotor_monitors();
  if (!walls_with_y_plus_.empty()) write_wall_monitors();
  if (simulation_.rags) {
    forces_ = rag_forces(*simulation_.rags, simulation_.coupled.get(), simulation_.time_settings.step);
    rag_monitors_->after_step(*simulation_.rags, *simulation_.passage, forces_, time);
    free_motion_->after_step(*simulation_.rags, *simulation_.passage, forces_, time, simulation_.time_settings.step);
    if (simulation_.holds)
      for (const HoldReaction& reaction : simulation_.holds->reactions(*simulation_.rags, time))
        if (root) holds_.add(reaction);
  }
  if (simulation_.coupled) write_coupling_monitors();
  const Effort spent = effort();
  if (root) timing_.add({time, spent});
}

Effort Outputs::effort() const {
  Effort all = effort_before_;
  const auto spent = simulation_.seconds();
  all.wall += MPI_Wtime() - begun_;
  all.flow += spent.flow, all.rags += spent.rags, all.coupling += spent.coupling, all.output += seconds_;
  if (simulation_.rags) all.particle_steps += static_cast<double>(sum(MPI_COMM_WORLD, simulation_.rags->n_particle_steps()));
  return all;
}

std::vector<const Series*> Outputs::series() const {
  std::vector<const Series*> all{&residuals_.series(), &patches_.series(), &wall_.series(), &silhouettes_.series(),
                                 &coupling_.series(),  &timing_.series(),  &holds_.series()};
  const auto append = [&](const std::vector<const Series*>& more) { all.insert(all.end(), more.begin(), more.end()); };
  if (rag_monitors_) append(rag_monitors_->series());
  if (wall_contacts_) append({&wall_contacts_->series()});
  if (pump_) append(pump_->series());
  if (balance_) all.push_back(&balance_->series());
  return all;
}

void Outputs::sync() const {
  on_all_ranks(MPI_COMM_WORLD, [&] {
    for (const Series* each : series()) each->check(), each->sync();
  });
}

void Outputs::write_water_monitors() {
  const StepReport& report = simulation_.flow_report;
  PatchRecord patches{.time = simulation_.time(), .flow = {}, .pressure = {}, .load = {}};
  double through = 0;
  const Flow& flow = simulation_.water->flow;
  for (int p = 0; p < static_cast<int>(simulation_.mesh->patches.size()); ++p) {
    patches.flow.push_back(flow_rate(flow, p)), patches.load.push_back(patch_force(flow, p, {}));
    patches.pressure.push_back(mean_pressure(flow, p));
    through += std::abs(patches.flow.back()) / 2;
  }
  largest_through_ = std::max(largest_through_, through);
  if (!report.outer.empty()) largest_imbalance_ = std::max(largest_imbalance_, report.outer.back().continuity.final);
  if (rank_of(MPI_COMM_WORLD) != 0) return;
  patches_.add(patches);
  if (report.outer.empty()) return;
  residuals_.add({simulation_.time(), simulation_.time_step(), report, report.outer.back()});
}

void Outputs::write_wall_monitors() {
  WallRecord record{.time = simulation_.time(), .y_plus = {}};
  for (const int patch : walls_with_y_plus_) record.y_plus.push_back(y_plus_of(simulation_.water->flow, patch));
  if (rank_of(MPI_COMM_WORLD) == 0) wall_.add(record);
}

void Outputs::write_coupling_monitors() {
  const CouplingReport& report = simulation_.coupled->report();
  largest_exchange_ = std::max(largest_exchange_, report.momentum_exchange);
  if (rank_of(MPI_COMM_WORLD) == 0) coupling_.add(report);
  if (!simulation_.water) return;
  const auto& least = coupled_.width_least;
  coupled_.width_least = least > 0 ? std::min(least, report.width_over_cell_least) : report.width_over_cell_least;
  coupled_.width_largest = std::max(coupled_.width_largest, report.width_over_cell_largest);
  coupled_.solid_fraction = std::max(coupled_.solid_fraction, report.max_solid_fraction);
  const ForcePlaces& places = report.places;
  coupled_.impulse += places.impulse, coupled_.displaced += places.impulse * places.displacement;
  coupled_.couple_lost += places.couple_lost, coupled_.couple += places.couple;
  const Flow& flow = simulation_.water->flow;
  const auto force = [&](int c) { return flow.mesh.cell_volume[c] * norm(flow.reaction[c]); };
  std::vector<double> at_walls, all;
  for (const int c : cells_at_walls_) at_walls.push_back(force(c));
  for (int c = 0; c < flow.mesh.n_cells; ++c)
    if (flow.reaction[c] != Vec3{}) all.push_back(force(c));
  coupled_.force_at_walls += sum(MPI_COMM_WORLD, std::span<const double>(at_walls));
  coupled_.force += sum(MPI_COMM_WORLD, std::span<const double>(all));
}

void Outputs::write_rotor_monitors() {
  const Flow& flow = simulation_.water->flow;
  largest_closure_ = std::max(largest_closure_, flow.rotating_zone->mesh().closure());
  const RotorState rotor = rotor_state(*flow.rotating_zone, flow.time);
  if (pump_) pump_->after_step(flow, rotor, wall_contacts_ ? wall_contacts_->shaft_torque() : 0);
  balance_->after_step(*simulation_.water, rotor);
}

void Outputs::save(CheckpointWriter& writer) const {
  writer.shared("outputs", std::vector<double>{largest_exchange_, largest_imbalance_, largest_closure_, largest_through_});
  const auto& c = coupled_;
  writer.shared("coupled", std::vector<double>{c.width_least, c.width_largest, c.solid_fraction, c.force_at_walls, c.force, c.impulse,
                                               c.displaced, c.couple_lost, c.couple});
  const Effort spent = effort();
  writer.shared("effort", std::vector<double>{spent.wall, spent.flow, spent.rags, spent.coupling, spent.output, spent.particle_steps});
  if (rag_monitors_) {
    writer.shared("rag_monitors", rag_monitors_->state());
    writer.shared("free_motion", free_motion_->state());
    writer.shared("elongation_at_start", elongation_at_start_);
    writer.shared("silhouettes", rag_output_->state());
  }
  if (balance_) balance_->save(writer);
  if (!pump_) return;
  pump_->save(writer);
  write_phase();
}

void Outputs::load(CheckpointReader& reader) {
  const std::vector<double> kept = reader.shared("outputs");
  largest_exchange_ = kept[0], largest_imbalance_ = kept[1], largest_closure_ = kept[2], largest_through_ = kept[3];
  const std::vector<double> coupled = reader.shared("coupled");
  coupled_ = {coupled[0], coupled[1], coupled[2], coupled[3], coupled[4], coupled[5], coupled[6], coupled[7], coupled[8]};
  const std::vector<double> spent = reader.shared("effort");
  effort_before_ = {spent[0], spent[1], spent[2], spent[3], spent[4], spent[5]};
  if (rag_monitors_) {
    rag_monitors_->restore(reader.shared("rag_monitors"));
    free_motion_->restore(reader.shared("free_motion"));
    elongation_at_start_ = reader.shared("elongation_at_start");
    rag_output_->restore(reader.shared("silhouettes"));
  }
  if (balance_) balance_->load(reader);
  if (pump_) pump_->load(reader);
}

void Outputs::write_phase() const {
  on_all_ranks(MPI_COMM_WORLD, [&] {
    if (rank_of(MPI_COMM_WORLD) == 0) pump_->write_phase();
  });
}

}  // namespace snag
