#include "simulation/output/rag_monitors.hpp"

#include <algorithm>
#include <numbers>

#include "dem/contacts/contact_solver.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

constexpr double degrees = 180 / std::numbers::pi;

std::vector<std::string> rag_columns() {
  return {"time [s]",
          "rag [1]",
          "x [m]",
          "y [m]",
          "z [m]",
          "vx [m/s]",
          "vy [m/s]",
          "vz [m/s]",
          "x_min [m]",
          "y_min [m]",
          "z_min [m]",
          "x_max [m]",
          "y_max [m]",
          "z_max [m]",
          "kinetic_energy [J]",
          "bond_energy [J]",
          "bond_strain_p99 [1]",
          "bond_strain_max [1]",
          "bond_tension_max [N]",
          "broken_bonds [1]",
          "particles_out [1]"};
}

std::vector<std::string> contact_columns() {
  return {"time [s]", "contacts [1]", "wall_contacts [1]", "overlap_over_radius_max [1]", "particles_beyond_walls [1]"};
}

std::vector<std::string> passage_columns() {
  return {"time [s]",
          "rag [1]",
          "angle [deg]",
          "radius [m]",
          "height [m]",
          "particles_upstream [1]",
          "particles_in_casing [1]",
          "particles_out [1]",
          "touching_impeller [1]",
          "touching_tongue [1]",
          "touching_other_wall [1]",
          "max_tension [N]",
          "max_tension_x [m]",
          "max_tension_y [m]",
          "max_tension_z [m]"};
}

std::vector<std::string> force_columns() {
  std::vector<std::string> columns{"time [s]", "rag [1]"};
  for (const char* of : {"fluid", "contact"})
    for (const char* what : {"_mean [N]", "_p50 [N]", "_p90 [N]", "_p99 [N]", "_max [N]"}) columns.push_back(std::string(of) + what);
  columns.emplace_back("in_contact [1]");
  return columns;
}

}  // namespace

RagMonitors::RagMonitors(const std::filesystem::path& folder, const RagSystem& rags, bool with_passage, bool resume, double from_time)
    : with_passage_(with_passage), max_wall_overlap_(rags.rags().size()), max_bond_strain_p99_(rags.rags().size()) {
  together(rags.comm(), [&] {
    if (rank_of(rags.comm()) != 0) return;
    const auto open = [&](const char* name, const std::vector<std::string>& columns) {
      return Series(folder / name, columns, resume, from_time);
    };
    rags_ = open("rags.csv", rag_columns()), contacts_ = open("contacts.csv", contact_columns());
    forces_ = open("rag_forces.csv", force_columns());
    if (with_passage) passage_ = open("passage.csv", passage_columns());
  });
}

void RagMonitors::after_step(RagSystem& rags, const Passage& passage, const RagForces& forces, double time) {
  const std::vector<BondCount> bonds = rags.check();
  const std::vector<RagForceSpread> spreads = force_spreads(rags, forces);
  measure_contacts(rags, time);
  std::vector<double> strain_p99;
  for (std::size_t rag = 0; rag < bonds.size(); ++rag) {
    strain_p99.push_back(bond_strain_quantile(rags, static_cast<int>(rag), 0.99));
    max_bond_strain_p99_[rag] = std::max(max_bond_strain_p99_[rag], strain_p99[rag]);
  }
  if (rank_of(rags.comm()) != 0) return;
  for (std::size_t rag = 0; rag < bonds.size(); ++rag) {
    if (passage.states()[rag].n_particles == 0) continue;
    add_state(rag, passage, bonds[rag], strain_p99[rag], time);
    add_forces(rag, spreads[rag], time);
    if (with_passage_) add_passage(rag, passage, time);
  }
}

