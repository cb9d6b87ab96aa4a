#include "coupling/coupling_settings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>

#include "base/case_tables.hpp"
#include "base/error.hpp"
#include "base/words.hpp"
#include "coupling/kernel.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {

const std::string gravity = "gravity";

// Below this width over diameter the averaged velocity holds most of the particle's own wake.
constexpr double least_width_over_diameter = 1;
// The same for cloth, whose particles stand in one wake: down to this width drag and path depend by 1 % on their size
// (cases/study-independence).
constexpr double least_width_over_diameter_of_cloth = 0.5;
// Below it a kernel reads single cells (water_prediction.hpp), whose centres may lie half a cell from the particle.
constexpr double least_width_over_cell = 0.375;
// Above this many cells a particle the transfers cost more than the flow.
constexpr std::int64_t most_cells_per_particle = 3000;
// A held square sheet drags as a rigid plate within 4 % up to this width over its side, and 13 % more at twice of it.
constexpr double largest_width_over_sheet = 0.125;
constexpr int least_rows = 3;  // of a sheet; fewer are a thread or a strap
// For cloth in a case that gives no width, m. Path, drag and impulse do not depend on the width (3 %) for a free rag from 6 to 36 mm, for a
// held sheet of 100 mm from 6 to 24 mm, for the rag of pump-demo from 3 to 6 mm: cases/study-kernel.
constexpr double width_for_cloth = 6e-3;

/// The shorter side of a cloth, m.
double shorter_side(const Rag& rag) { return 2 * rag.radius * std::min(rag.n_columns, rag.n_rows); }
bool is_sheet(const Rag& rag) { return std::min(rag.n_columns, rag.n_rows) >= least_rows; }

double largest_diameter(const std::vector<Rag>& rags) {
  double largest = 0;
  for (const Rag& rag : rags) largest = std::max(largest, rag.hydrodynamic_diameter);
  return largest;
}

double least_over_diameter(const Rag& rag) { return is_sheet(rag) ? least_width_over_diameter_of_cloth : least_width_over_diameter; }
/// The piece whose particles ask for the widest kernel; at least one piece.
const Rag& coarsest(const std::vector<Rag>& rags) {
  return *std::ranges::max_element(rags, {}, [](const Rag& rag) { return least_over_diameter(rag) * rag.hydrodynamic_diameter; });
}

/// Kernel width of a case that gives none, m. The particles of a cloth are a choice of resolution, so its width does not depend on them;
/// spheres and fibres are as thick as they are.
double automatic_width(const std::vector<Rag>& rags) {
  double narrowest = std::numeric_limits<double>::infinity();
  for (const Rag& rag : rags)
    if (is_sheet(rag)) narrowest = std::min({narrowest, width_for_cloth, largest_width_over_sheet * shorter_side(rag)});
  if (std::isfinite(narrowest)) return narrowest;
  const double d = largest_diameter(rags);
  return d > 0 ? 2 * d : 1e-3;
}

}  // namespace

const std::vector<ForceSet>& force_sets() {
  static const std::vector<ForceSet> sets{
      {"recommended",
       {"free_stream_drag", "sheet_drag", "pressure_gradient", "added_mass"},
       "resistance of the cloth across and along itself, inertia of the water; with [gravity] weight and buoyancy"},
      {"published", {"free_stream_drag"}, "as in the published simulations: drag of free spheres, no inertia of the water"}};
  return sets;
}

std::vector<std::string> spelt_out(const std::vector<std::string>& names) {
  std::vector<std::string> forces;
  for (const std::string& name : names) {
    const auto set = std::find_if(force_sets().begin(), force_sets().end(), [&](const ForceSet& s) { return s.name == name; });
    if (set == force_sets().end())
      forces.push_back(name);
    else
      forces.insert(forces.end(), set->forces.begin(), set->forces.end());
  }
  return forces;
}

Section CouplingSettings::section() {
  std::string sets;
  for (const ForceSet& set : force_sets()) sets += " \"" + set.name + "\": " + joined(set.forces) + " (" + set.meaning + ").";
  return {
      "coupling",
      "Forces between water and rags.",
      {setting("mode", &mode,
               "none: rags and water ignore each other; one_way: rags feel the water; two_way: and the water feels the rags."),
       setting("kernel", &kernel, "Smoothing kernel between particles and cells.", kernel_shapes().names()),
       {"kernel_width", &kernel_width, "m", 1e-6, 10, Basis::assumed,
        "Rms width per axis of the kernel, for every kernel but cell; a physical length, not a cell count. Chosen: 6 mm for cloth, or an "
        "eighth of the shorter side of the smallest cloth where that is less; without cloth twice the largest diameter."},
       setting("forces", &forces, "Forces of the water on a particle: " + joined(fluid_forces().names()) + ", or sets of them." + sets)}};
}

