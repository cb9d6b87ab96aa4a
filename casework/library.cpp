#include "casework/library.hpp"

#include <algorithm>
#include <charconv>

#include "base/parameter_text.hpp"
#include "base/words.hpp"
#include "casework/point_case.hpp"
#include "coupling/candidates.hpp"
#include "coupling/fluid_force.hpp"
#include "dem/candidates.hpp"

namespace snag {

namespace {

/// A setting of the rags: of pieces of any shape.
CatalogueEffect setting_effect(const Candidate& candidate) {
  CatalogueEffect effect{.name = candidate.name, .prior = candidate.prior, .added_to = {candidate.prior.key}, .setting = candidate};
  if (candidate.prior.key.starts_with("rag."))
    for (const char* shape : {"disc", "fibre"}) effect.added_to.push_back(shape + candidate.prior.key.substr(3));
  if (candidate.prior.key == "contact.wall_friction")  // of pieces that have their own
    for (const char* shape : {"rag", "disc", "fibre", "particle"}) effect.added_to.push_back(shape + std::string(".wall_friction"));
  return effect;
}

/// The functional forms in which a force is written, the one of a case that names none first.
std::vector<std::string> forms_of(FluidForce& force) {
  for (const Parameter& parameter : force.parameters()) {
    if (parameter.key != "form") continue;
    std::vector<std::string> forms = parameter.choices;
    const auto usual = std::find(forms.begin(), forms.end(), std::get<AnyChoice*>(parameter.target)->word());
    std::rotate(forms.begin(), usual, usual + 1);
    return forms;
  }
  return {};
}

std::vector<CatalogueEffect> all_of_cases() {
  std::vector<CatalogueEffect> all;
  for (const std::string& name : fluid_forces().names()) {
    const auto force = fluid_forces().make(name, "diagnosis");
    const ForceDescription description = force->description();
    // Gravity is no name in [coupling] forces: it acts where its table is given.
    if (description.prior)
      all.push_back({.name = name, .prior = *description.prior, .is_force = name != "gravity", .forms = forms_of(*force)});
  }
  for (const auto& candidates : {dem_candidates(), coupling_candidates()})
    for (const Candidate& candidate : candidates) all.push_back(setting_effect(candidate));
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return all;
}

/// Why cases with these facts lack it; empty: they have it.
const char* reason_against(Need need, const CaseFeatures& facts) {
  switch (need) {
    case Need::wall:
      return facts.wall ? "" : "there is no wall";
    case Need::gradient:
      return facts.gradient ? "" : "the flow has no velocity gradient";
    case Need::turbulence:
      return facts.turbulence ? "" : "the flow has no turbulence";
    case Need::sheet:
      return facts.sheet ? "" : "there is no sheet";
    case Need::fibre:
      return facts.fibre ? "" : "there is no fibre";
    case Need::bonds:
      return facts.bonds ? "" : "there are no bonds";
    case Need::solid_fraction:
      return facts.prescribed ? "a prescribed flow has no solid fraction" : "";
    case Need::gravity:
      return facts.gravity ? "" : "there is no gravity";
    case Need::contact:
      return facts.wall || facts.several ? "" : "nothing can touch";
    case Need::hertz:
      return facts.hertz ? "" : "contacts are no spheres of Hertz";
    case Need::pipe:
      return facts.pipe ? "" : "there is no [pipe_flow], or its water is computed";
    case Need::bend:
      return facts.bend ? "" : "there is no bend in [pipe_flow], or its water is computed";
    case Need::crumple:
      return facts.crumple ? "" : "no piece starts crumpled by a pipe";
    case Need::averaging:
      return facts.averaging ? "" : "there is no [coupling] kernel_width over which water of cells is averaged";
    case Need::several:
      return facts.several ? "" : "there is one particle";
  }
  return "";
}

/// Why cases with these facts cannot show it; empty: they can.
std::string reason_against(const Prior& prior, const CaseFeatures& facts) {
  if (prior.acts_on_water && facts.prescribed) return "it acts on the water, which is prescribed";
  for (const Need need : prior.needs)
    if (std::string reason = reason_against(need, facts); !reason.empty()) return reason;
  return "";
}

}  // namespace

const std::vector<CatalogueEffect>& effect_catalogue() {
  static const std::vector<CatalogueEffect> all = all_of_cases();
  return all;
}

const CatalogueEffect* catalogue_effect(const std::string& name) {
  const auto& all = effect_catalogue();
  const auto found = std::find_if(all.begin(), all.end(), [&](const CatalogueEffect& effect) { return effect.name == name; });
  return found == all.end() ? nullptr : &*found;
}

std::string seed_of(const std::string& force, std::uint64_t seed) {
  return "coupling." + force + ".seed=" + std::to_string(seed % 1000000007);
}

std::vector<std::string> CatalogueEffect::overrides(double theta, int form, std::uint64_t seed,
                                                    const std::function<std::string(const std::string&)>& base) const {
  if (name == "gravity") return {prior.key + "=[0.0, 0.0, " + toml_text(-9.81 * theta) + "]"};
  if (added_to.empty()) {
    std::vector<std::string> all{prior.key + "=" + toml_text(theta)};
    if (prior.random) all.push_back(seed_of(name, seed));
    if (form > 0) all.push_back("coupling." + name + ".form=\"" + forms.at(static_cast<std::size_t>(form)) + "\"");
    return all;
  }
  std::vector<std::string> all;
  for (const std::string& key : form == 0 ? added_to : std::vector{setting.other_keys.at(static_cast<std::size_t>(form - 1))}) {
    double before = 0;
    const std::string text = base(key);
    if (text.empty() && setting.with.empty()) continue;  // no such piece
    std::from_chars(text.data(), text.data() + text.size(), before);
    all.push_back(key + "=" + toml_text(setting.is_relative ? before * (1 + theta) : before + theta));
  }
  all.insert(all.end(), setting.with.begin(), setting.with.end());
  return all;
}

std::vector<Effect> library_effects(const CaseFeatures& facts, const std::vector<std::string>& forces) {
  std::vector<Effect> all;
  for (const CatalogueEffect& effect : effect_catalogue()) {
    const Prior& p = effect.prior;
    const auto holds = [&](const std::string& force) { return std::find(forces.begin(), forces.end(), force) != forces.end(); };
    const std::string& of_force = effect.setting.of_force;
    all.push_back({.name = effect.name,
                   .parameter = p.meaning,
                   .unit = p.unit,
                   .mean = p.mean,
                   .sd = p.sd,
                   .minimum = p.minimum,
                   .maximum = p.maximum,
                   .is_share = p.is_share,
                   .random = p.random,
                   .acts_on_water = p.acts_on_water,
                   .blind = holds(effect.name)                      ? "the base case already contains it"
                            : !of_force.empty() && !holds(of_force) ? "the base case has no " + of_force
                                                                    : reason_against(p, facts),
                   // The mean of random runs is no mixture of their forms.
                   .n_forms = p.random ? 1 : effect.n_forms(),
                   .exclusive_forms = p.exclusive_forms,
                   .may_be_local = effect.is_force && facts.prescribed && !p.random});
  }
  for (const std::string& name : effect_models().names()) all.push_back(effect_models().make(name, "diagnosis")->effect(facts));
  std::sort(all.begin(), all.end(), [](const Effect& a, const Effect& b) { return a.name < b.name; });
  return all;
}

}  // namespace snag
