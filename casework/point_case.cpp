#include "casework/point_case.hpp"

#include <mpi.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/parameter_text.hpp"
#include "base/units.hpp"
#include "base/words.hpp"
#include "casework/key_changes.hpp"
#include "casework/library.hpp"
#include "coupling/coupling_settings.hpp"
#include "coupling/fluid_force.hpp"
#include "diagnosis/statistics/statistics.hpp"
#include "simulation/setup/simulation.hpp"

namespace snag {

struct PointCase::Tree {
  toml::table root;
};

namespace {

constexpr const char* drag_slope = "drag_law_uncertainty.slope";
const std::map<std::string, std::string> former_inputs{{"drag_form", drag_law_uncertainty},
                                                       {"drag_form_of_point", drag_law_uncertainty_per_point}};

bool is_zero(const toml::node* node) {
  if (!node) return true;
  if (const auto* list = node->as_array()) return std::all_of(list->begin(), list->end(), [](const toml::node& n) { return is_zero(&n); });
  return node->value<double>().value_or(0) == 0;
}

Vec3 vector_of(const toml::node* node, const Vec3& fallback) {
  const auto* list = node ? node->as_array() : nullptr;
  if (!list || list->size() != 3) return fallback;
  return {list->get(0)->value_or(0.0), list->get(1)->value_or(0.0), list->get(2)->value_or(0.0)};
}

CaseFeatures facts_of(const toml::table& root, const Simulation& run) {
  CaseFeatures facts;
  const auto value = [&](const std::string& key) {
    const auto nodes = nodes_of(root, key);
    return nodes.empty() ? nullptr : nodes.front().value;
  };
  facts.prescribed = !run.mesh || run.frozen();
  facts.wall = !run.walls.empty();
  facts.gravity = root.contains("gravity");
  facts.gradient = run.mesh || !is_zero(value("flow.gradient_per_s"));
  facts.uniform = !is_zero(value("flow.velocity_m_s"));
  if (run.mesh)
    facts.uniform = run.frozen() || std::any_of(set_points.begin(), set_points.end(), [&](const char* key) {
                      const auto nodes = nodes_of(root, key);
                      return std::any_of(nodes.begin(), nodes.end(), [](const KeyNode& node) { return !is_zero(node.value); });
                    });
  facts.varies = !run.frozen() && (facts.gradient || !is_zero(value("flow.amplitude_m_s")));
  facts.flows = facts.uniform || (facts.varies && !run.mesh);
  facts.turbulence = run.water ? !run.water->flow.turbulent_kinetic_energy.empty() : !is_zero(value("flow.turbulent_kinetic_energy_m2_s2"));
  std::int64_t n = 0;
  for (const Rag& rag : run.rags->rags()) {
    n += rag.n_particles;
    facts.bonds = facts.bonds || rag.n_bonds > 0;
    facts.sheet = facts.sheet || (rag.n_columns > 1 && rag.n_rows > 1);
    facts.fibre = facts.fibre || (rag.n_particles > 1 && std::min(rag.n_columns, rag.n_rows) == 1);
  }
  facts.several = n > 1, facts.oriented = n > 1;
  facts.pipe = facts.prescribed && run.pipe_flow().is_there(), facts.bend = facts.pipe && run.pipe_flow().has_bend();
  facts.averaging = run.mesh && value("coupling.kernel_width_m") != nullptr && root["coupling"]["kernel"].value_or(std::string()) != "cell";
  for (const RagPiece& piece : run.rags->pieces())
    facts.crumple = facts.crumple || (piece.plan.crumpled() && piece.plan.confine_radius > 0);
  facts.hertz = root["contact"]["law"].value_or(std::string()).starts_with("hertz");
  return facts;
}

bool is_drag_replacement(const std::string& force) {
  return fluid_forces().make(force, "diagnosis")->description().role == Role::drag_replacement;
}

std::vector<std::string> listed_forces(const toml::table& root) {
  std::vector<std::string> names = CouplingSettings().forces;
  if (const auto* list = root["coupling"]["forces"].as_array()) {
    names.clear();
    for (const toml::node& name : *list) names.push_back(name.value_or(std::string()));
    names = spelt_out(names);
  }
  if (root.contains("gravity")) names.emplace_back("gravity");
  return names;
}

constexpr const char* of_geometry = "mesh.set.";

std::vector<std::string> geometry_values(const toml::table& root) {
  std::vector<std::string> values;
  if (const auto* list = root["mesh"]["set"].as_array())
    for (const toml::node& value : *list) values.push_back(value.value_or(std::string()));
  return values;
}

/// Values of the geometry, "key=value" of [mesh] set, as numbers at mesh.set.KEY.
void number_geometry(toml::table& root, const std::vector<std::string>& values) {
  if (values.empty()) return;
  std::string text;
  for (const std::string& value : values) text += value + "\n";
  try {
    root["mesh"].as_table()->insert_or_assign("set", toml::parse(text));
  } catch (const toml::parse_error&) {
    return;  // words without quotes are for snag mesh alone
  }
}

/// SI value of the unit that ends the name of such a number: they stand as they are given, "mesh.set.height_mm" in mm.
double unit_of_geometry(const std::string& key) {
  for (auto at = key.find('_', key.rfind('.') + 1); at != std::string::npos; at = key.find('_', at + 1))
    if (const auto unit = parse_unit(unit_of_suffix(key.substr(at + 1)))) return unit->factor;
  return 1;
}

/// Overrides of such numbers as one of their list.
void gather_geometry(std::vector<std::string>& overrides, std::vector<std::string> values) {
  bool is_changed = false;
  const std::string prefix = of_geometry;
  for (const std::string& text : overrides) {
    if (!text.starts_with(prefix)) continue;
    const std::string change = text.substr(prefix.size()), key = change.substr(0, change.find('='));
    is_changed = true;
    for (std::string& value : values)
      if (value.substr(0, value.find_first_of(" =")) == key) value = change;
  }
  if (!is_changed) return;
  std::erase_if(overrides, [&](const std::string& text) { return text.starts_with(prefix); });
  for (std::string& value : values) value = toml_text(value);
  overrides.push_back("mesh.set=[" + joined(values) + "]");
}

/// All ranks build a case whose water is computed; each builds the others for itself.
MPI_Comm ranks_of(const CaseFile& file) {
  StartSettings start;
  const Section section = start.section();
  file.root().table(section).read(section.parameters);
  return file.root().has("mesh") && !start.frozen ? MPI_COMM_WORLD : MPI_COMM_SELF;
}

}  // namespace

PointCase::~PointCase() = default;
PointCase::PointCase(PointCase&&) noexcept = default;
PointCase& PointCase::operator=(PointCase&&) noexcept = default;

PointCase::PointCase(const std::filesystem::path& file, const std::vector<std::string>& overrides, FlowCache* store, Prepared* prepared)
    : file_(file), tree_(std::make_unique<Tree>()) {
  const CaseFile read = CaseFile::read(file, overrides);
  const log::Silence silence;
  const Simulation run(read, ranks_of(read), {}, store, prepared);
  if (!run.rags) throw Error(ExitCode::usage, file.string() + ": has no particle, fibre or rag; a diagnosis needs one");
  case_file_ = read;
  resolved_ = read.resolved(), sha256_ = read.sha256();
  text_.emplace(resolved_, file.string());
  tree_->root = toml::parse(resolved_);
  geometry_ = geometry_values(tree_->root);
  number_geometry(tree_->root, geometry_);
  facts_ = facts_of(tree_->root, run), restarts_ = !run.mesh;
  pipe_flow_ = run.pipe_flow();
  has_passage_ = run.passage->geometry().has_value(), camera_ = run.observe_settings;
  n_pieces_ = static_cast<int>(run.rags->rags().size());
  has_hold_ = run.holds != nullptr;
  forces_ = listed_forces(tree_->root);
  for (const RagPiece& piece : run.rags->pieces()) crumpled_ = crumpled_ || piece.plan.crumpled();
  for (const std::string& name : forces_) {
    drag_is_replaced_ = drag_is_replaced_ || is_drag_replacement(name);
    const std::string key = "coupling." + name + ".drag_factor";
    if (!nodes_of(tree_->root, key).empty()) drag_factors_.push_back(key);
  }
  const View view = run.observe_settings.view();
  right_ = view.right, up_ = view.up;
}

std::string PointCase::input_name(const std::string& key, const std::string& where) const {
  const auto former = former_inputs.find(key);
  std::string present = former != former_inputs.end() ? former->second : case_file_.with_present_names(key);
  if (present != key) log::warning_once(former_name_note(where + " input_u ", key, present));
  return present;
}

void PointCase::set_alternative(const std::string& effect, const std::vector<std::string>& overrides) {
  std::vector<std::string>& values = alternatives_[effect];
  values.clear();
  for (const std::string& text : overrides) {
    values.push_back(case_file_.with_present_names(text));
    if (values.back() != text) log::warning_once(former_name_note("[[alternative]] " + effect + ": ", text, values.back()));
  }
}

void PointCase::set_own_candidate(const OwnCandidate& candidate) {
  OwnCandidate own = candidate;
  own.key = case_file_.with_present_names(candidate.key);
  if (own.key != candidate.key) log::warning_once(former_name_note(candidate.where + " key ", candidate.key, own.key));
  const auto refuse = [&](const std::string& what) { throw Error(ExitCode::usage, own.where + ": key \"" + own.key + "\" " + what); };
  const auto nodes = nodes_of(tree_->root, own.key);
  if (nodes.empty())
    refuse("is not a number of " + file_.string() +
           "; give one with its unit such as rag.centre_m, as snag run writes it to case.resolved.toml");
  for (const KeyNode& node : nodes) {
    const auto* list = node.value->as_array();
    if (node.value->is_integer()) refuse("is a whole number; a strength needs one that may change by little: give another key");
    if (list != nullptr && !own.direction)
      refuse("is a list of " + std::to_string(list->size()) + " numbers; say along which with direction = [..]");
    if (own.direction && (list == nullptr || list->size() != 3)) refuse("is no vector; leave direction out");
  }
  if (own.key.starts_with(of_geometry)) own.unit /= unit_of_geometry(own.key);
  own_candidates_[own.effect.name] = std::move(own);
}

void PointCase::check_nuisance(const std::string& key) const {
  if (key == drag_law_uncertainty || key == drag_law_uncertainty_per_point || (key == flow_field && (facts_.prescribed || facts_.flows)))
    return;
  if (!nodes_of(tree_->root, key).empty()) return;
  throw Error(ExitCode::usage,
              file_.string() + ": input_u names \"" + key +
                  "\", which is not a numeric key of this case; give a key of the case with its unit such as "
                  "\"particle.density_kg_m3\" as snag run writes it to case.resolved.toml, \"flow.amplitude\" for the "
                  "whole flow field (of computed water: its set-points), \"drag_law_uncertainty\" or \"drag_law_uncertainty_per_point\"");
}

std::string PointCase::reason_against(const ObservableRecord& observable) const {
  switch (observable.needs) {
    case Needs::pump:
      return has_passage_ ? "" : "it is defined by [rag_passage], the flanges and the tongue of a pump, which the case lacks; add it";
    case Needs::planes:
      if (is_whole_run()) return has_passage_ ? "" : "it is defined by the flanges in [rag_passage], which the case lacks; add it";
      return camera_.has_exit() ? "" : "it is defined by the exit plane in [virtual_camera], which the case lacks; add it";
    case Needs::hold:
      return has_hold_ ? "" : "it is the force of a [[hold]], which the case lacks; add it";
    case Needs::nothing:
      break;
  }
  if (is_whole_run() && n_pieces_ > 1 && !observable.is_of_whole_run())
    return "it is that of one piece, and the case has " + std::to_string(n_pieces_) + "; leave one of them in the case";
  return "";
}

std::string PointCase::value_of(const std::string& key) const {
  std::vector<std::string> values;
  for (const KeyNode& node : nodes_of(tree_->root, key)) values.push_back(changed_text(*node.value, 1));
  return joined(values);
}

void PointCase::turn(double angle, std::vector<std::string>& overrides) const {
  const Vec3 axis = cross(right_, up_);
  for (const char* shape : {"rag", "disc", "fibre"})
    for (const auto& [path, table] : tables_at(tree_->root, shape)) {
      const Vec3 along = vector_of(table->get("lengthwise"), {1, 0, 0}), across = vector_of(table->get("crosswise"), {0, 1, 0});
      overrides.push_back(path + ".lengthwise=" + toml_text(turned(along, axis, angle)));
      if (std::string(shape) != "fibre") overrides.push_back(path + ".crosswise=" + toml_text(turned(across, axis, angle)));
    }
}

/// A run of this case, as effects and uncertain inputs change it.
class PointCase::Edit final : public RunEdit {
 public:
  explicit Edit(const PointCase& point) : point_(point), keys_(point.tree_->root), forces_(point.forces_) {
    std::erase(forces_, "gravity");
    n_base_forces_ = forces_.size();
  }
  const CaseFeatures& base() const override { return point_.facts_; }
  void set(const std::string& text) override { keys_.set(text); }
  void scale(const std::string& key, double factor) override { keys_.scale(key, factor); }
  void add(const std::string& key, const Vec3& vector) override { keys_.add(key, {vector.x, vector.y, vector.z}); }
  void move_pieces_inside(double way) override {
    for (const char* key : piece_places)
      for (const KeyNode& node : nodes_of(point_.tree_->root, key)) {
        const Vec3 to = way * point_.pipe_flow_.inside_at(vector_of(node.value, {}));
        keys_.add(node, {to.x, to.y, to.z});
      }
  }
  void turn_pieces(double angle) override { turn_ += angle; }
  void scale_picture(double factor, int axis) override {
    change_.picture_scale *= factor;
    if (axis >= 0) change_.picture_centre[axis] = 1;
  }

