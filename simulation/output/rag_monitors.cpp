#include "simulation/output/rag_monitors.hpp"

#include <algorithm>
#include <numbers>

#include "dem/contacts/contact_solver.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

constexpr double degrees = 180 / std::numbers::pi;

using Columns = std::vector<Column<RagRecord>>;
using Record = const RagRecord&;

double number(std::int64_t count) { return static_cast<double>(count); }

Columns columns_of_a_rag() {
  return {{"time", "s", [](Record r) { return r.time; }}, {"rag", "1", [](Record r) { return static_cast<double>(r.rag); }}};
}

Columns state_columns() {
  Columns all = columns_of_a_rag();
  add_components(all, "", "", "m", [](Record r) { return r.state.centre; });
  add_components(all, "v", "", "m/s", [](Record r) { return r.state.velocity; });
  add_components(all, "", "_min", "m", [](Record r) { return r.state.lower; });
  add_components(all, "", "_max", "m", [](Record r) { return r.state.upper; });
  all.insert(all.end(), {{"kinetic_energy", "J", [](Record r) { return r.state.kinetic_energy; }},
                         {"bond_energy", "J", [](Record r) { return r.state.bond_energy; }},
                         {"bond_strain_p99", "1", [](Record r) { return r.strain_p99; }},
                         {"bond_strain_max", "1", [](Record r) { return r.state.max_bond_strain; }},
                         {"bond_tension_max", "N", [](Record r) { return r.state.max_bond_tension; }},
                         {"broken_bonds", "1", [](Record r) { return number(r.n_broken); }},
                         {"particles_out", "1", [](Record r) { return number(r.n_out); }}});
  return all;
}

std::vector<Column<ContactRecord>> contact_columns() {
  return {{"time", "s", [](const ContactRecord& r) { return r.time; }},
          {"contacts", "1", [](const ContactRecord& r) { return number(r.n); }},
          {"wall_contacts", "1", [](const ContactRecord& r) { return number(r.n_of_walls); }},
          {"overlap_over_radius_max", "1", [](const ContactRecord& r) { return r.max_overlap_over_radius; }},
          {"particles_beyond_walls", "1", [](const ContactRecord& r) { return number(r.n_beyond_walls); }},
          {"sub_steps", "1", [](const ContactRecord& r) { return number(r.n_sub_steps); }}};
}

Columns passage_columns() {
  Columns all = columns_of_a_rag();
  all.insert(all.end(), {{"angle", "deg", [](Record r) { return degrees * r.angle; }},
                         {"radius", "m", [](Record r) { return r.seen.radius; }},
                         {"height", "m", [](Record r) { return r.seen.height; }},
                         {"particles_upstream", "1", [](Record r) { return number(r.seen.n_upstream); }},
                         {"particles_in_casing", "1", [](Record r) { return number(r.seen.n_in_casing()); }},
                         {"particles_out", "1", [](Record r) { return number(r.seen.n_out); }},
                         {"touching_impeller", "1", [](Record r) { return number(r.seen.touching[WallRegion::impeller]); }},
                         {"touching_tongue", "1", [](Record r) { return number(r.seen.touching[WallRegion::tongue]); }},
                         {"touching_other_wall", "1", [](Record r) { return number(r.seen.touching[WallRegion::other]); }},
                         {"max_tension", "N", [](Record r) { return r.seen.tension; }}});
  add_components(all, "max_tension_", "", "m", [](Record r) { return r.seen.tension_place; });
  return all;
}

Columns force_columns() {
  Columns all = columns_of_a_rag();
  for (const auto& [name, of] : {std::pair{"fluid", &RagForceSpread::fluid}, {"contact", &RagForceSpread::contact}})
    for (const auto& [what, value] : {std::pair{"_mean", &ForceSpread::mean},
                                      {"_p50", &ForceSpread::p50},
                                      {"_p90", &ForceSpread::p90},
                                      {"_p99", &ForceSpread::p99},
                                      {"_max", &ForceSpread::largest}})
      all.push_back({std::string(name) + what, "N", [of = of, value = value](Record r) { return r.forces.*of.*value; }});
  all.push_back({"in_contact", "1", [](Record r) { return number(r.forces.n_in_contact); }});
  return all;
}

}  // namespace

RagMonitors::RagMonitors(const std::filesystem::path& folder, const RagSystem& rags, bool with_passage, bool resume, double from_time)
    : with_passage_(with_passage), max_wall_overlap_(rags.rags().size()), max_bond_strain_p99_(rags.rags().size()) {
  on_all_ranks(rags.comm(), [&] {
    if (rank_of(rags.comm()) != 0) return;
    const auto open = [&](const char* name, Columns columns) {
      return Monitor<RagRecord>(folder / name, std::move(columns), resume, from_time);
    };
    rags_ = open("rags.csv", state_columns());
    contacts_ = Monitor<ContactRecord>(folder / "contacts.csv", contact_columns(), resume, from_time);
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
    const RagRecord record{.time = time,
                           .rag = rag,
                           .state = passage.states()[rag],
                           .n_broken = bonds[rag].broken,
                           .n_out = passage.n_out()[rag],
                           .strain_p99 = strain_p99[rag],
                           .forces = spreads[rag],
                           .seen = passage.sightings()[rag],
                           .angle = passage.tracker(rag).angle()};
    rags_.add(record), forces_.add(record);
    if (with_passage_) passage_.add(record);
  }
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
  most_beyond_walls_ = std::max(most_beyond_walls_, number(counts[2]));
  if (rank_of(rags.comm()) == 0)
    contacts_.add({.time = time,
                   .n = counts[0],
                   .n_of_walls = counts[1],
                   .n_beyond_walls = counts[2],
                   .n_sub_steps = rags.n_last_sub_steps(),
                   .max_overlap_over_radius = extremes[0]});
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
