#include "solver/boundaries/boundary.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/case_tables.hpp"
#include "base/error.hpp"
#include "base/words.hpp"
#include "mesh/regions.hpp"
#include "parallel/rows.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {

struct Heading {
  std::string patch, kind;
  std::vector<std::string> patches;
  InletTurbulence turbulence;

  std::vector<Parameter> parameters() {
    Parameter kind_of_it = setting("kind", &kind, "Kind of the condition.", boundaries().names());
    kind_of_it.required = true;
    std::vector<Parameter> all{setting("patch", &patch, "Name of the patch in the mesh."),
                               setting("patches", &patches, "Several patches with the same condition, each for itself."), kind_of_it};
    for (Parameter& parameter : turbulence.parameters()) all.push_back(std::move(parameter));
    return all;
  }
};

std::vector<std::string> patch_names(const Mesh& mesh) {
  std::vector<std::string> names;
  for (const Patch& patch : mesh.patches) names.push_back(patch.name);
  return names;
}

}  // namespace

Side Boundary::velocity_side() const {
  switch (fixes()) {
    case PrescribedQuantity::velocity:
      return Side::value;
    case PrescribedQuantity::pressure:
      return Side::slope;
    case PrescribedQuantity::normal_velocity:
      break;
  }
  return Side::mirror;
}

FaceFlux Boundary::flux() const {
  switch (fixes()) {
    case PrescribedQuantity::velocity:
      return FaceFlux::given;
    case PrescribedQuantity::pressure:
      return FaceFlux::from_cell;
    case PrescribedQuantity::normal_velocity:
      break;
  }
  return FaceFlux::tight;
}

Registry<Boundary>& boundaries() {
  static Registry<Boundary> registry("boundary kind");
  return registry;
}

std::vector<PatchBoundary> read_boundaries(const Table& root) {
  std::vector<PatchBoundary> conditions;
  for (const Table& table : root.tables("boundary")) {
    Heading heading;
    table.read(heading.parameters());
    if (heading.patch.empty() == heading.patches.empty())
      throw Error(ExitCode::usage, table.where() + ": give either patch = \"name\" or patches = [\"name\", ...]");
    if (heading.patches.empty()) heading.patches.push_back(heading.patch);
    for (const std::string& patch : heading.patches) {
      auto boundary = boundaries().make(heading.kind, table.where());
      table.read(boundary->section().parameters);
      if (heading.turbulence.given() && !boundary->is_open())
        throw Error(ExitCode::usage, table.where() + ": keys turbulence_... are allowed only where fluid enters; kind = \"" + heading.kind +
                                         "\" has no inflow; remove them");
      conditions.push_back({patch, table.where(), std::move(boundary), heading.turbulence});
    }
  }
  return conditions;
}

std::vector<Section> boundary_sections() {
  // The records point into these: they live as long as the program.
  static Heading heading;
  static std::vector<std::unique_ptr<Boundary>> kinds;
  kinds.clear();
  std::vector<Section> sections{{.name = "boundary",
                                 .meaning = "Condition of the flow on patches of the mesh; every patch needs one.",
                                 .parameters = heading.parameters(),
                                 .repeated = true}};
  for (const std::string& name : boundaries().names()) {
    kinds.push_back(boundaries().make(name, "manual"));
    Section section = kinds.back()->section();
    section.name = "boundary";
    section.meaning = "kind = \"" + name + "\": " + section.meaning;
    section.repeated = true;
    sections.push_back(section);
  }
  return sections;
}
const bool boundary_tables = add_case_table(60, boundary_sections);