  /// Random forces and crumpled pieces take the seed of the run.
  void seed(std::uint64_t seed) {
    if (point_.crumpled_) set("rag.seed=" + std::to_string(seed % 1000000007));  // each replicate is another crumple
    for (const std::string& name : forces_) {
      const CatalogueEffect* held = catalogue_effect(name);
      if (held && held->prior.random) set(seed_of(name, seed));
    }
  }
  void add_effect(const std::string& name, double theta, int form, std::uint64_t seed) {
    if (const auto alternative = point_.alternatives_.find(name); alternative != point_.alternatives_.end()) {
      for (const std::string& text : alternative->second) set(text);
    } else if (const auto own = point_.own_candidates_.find(name); own != point_.own_candidates_.end()) {
      const double change = theta * own->second.unit * (own->second.effect.random ? even_normal_deviate(seed) : 1);
      const Vec3 along = own->second.direction.value_or(Vec3{});
      keys_.add(own->second.key,
                own->second.direction ? std::vector{change * along.x, change * along.y, change * along.z} : std::vector{change});
    } else if (const CatalogueEffect* of_library = catalogue_effect(name)) {
      if (of_library->is_force) add_force(name);
      for (const std::string& text : of_library->overrides(theta, form, seed, [this](const auto& key) { return point_.value_of(key); }))
        set(text);
    } else {
      effect_models().make(name, "diagnosis")->change(theta, form, seed, *this);
    }
  }
  void add_deviation(const std::string& name, double deviation) {
    if (name == flow_field) return scale_flow(1 + deviation);
    if (name != drag_law_uncertainty && name != drag_law_uncertainty_per_point) return scale(name, 1 + deviation);
    if (point_.drag_is_replaced_ || replaces_drag_)
      drag_ *= 1 + deviation;
    else
      for (const std::string& key : point_.drag_factors_) scale(key, 1 + deviation);
  }
  /// The factor on drag that replaces the particles' own; theta: what the candidate drag_magnitude does.
  void add_magnitude(double theta) {
    if (drag_ == 1) return;
    const std::string name = "drag_magnitude", key = "coupling." + name + ".excess";
    const auto held = nodes_of(point_.tree_->root, key);
    const double of_case = held.empty() ? 0 : held.front().value->value_or(0.0);
    set(key + "=" + toml_text((1 + of_case) * (1 + theta) * drag_ - 1));
    add_force(name);
  }
  /// To the exponent of Re in the drag; theta: what the candidate of that name does.
  void add_exponent(double exponent, double theta) {
    const std::string name = "drag_exponent";
    set("coupling." + name + ".exponent=" + toml_text(exponent + theta));
    add_force(name);
  }
  CaseChange change() {
    if (forces_.size() > n_base_forces_) {
      for (std::string& name : forces_) name = toml_text(name);
      set("coupling.forces=[" + joined(forces_) + "]");
    }
    change_.overrides = keys_.overrides();
    gather_geometry(change_.overrides, point_.geometry_);
    if (turn_ != 0) point_.turn(turn_, change_.overrides);
    return std::move(change_);
  }