void RagMonitors::add_state(std::size_t rag, const Passage& passage, const BondCount& bonds, double strain_p99, double time) {
  const RagState& s = passage.states()[rag];
  rags_.add({time,
             static_cast<double>(rag),
             s.centre.x,
             s.centre.y,
             s.centre.z,
             s.velocity.x,
             s.velocity.y,
             s.velocity.z,
             s.lower.x,
             s.lower.y,
             s.lower.z,
             s.upper.x,
             s.upper.y,
             s.upper.z,
             s.kinetic_energy,
             s.bond_energy,
             strain_p99,
             s.max_bond_strain,
             s.max_bond_tension,
             static_cast<double>(bonds.broken),
             static_cast<double>(passage.n_out()[rag])});
}

void RagMonitors::add_passage(std::size_t rag, const Passage& passage, double time) {
  const RagSnapshot& seen = passage.sightings()[rag];
  std::vector<double> row{time, static_cast<double>(rag), degrees * passage.tracker(rag).angle(), seen.radius, seen.height};
  for (const std::int64_t count : {seen.n_upstream, seen.n_in_casing(), seen.n_out}) row.push_back(static_cast<double>(count));
  for (const WallRegion region : wall_regions) row.push_back(static_cast<double>(seen.touching[region]));
  row.insert(row.end(), {seen.tension, seen.tension_place.x, seen.tension_place.y, seen.tension_place.z});
  passage_.add(row);
}

void RagMonitors::add_forces(std::size_t rag, const RagForceSpread& spread, double time) {
  std::vector<double> row{time, static_cast<double>(rag)};
  for (const ForceSpread& s : {spread.fluid, spread.contact}) row.insert(row.end(), {s.mean, s.p50, s.p90, s.p99, s.largest});
  row.push_back(static_cast<double>(spread.n_in_contact));
  forces_.add(row);
}

void RagMonitors::measure_contacts(RagSystem& rags, double time) {
  ContactSolver& contacts = *rags.contacts();
  const ContactMeasures& m = contacts.measures();
  std::vector<double> extremes{m.max_overlap_over_radius};
  std::vector<std::int64_t> counts{m.n_contacts, m.n_wall_contacts, 0};
  extremes.insert(extremes.end(), m.max_wall_overlap_over_radius.begin(), m.max_wall_overlap_over_radius.end());
  for (const std::int64_t beyond : m.beyond_walls) counts[2] += beyond;
  MPI_Allreduce(MPI_IN_PLACE, extremes.data(), static_cast<int>(extremes.size()), MPI_DOUBLE, MPI_MAX, rags.comm());
  MPI_Allreduce(MPI_IN_PLACE, counts.data(), static_cast<int>(counts.size()), MPI_INT64_T, MPI_SUM, rags.comm());
  contacts.reset_measures();
  max_overlap_ = std::max(max_overlap_, extremes[0]);
  for (std::size_t rag = 0; rag < max_wall_overlap_.size(); ++rag)
    max_wall_overlap_[rag] = std::max(max_wall_overlap_[rag], extremes[1 + rag]);
  const auto n_beyond = static_cast<double>(counts[2]);
  most_beyond_walls_ = std::max(most_beyond_walls_, n_beyond);
  if (rank_of(rags.comm()) == 0)
    contacts_.add({time, static_cast<double>(counts[0]), static_cast<double>(counts[1]), extremes[0], n_beyond});
}

std::vector<double> RagMonitors::state() const {
  std::vector<double> state{max_overlap_, most_beyond_walls_};
  state.insert(state.end(), max_wall_overlap_.begin(), max_wall_overlap_.end());
  state.insert(state.end(), max_bond_strain_p99_.begin(), max_bond_strain_p99_.end());
  return state;
}

void RagMonitors::restore(const std::vector<double>& state) {
  max_overlap_ = state.at(0), most_beyond_walls_ = state.at(1);
  const auto middle = state.begin() + 2 + static_cast<std::ptrdiff_t>(max_wall_overlap_.size());
  max_wall_overlap_.assign(state.begin() + 2, middle);
  max_bond_strain_p99_.assign(middle, state.end());
}

}  // namespace snag
