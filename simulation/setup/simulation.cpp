#include "simulation/setup/simulation.hpp"

#include <cmath>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/words.hpp"
#include "dem/contacts/contact_settings.hpp"
#include "dem/contacts/contact_solver.hpp"
#include "mesh/import/import.hpp"
#include "parallel/checkpoint.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"
#include "simulation/setup/boundary_openings.hpp"
#include "simulation/setup/forecast.hpp"
#include "simulation/setup/prepared.hpp"
#include "simulation/setup/rag_release.hpp"
#include "simulation/setup/start_check.hpp"
#include "solver/fields/rotating_zone.hpp"

namespace snag {

namespace {

/// Reads the table of a settings struct.
template <class Settings>
void read(const Table& root, Settings& settings) {
  const Section section = settings.section();
  root.table(section).read(section.parameters);
}

/// What to do with a file that is no case: the command that reads its tables.
std::string remedy_without_run(const Table& root) {
  const std::pair<const char*, const char*> readers[] = {
      {"study", "snag study"}, {"experiment", "snag diagnose"}, {"point", "snag diagnose"}, {"camera", "snag observe"}};
  for (const auto& [table, command] : readers)
    if (root.has(table)) return std::string("its table \"") + table + "\" belongs to a file of `" + command + "`";
  return "give [mesh] or [[rag]]";
}

}  // namespace

Simulation::Simulation(const CaseFile& file, MPI_Comm comm, Stored stored, FlowCache* store, Prepared* prepared)
    : comm_(comm), stored_(std::move(stored)), store_(store), prepared_(prepared) {
  const Table root = file.root();
  read(root, case_settings);
  read(root, time_settings);
  read(root, output_settings);
  read(root, checkpoint_settings);
  read(root, observe_settings);
  read(root, start_settings_);
  start_folder_ = file.path(start_settings_.from);
  if (time_settings.step_is_auto())
    throw Error(ExitCode::usage, root.table("time").where() +
                                     " step = \"auto\" is found by `snag run` and `snag study` alone; give step_ms here, " +
                                     "such as that in the case.resolved.toml of a run");
  time_settings.n_steps();
  read_mesh(file);
  build_water(file);
  read_pump(root);
  build_rags(file);
  couple(file);
  if (!water && !rags)
    throw Error(ExitCode::usage, root.where() + " has neither a mesh nor a rag: nothing to run; " + remedy_without_run(root));
  file.reject_unread();
}

Simulation::~Simulation() = default;

void Simulation::read_mesh(const CaseFile& file) {
  read(file.root(), mesh_settings_);
  ImportOptions options{.scale = mesh_settings_.scale, .partition = stored_.partition};
  for (const Table& table : file.root().tables("periodic")) {
    PeriodicSettings periodic;
    table.read(periodic.section().parameters);
    options.periodic.push_back(periodic.pair);
    periodic_ = true;
  }
  if (mesh_settings_.file.empty() == mesh_settings_.geometry.empty()) {
    if (mesh_settings_.file.empty()) return;
    throw Error(ExitCode::usage, "[mesh] gives both a file and a geometry; keep one of them");
  }
  // Only standing meshes are shared: a turning one is left at some angle by the run before.
  mesh_key_ = joined({file.path(mesh_settings_.file).string(), file.path(mesh_settings_.parameters).string(), mesh_settings_.geometry,
                      joined(mesh_settings_.set), number_text(mesh_settings_.scale)});
  CachedMesh* kept = store_ && start_settings_.frozen ? &store_->meshes[mesh_key_] : nullptr;
  if (!kept || !kept->mesh) {
    GeneratedMeshes of_this_run;
    // Ranks that build runs for themselves do not agree on what was made before.
    const bool of_all_ranks = size_of(comm_) == size_of(MPI_COMM_WORLD);
    GeneratedMeshes& meshes = prepared_ && of_all_ranks ? prepared_->meshes : of_this_run;
    std::filesystem::path path, parameters;
    if (!mesh_settings_.parameters.empty()) parameters = file.path(mesh_settings_.parameters);
    if (mesh_settings_.geometry.empty())
      path = file.path(mesh_settings_.file);
    else
      path = meshes.file(comm_, mesh_settings_.geometry, parameters, mesh_settings_.set);
    CachedMesh fresh{.mesh = std::make_shared<Mesh>(import_mesh(path, comm_, options)), .quality = {}, .kernel_factors = {}};
    fresh.quality = quality(*fresh.mesh);
    if (!fresh.quality.failures.empty()) throw Error(ExitCode::mesh, path.string() + ": " + fresh.quality.failures.front());
    mesh = fresh.mesh, mesh_quality = fresh.quality;
    if (kept) *kept = std::move(fresh);
    return;
  }
  mesh = kept->mesh, mesh_quality = kept->quality;
}

void Simulation::read_pipe_flow(const Table& root) {
  if (!root.has("pipe_flow")) return;
  read(root, pipe_flow_);
  pipe_flow_.prepare();
  if (!pipe_flow_.changes_water() || prescribed_ || start_settings_.frozen) return;
  throw Error(ExitCode::usage, root.table("pipe_flow").where() +
                                   " changes water that is computed, or there is none; remove swirl, profile and vortices, or give "
                                   "[initial_flow] frozen = true or [flow] kind = \"prescribed\"");
}

void Simulation::build_water(const CaseFile& file) {
  if (!mesh && file.root().has("flow")) read(file.root(), prescribed_.emplace());
  read_pipe_flow(file.root());
  if (prescribed_) prescribed_->pipe = pipe_flow_;
  if (!mesh) return;
  FlowSettings settings;
  read(file.root(), settings);
  const auto gap_picture = std::filesystem::path(file.file()).replace_extension(".interface_gap.vtp");
  auto zone = read_rotating_zone(file.root(), *mesh, gap_picture);
  if (start_settings_.frozen && zone)
    throw Error(ExitCode::usage,
                "[initial_flow] frozen = true with [rotating_zone]: frozen flow is not possible with a rotating zone; remove one of them");
  auto boundaries = read_boundaries(file.root());
  auto turbulence = read_turbulence(file.root());
  laminar_asked_ = file.root().table("turbulence").has("model");
  if (store_ && start_settings_.frozen) {
    std::string conditions;
    for (const Table& table : file.root().tables("boundary")) conditions += table.resolved();
    const auto key =
        joined({mesh_key_, start_folder_.string(), number_text(start_settings_.map_nearest_cell), number_text(settings.density),
                number_text(settings.viscosity()), number_text(turbulence != nullptr), conditions});
    cached_flow_ = &store_->flows[key];
    water = cached_flow_->solver;
  }
  if (!water) water = std::make_shared<FlowSolver>(*mesh, settings, std::move(boundaries), std::move(turbulence), std::move(zone));
  if (cached_flow_) cached_flow_->solver = water;
  check_turn(*water, time_settings.step);
  if (!start_settings_.frozen) water->foresee(time_settings.end);
}

void Simulation::read_pump(const Table& root) {
  if (!root.has("pump")) return;
  read(root, pump.emplace());
  if (!water || !water->flow.rotating_zone)
    throw Error(ExitCode::usage, root.table("pump").where() + " needs [rotating_zone], which the case lacks; add it, or remove [pump]");
}

void Simulation::build_rags(const CaseFile& file) {
  const RotatingZone* zone = water ? water->flow.rotating_zone : nullptr;
  std::optional<WallMotion> rotor;
  if (zone) rotor = {.axis = zone->axis(), .origin = zone->origin(), .speed = zone->full_speed(), .velocity = {}, .ramp = zone->ramp()};
  walls = read_walls(file, mesh.get(), rotor ? &*rotor : nullptr);
  contacts.read(file.root().table("contact"));
  DemSettings settings;
  read(file.root(), settings);
  std::vector<RagPiece> pieces = read_pieces(file);
  std::optional<Shaft> shaft;
  if (zone) shaft = {zone->origin(), zone->axis(), zone->full_speed()};
  std::optional<PassageGeometry> way = read_passage(file.root(), shaft);
  if (pieces.empty()) return;
  if (zone && !zone->slides())
    throw Error(ExitCode::usage,
                "[rotating_zone] motion = \"frame\" with rags: rags need a rotor mesh that turns with its walls; use \"sliding\"");
  place_at_patches(mesh.get(), pieces);
  std::string of_poses = file.root().table("contact").resolved();
  for (const char* sheet : {"rag", "disc"})
    for (const Table& table : file.root().tables(sheet)) of_poses += table.resolved();
  poses = std::make_unique<RagPoses>(comm_, pieces, contacts, stored_.checkpoint, prepared_ ? &prepared_->poses : nullptr, of_poses);
  rags = std::make_unique<RagSystem>(comm_, settings, std::move(pieces));
  rags->set_contacts(std::make_unique<ContactSolver>(contacts, rags->rags(), &walls));
  if (way) rags->contacts()->set_tongue({way->tongue(), way->direction(), way->tongue_reach()});
  passage = std::make_unique<Passage>(comm_, water ? openings(*mesh, water->boundary()) : std::vector<Opening>{}, std::move(way),
                                      rags->rags().size());
  if (const std::string patches = water ? patches_without_walls() : ""; !patches.empty())
    log::warning(
        "the case has no [[wall]]: rags do not feel its patches of kind wall, and go through them; add [[wall]], kind = \"patches\", "
        "patches = [" +
        patches + "]");
}

std::unique_ptr<CoupledSolver> Simulation::coupling_of(const CaseFile& file) {
  std::unique_ptr<CoupledSolver> solver;
  if (water) {
    const bool frozen = start_settings_.frozen;
    Coupling coupling = read_coupling(file.root());
    if (frozen && coupling.settings.two_way())
      throw Error(
          ExitCode::usage,
          "[initial_flow] frozen = true with [coupling] mode = \"two_way\": frozen flow allows one-way coupling only; use \"one_way\"");
    KnownFactors* known = store_ && frozen ? &store_->meshes[mesh_key_].kernel_factors : nullptr;
    solver = std::make_unique<CoupledSolver>(
        std::move(coupling), *rags, water->flow, [this](double dt) { move_water(dt); }, known);
  } else if (prescribed_) {
    solver = std::make_unique<CoupledSolver>(read_coupling(file.root(), false), *rags, *prescribed_);
  }
  if (solver) solver->set_walls(walls);
  return solver;
}

void Simulation::couple(const CaseFile& file) {
  if (!rags) return;
  const Vec3 gravity = read_gravity(file.root());
  coupled = coupling_of(file);
  if (!coupled) rags->set_gravity(gravity);
  if (file.root().has("hold")) holds = std::make_unique<Holds>(file.root(), *rags, coupled ? Vec3{} : gravity);
  if (holds) rags->set_motion(holds.get());
  speed_bounds_ = std::make_unique<SpeedBounds>(norm(gravity), mesh.get(), walls, rags->pieces(), contacts.impact_speed);
  if (holds) speed_bounds_->widen(holds->largest_speed(), "motion of [[hold]]");
  if (water) water->watch().widen(speed_bounds_->speed(), speed_bounds_->source());
}

/// Particles that were just moved.
void Simulation::bound_speeds() {
  check_speeds(*rags, speed_bounds_->at(rags->time(), water.get(), prescribed_ ? &*prescribed_ : nullptr, *rags));
}

void Simulation::move_water(double dt) {
  if (rags) bound_speeds();  // before the water feels what has diverged
  if (start_settings_.frozen) return water->advance_frozen(dt);
  flow_report = water->advance(dt);
}

void Simulation::step() {
  const double begun = coupled ? 0 : MPI_Wtime();
  // At the beginning of a step: what the last one left behind for the outputs belongs to the rags that were there.
  if (rags && time_step_ > 0) remove_rags(), insert_rags();
  if (holds) holds->apply(*rags, time());
  if (coupled) {
    coupled->step(time_settings.step);
  } else if (water) {
    move_water(time_settings.step);
  } else {
    rags->migrate();
    rags->advance(time_settings.step);
  }
  if (!water && watches_rags) bound_speeds();
  if (!coupled) alone_seconds_ += MPI_Wtime() - begun;
  check_inside();
  ++time_step_;
  if (passage && watches_rags) passage->observe(*rags, time(), time_settings.step);
}

bool Simulation::rags_have_left() const {
  if (!time_settings.end_when_rags_left || !passage) return false;
  const std::optional<double> left = passage->all_exited_at();
  return left && time() > *left + time_settings.run_on - 0.5 * time_settings.step;
}

/// A rag of which every particle has left the mesh by an outlet feels nothing any more, and would only cost time.
void Simulation::remove_rags() {
  for (int r = 0; r < static_cast<int>(rags->rags().size()); ++r) {
    const Rag& rag = rags->rags()[static_cast<std::size_t>(r)];
    if (rags->presence(r) != RagSystem::Presence::present || passage->n_out()[r] < rag.n_particles) continue;
    rags->remove(r);
    log::info(rag.name + ": left the mesh as a whole at " + number_text(time()) + " s, taken out of the run");
  }
}

/// Those whose time has come, checked.
void Simulation::insert_rags() {
  if (!rags) return;
  std::vector<int> fresh;
  double crowding = 0;
  for (int r = 0; r < static_cast<int>(rags->rags().size()); ++r) {
    const RagPiece& piece = rags->pieces()[static_cast<std::size_t>(r)];
    if (rags->presence(r) == RagSystem::Presence::removed) continue;
    if (rags->presence(r) == RagSystem::Presence::present) {
      if (time_step_ == 0) fresh.push_back(r);
      continue;
    }
    if (piece.insert_time > time() + 1e-6 * time_settings.step) {
      if (time_step_ == 0) check_waiting(*this, r);
      continue;
    }
    if (fresh.empty() && time_step_ > 0) crowding = overlap_of_particles(*rags);
    rags->insert(r);
    fresh.push_back(r);
    if (piece.match_flow_velocity) add_flow_velocity(r);
    if (time_step_ > 0) log::info(piece.rag.name + ": put in at " + number_text(time()) + " s");
  }
  check_start(*this, fresh, crowding);
}

void Simulation::add_flow_velocity(int rag) {
  if (!coupled)
    throw Error(ExitCode::usage, rags->rags()[static_cast<std::size_t>(rag)].name +
                                     ": match_flow_velocity = true, but this case has no water; give velocity, or [mesh] and [flow]");
  rags->add_velocity(rag, coupled->water_velocity(rag));
}

/// Patches of kind wall that rags do not feel, because the case has no [[wall]]: their names, in quotes; empty if there are none.
std::string Simulation::patches_without_walls() const {
  if (!walls.bodies().empty()) return "";
  std::vector<std::string> names;
  for (std::size_t p = 0; p < mesh->patches.size(); ++p)
    if (water->boundary().is_wall(static_cast<int>(p))) names.push_back("\"" + mesh->patches[p].name + "\"");
  return joined(names);
}

/// Particles that are in no cell feel the water of the nearest one, which is right only for those that have left by an opening.
void Simulation::check_inside() {
  if (!coupled || !mesh || (warned_of_particles_outside_ && !periodic_)) return;
  std::int64_t n = coupled->report().particles_outside;
  for (const std::int64_t out : passage->n_out()) n -= out;
  if (n <= 0) return;
  const std::string found =
      "rags: " + std::to_string(n) + " particles are outside the mesh at t = " + number_text(time()) + " s and did not leave by an outlet";
  if (periodic_)
    throw Error(ExitCode::invariant,
                found + "; particles are not carried through periodic patches yet: shorten the run, or make the domain longer");
  if (!patches_without_walls().empty())
    throw Error(ExitCode::usage,
                found +
                    ": the case has no [[wall]], and without one rags go through patches of kind wall; add [[wall]], kind = "
                    "\"patches\", patches = [" +
                    patches_without_walls() + "]");
  log::warning(found + "; their forces are those of the water in the nearest cell: is a [[wall]] missing?");
  warned_of_particles_outside_ = true;
}

std::string Simulation::start() {
  std::string log_message = start_water();
  insert_rags();
  return log_message;
}

std::string Simulation::start_water() {
  const bool frozen = start_settings_.frozen;
  if (start_settings_.from.empty()) {
    if (frozen)
      throw Error(ExitCode::usage,
                  "[initial_flow] frozen = true without from: there is no flow to freeze; give from, the output folder of a run");
    if (water) water->initialise(water->flow.time);  // before the first step of the rags, which would feel its jump as an acceleration
    return {};
  }
  if (!water) throw Error(ExitCode::usage, "[initial_flow] from: this case computes no water; remove it, or give [mesh]");
  if (!frozen) {
    std::string log_message = start_flow(*water, start_settings_, start_folder_).log_message;
    water->initialise(water->flow.time);
    return log_message;
  }
  CachedFlow own;
  CachedFlow& kept = cached_flow_ ? *cached_flow_ : own;
  std::string log_message = "start: frozen water of " + start_folder_.string();
  if (!kept.as_started) {
    const StartedFlow from = start_flow(*water, start_settings_, start_folder_);
    log_message = from.log_message + ", frozen";
    water->initialise(from.time);
    kept.as_started.emplace(water->flow);
  }
  scale_flow(water->flow, *kept.as_started, start_settings_.velocity_factor);
  add_pipe_flow(water->flow, pipe_flow_);
  return log_message;
}

void Simulation::save(CheckpointWriter& writer) const {
  if (mesh) {
    std::vector<std::int64_t> partition;
    for (const int rank : partition_of(*mesh)) partition.push_back(rank);
    writer.shared("mesh/partition", std::span<const std::int64_t>(partition));
    save_cell_centres(writer, *mesh);
  }
  if (water) water->save(writer);
  if (rags) {
    poses->save(writer);
    rags->save(writer);
    writer.shared("passage", std::span<const double>(passage->state()));
  }
  if (coupled) coupled->save(writer);
}

void Simulation::load(CheckpointReader& reader) {
  time_step_ = std::llround(reader.stamp().time / time_settings.step);  // that of the stamp, but where a trial changes the step
  if (water) water->load(reader);
  if (rags) {
    rags->load(reader);
    passage->restore(reader.shared("passage"));
  }
  if (coupled) coupled->load(reader);
}

Simulation::Seconds Simulation::seconds() const {
  Seconds spent;
  if (coupled) {
    spent = {coupled->seconds().flow, coupled->seconds().rags, coupled->seconds().coupling};
  } else {
    (water ? spent.flow : spent.rags) = alone_seconds_;
  }
  return {maximum(comm_, spent.flow), maximum(comm_, spent.rags), maximum(comm_, spent.coupling)};
}

}  // namespace snag