double Coupling::kernel_width(const std::vector<Rag>& rags) const { return settings.kernel_width.value_or(automatic_width(rags)); }

namespace {

/// Each law of drag is that of the whole drag: one of them acts. What changes a drag has one to change.
void check_drag(const std::string& where, const std::vector<std::unique_ptr<FluidForce>>& forces) {
  std::string law, modifier;
  bool is_there = false;
  for (const auto& force : forces) {
    const ForceDescription description = force->description();
    if (description.role == Role::drag && !law.empty())
      throw Error(ExitCode::usage, where + " forces: \"" + law + "\" and \"" + description.name +
                                       "\" are both laws of the whole drag, and would add up; write one of them");
    if (description.role == Role::drag) law = description.name;
    if (description.role == Role::drag_modifier && modifier.empty()) modifier = description.name;
    is_there = is_there || description.role == Role::drag || description.role == Role::drag_replacement;
  }
  if (!modifier.empty() && !is_there)
    throw Error(ExitCode::usage, where + " forces: \"" + modifier +
                                     "\" changes the drag, but no force of the list gives one; add a law of drag such as "
                                     "\"schiller_naumann\", of cloth \"sheet_drag\"");
}

}  // namespace

Coupling read_coupling(const Table& root, bool two_way_possible) {
  Coupling coupling;
  CouplingSettings& settings = coupling.settings;
  if (!two_way_possible) settings.mode = CouplingSettings::Mode::one_way;
  const Table table = root.table("coupling");
  table.read(settings.section().parameters);
  if (settings.two_way() && !two_way_possible)
    throw Error(ExitCode::usage,
                table.where() + " mode is \"two_way\", but a prescribed flow cannot react to the rags; write mode = \"one_way\"");

  coupling.shape = kernel_shapes().make(settings.kernel, table.where() + " kernel");
  table.table(settings.kernel).read(coupling.shape->parameters());
  const Table weight = root.table(gravity);
  std::vector<std::string> names = settings.forces = spelt_out(settings.forces);
  for (auto name = names.begin(); name != names.end(); ++name)
    if (std::find(names.begin(), name, *name) != name)
      throw Error(ExitCode::usage, table.where() + " forces: \"" + *name + "\" is listed twice");
  if (weight.present() && std::find(names.begin(), names.end(), gravity) == names.end()) names.push_back(gravity);
  for (const std::string& name : names) {
    auto force = fluid_forces().make(name, table.where() + " forces");
    // The acceleration of gravity stands in a table of its own, because rags without water read it too.
    (name == gravity ? weight : table.table(name)).read(force->parameters());
    force->set_coupling(settings.two_way());
    const bool acts = settings.mode != CouplingSettings::Mode::none || name == gravity;
    if (acts) coupling.forces.push_back(std::move(force));
  }
  check_drag(table.where(), coupling.forces);
  return coupling;
}

Vec3 read_gravity(const Table& root) {
  const Table weight = root.table(gravity);
  if (!weight.present()) return {};
  const auto force = fluid_forces().make(gravity, weight.where());
  const std::vector<Parameter> acceleration = force->parameters();
  weight.read(acceleration);
  return *std::get<Vec3*>(acceleration.front().target);
}

std::vector<Section> coupling_sections() {
  // The records point into these models: they live as long as the program.
  static CouplingSettings settings;
  static const auto forces = fluid_forces().make_all();
  static const auto shapes = kernel_shapes().make_all();
  std::vector<Section> sections{settings.section()};
  for (const auto& force : forces) {
    const ForceDescription description = force->description();
    sections.push_back({description.name == gravity ? gravity : "coupling." + description.name,
                        description.equation + ". Source: " + description.source + ". Valid for: " + description.valid_for + "." +
                            (description.reacts_on_fluid ? "" : " Does not react on the water."),
                        force->parameters()});
  }
  const std::vector<std::string> names = kernel_shapes().names();  // in the order of make_all
  for (std::size_t i = 0; i < names.size(); ++i) {
    auto parameters = shapes[i]->parameters();
    if (!parameters.empty())
      sections.push_back({"coupling." + names[i], shapes[i]->equation() + ". Source: " + shapes[i]->source() + ".", std::move(parameters)});
  }
  return sections;
}
const bool coupling_tables = add_case_table(230, coupling_sections);