BoundarySet::BoundarySet(const Mesh& mesh, std::vector<PatchBoundary> conditions) : mesh_(mesh), conditions_(mesh.patches.size()) {
  const auto names = patch_names(mesh);
  for (PatchBoundary& condition : conditions) {
    std::size_t p = 0;
    while (p < names.size() && names[p] != condition.patch) ++p;
    if (p == names.size()) {
      const auto near = nearest_name(condition.patch, names);
      throw Error(ExitCode::usage, condition.where + ": the mesh has no patch \"" + condition.patch + "\"; it has: " + joined(names) +
                                       (near.empty() ? "" : "; did you mean \"" + near + "\"?"));
    }
    if (conditions_[p].boundary)
      throw Error(ExitCode::usage, condition.where + ": patch \"" + condition.patch + "\" already has a condition (" +
                                       conditions_[p].where + "); remove one");
    conditions_[p] = std::move(condition);
  }
  std::vector<std::string> missing;
  for (std::size_t p = 0; p < names.size(); ++p)
    if (!conditions_[p].boundary) missing.push_back(names[p]);
  if (!missing.empty())
    throw Error(ExitCode::usage,
                "[[boundary]]: no condition for patch " + joined(missing) +
                    "; add a table [[boundary]] with patch and kind for each; known kinds: " + joined(boundaries().names()));

  const std::size_t n = static_cast<std::size_t>(mesh.n_faces - mesh.n_interior);
  values_ = {std::vector<Vec3>(n), std::vector<double>(n), std::vector<double>(n), std::vector<Vec3>(n), std::vector<Vec3>(n)};
  for (std::size_t p = 0; p < conditions_.size(); ++p) {
    conditions_[p].boundary->prepare(mesh, mesh.patches[p], conditions_);
    conditions_[p].turbulence.prepare(mesh, mesh.patches[p], conditions_[p].where);
    velocity_sides_.push_back(conditions_[p].boundary->velocity_side());
    pressure_sides_.push_back(conditions_[p].boundary->pressure_side());
    fixes_pressure_ = fixes_pressure_ || (pressure_sides_.back() == Side::value && mesh.patches[p].count_global > 0);
  }
  for (std::size_t p = 0; p < conditions_.size(); ++p)
    for (int f = mesh.patches[p].first; flux(static_cast<int>(p)) == FaceFlux::given && f < mesh.patches[p].end(); ++f)
      given_faces_.push_back(f - mesh.n_interior);
  find_loose_regions();
}

/// Where water passes through several parts of the mesh that no face joins: those in which no opening gives the pressure.
void BoundarySet::find_loose_regions() {
  struct Opening {
    std::int64_t region;
    int patch;
    bool fixes_pressure;
    Vec3 place;
  };
  const auto same = [](const Opening& a, const Opening& b) { return a.region == b.region && a.patch == b.patch; };
  const std::vector<std::int64_t> region = regions(mesh_);
  std::vector<Opening> openings;
  for (int p = 0; p < static_cast<int>(conditions_.size()); ++p) {
    if (!is_open(p)) continue;
    for (int f = mesh_.patches[p].first; f < mesh_.patches[p].end(); ++f) {
      const Opening one{region[mesh_.owner[f]], p, pressure_sides_[p] == Side::value, mesh_.face_centre[f]};
      if (openings.empty() || !same(openings.back(), one)) openings.push_back(one);
    }
  }
  openings = gathered(mesh_.comm, openings);
  if (std::ranges::all_of(openings, [&](const Opening& one) { return one.region == openings[0].region; })) return;
  for (const Opening& one : openings) {
    const auto in_region = [&](const Opening& other) { return other.region == one.region; };
    if (std::ranges::any_of(openings, [&](const Opening& other) { return in_region(other) && other.fixes_pressure; })) continue;
    if (std::ranges::any_of(loose_regions_, [&](const LooseRegion& known) { return known.id == one.region; })) continue;
    LooseRegion& loose = loose_regions_.emplace_back(LooseRegion{one.region, one.patch, one.place, {}});
    std::ranges::copy_if(given_faces_, std::back_inserter(loose.faces),
                         [&](int b) { return region[mesh_.owner[mesh_.n_interior + b]] == one.region; });
  }
}

void BoundarySet::check_loose_regions() const {
  for (const LooseRegion& loose : loose_regions_) {
    const NetFlux flux = net_flux(loose.faces);
    if (flux.is_balanced()) continue;
    const PatchBoundary& opening = conditions_[loose.patch];
    throw Error(
        ExitCode::usage,
        opening.where + ": the cells at patch \"" + opening.patch + "\", " + point_text(loose.place) +
            ", are not joined to those at other openings; no opening of theirs gives the pressure, and their net flow out (" +
            number_text(flux.net) +
            " m3/s) must then be zero; join the volumes (gmsh: BooleanFragments), or give one patch of theirs kind = \"pressure_outlet\"");
  }
}

