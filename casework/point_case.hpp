#pragma once
// The base case of an operating point, and how effects and uncertain inputs change it: as values of its keys.
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/case_file.hpp"
#include "coupling/pipe_flow.hpp"
#include "diagnosis/data/own_candidate.hpp"
#include "diagnosis/effects/effect_model.hpp"
#include "observe/observables.hpp"
#include "simulation/setup/flow_cache.hpp"
#include "simulation/setup/observe_settings.hpp"
#include "simulation/setup/prepared.hpp"

namespace snag {

/// Uncertain inputs that are no keys of a case: the factor on all drag, the same at all points or one for each point.
inline constexpr const char* drag_law_uncertainty = "drag_law_uncertainty";
inline constexpr const char* drag_law_uncertainty_per_point = "drag_law_uncertainty_per_point";

/// One run of a point: values of keys that differ from the base case, and what the camera makes of it.
struct CaseChange {
  std::vector<std::string> overrides{};  // "section.key=value"
  double picture_scale = 1;
  Vec3 picture_centre{};  // where the scale leaves lengths as they are, in sizes of the picture
};

class PointCase {
 public:
  /// Reads the base case and builds it once, so that an error in it is reported at once. Throws Error.
  /// `overrides`: values of the case that this point replaces; `store`: holds meshes and water of several cases.
  explicit PointCase(const std::filesystem::path& file, const std::vector<std::string>& overrides = {}, FlowCache* store = nullptr,
                     Prepared* prepared = nullptr);
  ~PointCase();
  PointCase(PointCase&&) noexcept;
  PointCase& operator=(PointCase&&) noexcept;

  const CaseFeatures& facts() const { return facts_; }
  const std::string& sha256() const { return sha256_; }
  /// Forces that the base case lists, gravity among them where it is given.
  const std::vector<std::string>& forces() const { return forces_; }
  /// The water is computed with the rags: a run of all ranks with an output folder, instead of one in memory.
  bool is_whole_run() const { return !facts_.prescribed; }
  const ObserveSettings& camera() const { return camera_; }
  /// Why runs of this case do not define an observable, and the remedy; empty: they do.
  std::string reason_against(const ObservableRecord& observable) const;
  /// Runs can go on from a measured state: nothing hangs on the cell that holds a particle.
  bool restarts() const { return restarts_; }

  /// The case of a run of this seed with effects (theta by name) and nuisances (relative deviation by name). Throws Error(usage) for a name
  /// that is neither an effect nor a key of the case.
  /// `forms`: of the effects, by index; what is not there: the first.
  CaseChange change(const std::map<std::string, double>& effects, const std::map<std::string, double>& nuisances, std::uint64_t seed,
                    const std::map<std::string, int>& forms = {}) const;
  /// From now on the effect of that name is these values of the case.
  void set_alternative(const std::string& effect, const std::vector<std::string>& overrides);
  /// From now on the effect of that name is this candidate. Throws Error(usage) where the case has no such number.
  void set_own_candidate(const OwnCandidate& candidate);
  /// The name that an uncertain input has today: of a key of the case that was renamed, or of the drag law. A former one gets a warning
  /// that begins with `where`.
  std::string input_name(const std::string& key, const std::string& where) const;
  /// A line for each former name in the case file; building the case is silent.
  const std::vector<std::string>& former_names() const { return case_file_.former_names(); }
  /// An override as tables of runs have it, by the first names of its keys.
  std::string for_run_table(const std::string& override_text) const { return case_file_.with_first_names(override_text); }
  /// The override that changes the number of steps by 1/factor.
  std::string with_step_factor(double factor) const;
  /// Time at which a run ends, s.
  double end() const;
  const std::string& resolved() const { return resolved_; }
  /// The same overrides for a copy of the case in another folder: paths are relative to the case file.
  std::vector<std::string> from_elsewhere(std::vector<std::string> overrides) const;
  /// The case of such a run with all its keys, built once: an error in it is thrown.
  std::string resolved_with(const std::vector<std::string>& overrides, FlowCache* store, Prepared* prepared) const;
  /// The case file of such a run.
  CaseFile with(const std::vector<std::string>& overrides) const { return text_->with(overrides); }
  /// Throws Error(usage) unless a relative deviation of this key can be applied: "flow.amplitude" (the whole flow field),
  /// drag_law_uncertainty (all drag, alike at all points), drag_law_uncertainty_per_point (all drag, at each point on its own: Reynolds
  /// numbers far apart), or a number of the case by its resolved key, such as "particle.density_kg_m3".
  void check_nuisance(const std::string& key) const;
  /// Of a generated mesh also a number of its geometry that [mesh] set gives, "mesh.set.tongue_gap": runs then have meshes of their own.
  /// Value of a number of the case, as TOML, "" if there is none; two points with equal values share its deviation.
  std::string value_of(const std::string& key) const;

 private:
  struct Tree;
  class Edit;
  void turn(double angle, std::vector<std::string>& overrides) const;
  /// Whether a key of the case holds a path.
  bool names_file(const std::string& table, const std::string& key) const;

  std::filesystem::path file_;
  CaseFile case_file_;
  std::string resolved_, sha256_;
  std::optional<CaseFile::Text> text_;  // of resolved_
  std::unique_ptr<Tree> tree_;          // the same with the numbers of the geometry
  CaseFeatures facts_;
  PipeFlow pipe_flow_;
  bool crumpled_ = false;          // a piece starts crumpled, by its seed
  bool drag_is_replaced_ = false;  // a law of the sheet stands in for that of its particles, whose factor is without effect then
  bool restarts_ = false;
  bool has_passage_ = false;  // [rag_passage]
  ObserveSettings camera_;
  int n_pieces_ = 0;
  bool has_hold_ = false;
  std::vector<std::string> geometry_;                             // [mesh] set: "key=value"
  std::vector<std::string> forces_, drag_factors_;                // drag_factors_: keys of the factors on drag
  std::map<std::string, std::vector<std::string>> alternatives_;  // by effect
  std::map<std::string, OwnCandidate> own_candidates_;            // by name
  Vec3 right_, up_;                                               // of the camera
};

/// Effects that this library can add to base cases with these facts, by name; `forces`: those that the base cases hold already.
std::vector<Effect> library_effects(const CaseFeatures& facts, const std::vector<std::string>& forces);

}  // namespace snag
