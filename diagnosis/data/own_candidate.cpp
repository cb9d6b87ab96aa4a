#include "diagnosis/data/own_candidate.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/units.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

constexpr double far = 1e9;

struct CandidateTable {
  Effect effect{.name = {}, .minimum = -far, .maximum = far};
  std::string key;
  Vec3 direction{};

  Section section() {
    const auto number = [](const char* name, double* target, const char* meaning) {
      return Parameter{.key = name, .target = target, .meaning = meaning};
    };
    Parameter name = setting("name", &effect.name, "Name of the candidate, a new one.");
    Parameter of_case = setting("key", &key,
                                "Number of the case that is off, by its name in case.resolved.toml, such as rag.centre_m; where several "
                                "tables have it, in each of them.");
    Parameter sd = number("sd", &effect.sd, "Standard deviation of theta, given that the candidate acts.");
    name.required = of_case.required = sd.required = true;
    return {"candidate",
            "A candidate of your own: a number of the case that may be off. A run has the value of the case + theta, or + theta times "
            "direction. Mean, standard deviation and range say what is known of theta before the measurement.",
            {name,
             setting("meaning", &effect.parameter, "What theta is, in words."),
             of_case,
             setting("unit", &effect.unit, "Unit of theta, of the dimension of the key; 1 for a pure number."),
             number("mean", &effect.mean, "Mean of theta, given that the candidate acts."),
             sd,
             number("minimum", &effect.minimum, "Least theta, 0 or less: at 0 the case is as it stands."),
             number("maximum", &effect.maximum, "Largest theta, 0 or more."),
             {.key = "direction",
              .target = &direction,
              .meaning = "Of a vector: what it changes by where theta is one. [0, 0, 0]: the key is one number."},
             setting("random", &effect.random,
                     "true: theta is the standard deviation of a scatter, with another normal deviate in each replicate.")},
            true};
  }
};

/// SI value of a unit that a key may have: by its ending, "centre_m". Nothing if the dimensions differ.
std::optional<double> unit_of(const std::string& key, const std::string& text) {
  const auto unit = parse_unit(text);
  if (!unit) return {};
  for (auto at = key.find('_', key.rfind('.') + 1); at != std::string::npos; at = key.find('_', at + 1)) {
    const std::string suffix = key.substr(at + 1);
    std::string product = suffix;  // Pa_s is Pa s, m_s is m/s
    std::replace(product.begin(), product.end(), '_', ' ');
    const auto ratio = parse_unit(unit_of_suffix(suffix)), times = parse_unit(product);
    if (!ratio && !times) continue;
    const bool same = (ratio && ratio->exponents == unit->exponents) || (times && times->exponents == unit->exponents);
    return same ? std::optional(unit->factor) : std::nullopt;
  }
  return unit->exponents == std::array<int, 3>{} ? std::optional(unit->factor) : std::nullopt;
}

}  // namespace

void check_name_of_hypothesis(const std::string& name, const std::string& where) {
  if (!name.empty() && name.find_first_of("+:@") == std::string::npos) return;
  throw Error(
      ExitCode::usage,
      where + " name \"" + name + "\" cannot stand in a verdict: + joins names, : and @ are those of mistakes; give letters, digits and _");
}

Section own_candidate_section() {
  static CandidateTable table;
  return table.section();
}

std::vector<OwnCandidate> read_own_candidates(const Table& root) {
  std::vector<OwnCandidate> all;
  for (const Table& table : root.tables("candidate")) {
    CandidateTable keys;
    table.read(keys.section().parameters);
    OwnCandidate one{.effect = keys.effect, .key = keys.key, .where = table.where() + " " + keys.effect.name};
    check_name_of_hypothesis(one.effect.name, table.where());
    const auto refuse = [&](const std::string& what) { throw Error(ExitCode::usage, one.where + ": " + what); };
    if (std::any_of(all.begin(), all.end(), [&](const OwnCandidate& other) { return other.effect.name == one.effect.name; }))
      refuse("a second candidate of this name; keep one of them");
    const auto unit = unit_of(one.key, one.effect.unit);
    if (!unit)
      refuse("unit \"" + one.effect.unit + "\" is not one of key \"" + one.key +
             "\"; give the key with its unit, as in case.resolved.toml, and a unit of the same dimension, \"mm\" for rag.centre_m");
    const Effect& e = one.effect;
    if (!(e.sd > 0)) refuse("sd is " + number_text(e.sd) + "; a standard deviation is more than 0: say how far theta may be from its mean");
    if (e.minimum > 0 || e.maximum < 0 || e.minimum == e.maximum)
      refuse("its range is " + number_text(e.minimum) + " to " + number_text(e.maximum) +
             "; it has to hold 0, where the case is as it stands, and more: widen it");
    if (e.random && e.minimum < 0)
      refuse("minimum is " + number_text(e.minimum) + ", but theta of a random candidate is a standard deviation; give minimum = 0");
    if (e.mean < e.minimum || e.mean > e.maximum)
      refuse("mean is " + number_text(e.mean) + ", outside of its range of " + number_text(e.minimum) + " to " + number_text(e.maximum) +
             "; move one of them");
    one.unit = *unit;
    if (norm(keys.direction) > 0) one.direction = keys.direction;
    all.push_back(std::move(one));
  }
  return all;
}

void add_own_candidates(std::vector<Effect>& effects, const std::vector<OwnCandidate>& candidates) {
  for (const OwnCandidate& own : candidates) {
    if (std::any_of(effects.begin(), effects.end(), [&](const Effect& e) { return e.name == own.effect.name; }))
      throw Error(ExitCode::usage,
                  own.where + ": the name is that of another candidate, of the library or of an [[alternative]]; give a new one");
    effects.push_back(own.effect);
  }
}

}  // namespace snag