void BoundarySet::update(const Flow& flow, double time) {
  for (std::size_t p = 0; p < conditions_.size(); ++p) conditions_[p].boundary->respond(flow, mesh_.patches[p], time);
  for (std::size_t p = 0; p < conditions_.size(); ++p) conditions_[p].boundary->update(flow, mesh_.patches[p], time, values_);
  if (!fixes_pressure_) carry_off_the_rest(), check_net_flux();
  check_loose_regions();
}

BoundaryValues BoundarySet::exchange_for_rest_state() {
  BoundaryValues before = values_;
  std::fill(values_.flux.begin(), values_.flux.end(), 0.0);
  std::fill(values_.velocity.begin(), values_.velocity.end(), Vec3{});
  std::fill(values_.acceleration.begin(), values_.acceleration.end(), Vec3{});
  return before;
}

std::vector<double> BoundarySet::knots() const {
  std::vector<double> all;
  for (const PatchBoundary& condition : conditions_) {
    const std::vector<double> knots = condition.boundary->knots();
    all.insert(all.end(), knots.begin(), knots.end());
  }
  return all;
}

std::vector<std::string> BoundarySet::unmet(const Flow& flow) const {
  std::vector<std::string> all;
  for (std::size_t p = 0; p < conditions_.size(); ++p)
    if (std::string one = conditions_[p].boundary->unmet(flow, mesh_.patches[p]); !one.empty()) all.push_back(std::move(one));
  return all;
}

std::vector<double> BoundarySet::state() const {
  std::vector<double> all;
  for (const PatchBoundary& condition : conditions_) {
    const std::vector<double> state = condition.boundary->state();
    all.insert(all.end(), state.begin(), state.end());
  }
  return all;
}

void BoundarySet::restore_state(const std::vector<double>& state) {
  auto next = state.begin();
  for (const PatchBoundary& condition : conditions_) {
    const auto length = static_cast<std::ptrdiff_t>(condition.boundary->state().size());
    condition.boundary->restore({next, next + length});
    next += length;
  }
}

BoundarySet::NetFlux BoundarySet::net_flux(std::span<const int> faces) const {
  std::vector<double> out, carried;
  for (const int b : faces) {
    out.push_back(values_.flux[b]);
    // Also what a wall carries along itself: the fluxes of a drum that turns are round-off of that.
    carried.push_back(std::abs(values_.flux[b]) + norm(values_.velocity[b]) * norm(mesh_.face_vector[mesh_.n_interior + b]));
  }
  return {sum(mesh_.comm, std::span<const double>(out)), sum(mesh_.comm, std::span<const double>(carried))};
}

/// Outlets whose velocity comes from the flow take what is left of the balance, at one speed along their normals.
void BoundarySet::carry_off_the_rest() {
  const auto for_each_face = [&](const auto& visit) {
    for (std::size_t p = 0; p < conditions_.size(); ++p) {
      const int patch = static_cast<int>(p);
      if (!is_outlet(patch) || flux(patch) != FaceFlux::given) continue;
      for (int f = mesh_.patches[p].first; f < mesh_.patches[p].end(); ++f) visit(f, f - mesh_.n_interior);
    }
  };
  std::vector<double> areas;
  for_each_face([&](int f, int) { areas.push_back(norm(mesh_.face_vector[f])); });
  const double area = sum(mesh_.comm, std::span<const double>(areas));
  if (area == 0) return;
  const double speed = -net_flux(given_faces_).net / area;
  for_each_face([&](int f, int b) {
    values_.velocity[b] += speed * unit(mesh_.face_vector[f]), values_.flux[b] += speed * norm(mesh_.face_vector[f]);
  });
}

void BoundarySet::check_net_flux() const {
  const NetFlux flux = net_flux(given_faces_);
  if (!flux.is_balanced())
    throw Error(ExitCode::usage, "[[boundary]]: net flow out of the domain (" + number_text(flux.net) +
                                     " m3/s) must be zero where no patch fixes the pressure; give one patch kind = \"pressure_outlet\"");
}

}  // namespace snag