namespace {

/// Mean size V^(1/3) of the cells that hold the places of all ranks, m; 0 without places. Collective.
double mean_cell_size(const Mesh& mesh, std::span<const Vec3> places) {
  const auto shape = kernel_shapes().make("cell", "[coupling]");
  Kernel holder(*shape, 1, mesh);
  holder.locate(places);
  std::vector<double> size(static_cast<std::size_t>(mesh.n_cells));
  for (int c = 0; c < mesh.n_cells; ++c) size[c] = std::cbrt(mesh.cell_volume[c]);
  const CellField field{size.data(), 1};
  const std::vector<double> at_places = holder.average(std::span(&field, 1));
  const auto n = static_cast<double>(sum(mesh.comm, static_cast<std::int64_t>(places.size())));
  return n > 0 ? sum(mesh.comm, at_places) / n : 0;
}

}  // namespace

std::vector<std::string> kernel_warnings(const Coupling& coupling, const std::vector<Rag>& rags, const Mesh& mesh,
                                         std::span<const Vec3> places) {
  const double d = largest_diameter(rags), width = coupling.kernel_width(rags);
  const double size = mean_cell_size(mesh, places);
  if (size == 0) return {};  // no particle is known yet

  std::vector<std::string> warnings;
  const auto warn = [&](auto&&... words) {
    std::ostringstream message;
    message.precision(3);
    (message << ... << words);
    warnings.push_back(message.str());
  };
  if (coupling.settings.mode == CouplingSettings::Mode::none) return warnings;
  const bool two_way = coupling.settings.two_way();
  if (!coupling.shape->has_width()) {
    if (two_way && d > size)
      warn("[coupling] kernel \"cell\": particles of ", d * 1e3, " mm are larger than the cells where they are (mean ", size * 1e3,
           " mm), so that what they feel is mostly their own wake and depends on the mesh; use kernel = \"gaussian\" or \"wendland\"");
    return warnings;
  }
  if (const Rag& rag = coarsest(rags); two_way && width < least_over_diameter(rag) * rag.hydrodynamic_diameter)
    warn("[coupling] kernel_width is ", width * 1e3, " mm, ", width / rag.hydrodynamic_diameter, " of the particle diameter (",
         rag.hydrodynamic_diameter * 1e3, " mm), advised at least ", least_over_diameter(rag),
         ": below it particles feel their own wake; widen the kernel");
  if (width < least_width_over_cell * size)
    warn("[coupling] kernel_width is ", width * 1e3, " mm, ", width / size, " of the cells where the particles are (mean ", size * 1e3,
         " mm), advised at least ", least_width_over_cell,
         ": below it the kernel is the nearest cell; widen the kernel or refine the mesh");
  if (const double largest = coupling.shape->largest_width_over_cell(); width > largest * size)
    warn("[coupling] kernel_width is ", width * 1e3, " mm, ", width / size, " of the cells where the particles are (mean ", size * 1e3,
         " mm), advised at most ", largest, " for kernel \"", coupling.settings.kernel,
         "\": cells between its points get nothing; narrow the kernel, or use kernel = \"gaussian\"");
  const bool has_sheet_drag =
      std::ranges::any_of(coupling.forces, [](const auto& force) { return force->description().name == "sheet_drag"; });
  const Rag* narrowest = nullptr;  // sheet: one warning for all, they may be many copies
  for (const Rag& rag : rags)
    if (is_sheet(rag) && (!narrowest || shorter_side(rag) < shorter_side(*narrowest))) narrowest = &rag;
  if (two_way && has_sheet_drag && narrowest && width > largest_width_over_sheet * shorter_side(*narrowest))
    warn("[coupling] kernel_width is ", width * 1e3, " mm, ", width / shorter_side(*narrowest), " of the shorter side of cloth \"",
         narrowest->name, "\" (", shorter_side(*narrowest) * 1e3, " mm), advised at most ", largest_width_over_sheet,
         ": it acts as a larger cloth, at a quarter with 13 % more drag across the stream; narrow the kernel");
  const std::int64_t most_cells =
      std::llround(std::min(coupling.shape->cells_reached(width, size), static_cast<double>(mesh.n_cells_global)));
  if (most_cells > most_cells_per_particle)
    warn("[coupling] kernel_width is ", width * 1e3, " mm and reaches some ", most_cells, " of the cells (mean ", size * 1e3,
         " mm) around a particle, advised at most ", most_cells_per_particle, ": transfers will be slow; narrow the kernel");
  return warnings;
}