 private:
  void add_force(const std::string& name) {
    replaces_drag_ = replaces_drag_ || is_drag_replacement(name);
    if (std::find(forces_.begin(), forces_.end(), name) == forces_.end()) forces_.push_back(name);
  }

  const PointCase& point_;
  KeyChanges keys_;
  std::vector<std::string> forces_;
  std::size_t n_base_forces_;
  double turn_ = 0;             // rad
  bool replaces_drag_ = false;  // an added force does
  double drag_ = 1;             // factor on drag that replaces the particles' own
  CaseChange change_;
};

CaseChange PointCase::change(const std::map<std::string, double>& effects, const std::map<std::string, double>& nuisances,
                             std::uint64_t seed, const std::map<std::string, int>& forms) const {
  Edit run(*this);
  run.seed(seed);
  for (const auto& [name, theta] : effects) {
    const auto form = forms.find(name);
    if (theta != 0) run.add_effect(name, theta, form == forms.end() ? 0 : form->second, seed);  // 0: the base model to the bit
  }
  double exponent = 0;
  for (const auto& [name, deviation] : nuisances) {
    if (name == drag_slope)
      exponent += deviation;
    else if (deviation != 0)
      run.add_deviation(name, deviation);
  }
  const auto candidate = effects.find("drag_exponent");
  if (exponent != 0) run.add_exponent(exponent, candidate == effects.end() ? 0 : candidate->second);
  const auto magnitude = effects.find("drag_magnitude");
  run.add_magnitude(magnitude == effects.end() ? 0 : magnitude->second);
  return run.change();
}

std::string PointCase::with_step_factor(double factor) const {
  const auto number = [&](const char* key) { return nodes_of(tree_->root, key).front().value->value<double>().value(); };
  const double end = number("time.end_s");
  const auto n = std::max(1.0, std::round(end / number("time.step_s") / factor));
  return "time.step_s=" + toml_text(end / n);
}

double PointCase::end() const { return nodes_of(tree_->root, "time.end_s").front().value->value<double>().value(); }

// Resolved paths are absolute: so a file is told from another text.
bool PointCase::names_file(const std::string& table, const std::string& key) const {
  for (const auto& found : tables_at(tree_->root, table)) {
    const toml::node* value = found.second->get(key);
    if (value != nullptr && value->value_or(std::string()).starts_with('/')) return true;
  }
  return false;
}

std::vector<std::string> PointCase::from_elsewhere(std::vector<std::string> overrides) const {
  for (std::string& text : overrides) {
    const std::size_t equals = text.find('='), dot = text.rfind('.', equals);
    if (equals == std::string::npos || dot == std::string::npos) continue;
    if (!names_file(text.substr(0, dot), text.substr(dot + 1, equals - dot - 1))) continue;
    std::string name = text.substr(equals + 1);
    std::erase(name, '"');
    text = text.substr(0, equals + 1) + toml_text(std::filesystem::absolute(file_.parent_path() / name).lexically_normal().string());
  }
  return overrides;
}

std::string PointCase::resolved_with(const std::vector<std::string>& overrides, FlowCache* store, Prepared* prepared) const {
  const CaseFile file = with(overrides);
  const log::Silence silence;
  const Simulation run(file, ranks_of(file), {}, store, prepared);
  return file.resolved();
}

}  // namespace snag