std::vector<std::string> wall_warnings(const Coupling& coupling, bool rags_know_walls, bool water_has_walls) {
  std::vector<std::string> warnings;
  if (rags_know_walls) return warnings;
  for (const auto& force : coupling.forces) {
    const ForceDescription description = force->description();
    if (description.samples.wall && (water_has_walls || description.role == Role::drag_modifier))
      warnings.push_back(
          "[coupling] forces: " + description.name +
          " looks for the nearest wall, but the case has no [[wall]], so that it takes the particles to be far from walls; add "
          "[[wall]] with kind = \"patches\"");
  }
  return warnings;
}

std::string undragged_warning(const Coupling& coupling, const std::vector<Rag>& rags) {
  bool of_particles = false, of_cloth = false, of_fibres = false;
  for (const auto& force : coupling.forces) {
    const ForceDescription description = force->description();
    of_particles = of_particles || description.role == Role::drag;
    of_cloth = of_cloth || description.name == "sheet_drag";
    of_fibres = of_fibres || description.name == "fibre_drag";
  }
  if (coupling.settings.mode == CouplingSettings::Mode::none || of_particles || !(of_cloth || of_fibres)) return "";
  const auto is_dragged = [&](const Rag& rag) {
    return std::min(rag.n_columns, rag.n_rows) > 1 ? of_cloth : of_fibres && rag.n_particles > 1;
  };
  const auto rag = std::ranges::find_if_not(rags, is_dragged);
  if (rag == rags.end()) return "";
  const std::string laws = of_cloth && of_fibres ? "sheet_drag acts on cloth and fibre_drag on fibres"
                           : of_cloth            ? "sheet_drag acts on cloth"
                                                 : "fibre_drag acts on fibres";
  return "[coupling] forces: " + laws + " alone, and \"" + rag->name +
         "\" is neither dragged by that nor by another force; add a law of drag of single particles, \"free_stream_drag\"";
}

std::string viscous_step_warning(const Coupling& coupling, const std::vector<Rag>& rags, double step, double viscosity) {
  const double width = coupling.kernel_width(rags);
  if (!coupling.settings.two_way() || !coupling.shape->has_width() || std::ranges::none_of(rags, is_sheet)) return "";
  const double longest = width * width / viscosity;
  if (step <= longest) return "";
  return "[time] step is " + number_text(step) + " s, " + number_text(step / longest) +
         " times the square of kernel_width over the viscosity of the water (" + number_text(longest) +
         " s), advised at most 1: friction carries the impulse of the cloth out of its kernel within the step; slow cloth is bent too "
         "little "
         "and may move several times too fast; take smaller steps, or a wider kernel";
}

std::string assumed_kernel_width(const Coupling& coupling, const std::vector<Rag>& rags) {
  const double width = coupling.kernel_width(rags);
  const bool is_used = coupling.settings.mode != CouplingSettings::Mode::none && coupling.shape->has_width();
  if (!is_used || coupling.settings.kernel_width || rags.empty()) return "";
  return "[coupling] kernel_width is not given: " + number_text(1e3 * width) +
         (std::ranges::any_of(rags, is_sheet) ? " mm for cloth, independent of its particles" : " mm, twice the largest diameter");
}

std::vector<std::string> left_out_added_mass(const Coupling& coupling, const std::vector<Rag>& rags) {
  std::vector<std::string> lines;
  if (coupling.settings.mode != CouplingSettings::Mode::one_way) return lines;
  for (const Rag& rag : rags) {
    if (!is_sheet(rag)) continue;
    const double width = shorter_side(rag), length = 2 * rag.radius * std::max(rag.n_columns, rag.n_rows);
    std::ostringstream line;
    line.precision(3);
    line << "one-way coupling: cloth \"" << rag.name << "\" (" << 1e3 * static_cast<double>(rag.n_particles) * rag.mass
         << " g) does not move the water. Flat and accelerated across itself, it would take up to "
         << 1e3 * std::numbers::pi / 4 * width * width * length
         << " L of water with it; crumpled, much less. mode = \"two_way\" has this inertia";
    lines.push_back(line.str());
  }
  return lines;
}

}  // namespace snag
