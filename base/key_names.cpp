#include "base/key_names.hpp"

#include <algorithm>
#include <charconv>
#include <tuple>

#include "base/case_file.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/parameter_text.hpp"
#include "base/units.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

/// Unit that a key of the file carries for the parameter `name`: "" for the bare key, nothing if the key is another one.
std::optional<std::string> unit_in_key(const std::string& key, const std::string& name, const std::string& si_unit) {
  if (key == name) return "";
  if (si_unit.empty() || !key.starts_with(name + "_")) return {};
  const std::string suffix = key.substr(name.size() + 1);
  // "m_s" is m/s but "Pa_s" is Pa s: the dimension decides.
  std::string product = suffix;
  std::replace(product.begin(), product.end(), '_', ' ');
  for (const std::string& unit : {unit_of_suffix(suffix), product}) {
    const auto parsed = parse_unit(unit);
    if (parsed && parsed->exponents == parse_unit(si_unit)->exponents) return unit;
  }
  return {};
}

/// One warning for each former name, however often the file is read.
void note_former_name(CaseNode& root, const std::string& where, const std::string& former, const std::string& present) {
  const std::string note = former_name_note(where, former, present);
  if (std::find(root.notes.begin(), root.notes.end(), note) == root.notes.end()) root.notes.push_back(note);
  log::warning_once(note);
}

std::string spelling(const std::string& key, const std::string& unit) {
  return unit.empty() ? key : key_with_unit({.key = key, .target = {}, .unit = unit});
}

std::string first_unit(const FormerName& former, const std::string& unit) { return former.unit.empty() ? unit : former.unit; }

/// `written` with `to` in place of the name `from`. An ending that is the SI unit of one becomes that of the other: omega_per_s,
/// angular_frequency_rad_s.
std::string with_name(const std::string& written, const RenamedKey& from, const RenamedKey& to) {
  if (written == spelling(from.key, from.unit)) return spelling(to.key, to.unit);
  return to.key + written.substr(from.key.size());
}

void set_names(CaseNode& node, const std::string& name, const std::string& first_name) {
  node.name = name, node.first_name = first_name;
  for (auto& [key, list] : node.tables)
    for (const auto& child : list) set_names(*child, name + "." + key, first_name + "." + key);
}

/// `former` into `present`; the values of an override count.
void merge(CaseNode& present, CaseNode& former) {
  if (present.present && present.line != line_of_override && former.line != line_of_override)
    throw Error(ExitCode::usage, former.where() + " is the former name of [" + present.name + "], which is given in line " +
                                     std::to_string(present.line) + "; keep one of them");
  for (auto& [key, value] : former.values) {
    if (former.line == line_of_override)
      present.values[key] = value;
    else
      present.values.insert({key, value});
  }
  present.tables.merge(former.tables);
  present.present = true;
  present.line = std::max(present.line, former.line);
}

}  // namespace

std::string former_name_note(const std::string& where, const std::string& former, const std::string& present) {
  return where + former + " is now called " + present + "; the old name is read until 1.0";
}

std::optional<KeyMatch> match(const std::string& key, const Parameter& parameter) {
  if (const auto unit = unit_in_key(key, parameter.key, parameter.unit)) return KeyMatch{*unit};
  if (parameter.former.key.empty()) return {};
  const auto unit = unit_in_key(key, parameter.former.key, parameter.unit);
  return unit ? std::optional(KeyMatch{*unit, true}) : std::nullopt;
}

std::string resolved_key(const Parameter& parameter) { return spelling(parameter.key, parameter.unit); }

std::string first_resolved_key(const Parameter& parameter) {
  const FormerName& former = parameter.former;
  return former.key.empty() ? resolved_key(parameter) : spelling(former.key, first_unit(former, parameter.unit));
}

std::string first_value(const Parameter& parameter, const std::string& value) {
  for (const auto& [former, present] : parameter.former.values)
    if (value == present) return former;
  return value;
}

std::shared_ptr<toml::node> present_value(CaseNode& root, const Parameter& parameter, const KeyMatch& found, const std::string& key,
                                          const toml::node& value, const std::string& where) {
  const FormerName& former = parameter.former;
  const RenamedKey today{parameter.key, parameter.unit, {}}, before{former.key, first_unit(former, parameter.unit), {}};
  const std::string present_key = found.is_former ? with_name(key, before, today) : key;
  const bool may_be_former_value = !former.values.empty() && (found.is_former || former.key.empty());
  if (may_be_former_value) {
    std::string text;
    if (const auto* word = value.as_string()) text = toml_text(word->get());
    if (const auto* flag = value.as_boolean()) text = flag->get() ? "true" : "false";
    std::vector<std::string> known;
    for (const auto& [old_value, present] : former.values) {
      known.push_back(old_value);
      if (text != old_value) continue;
      note_former_name(root, where, key + " = " + old_value, present_key + " = " + present);
      const toml::table parsed = toml::parse("v = " + present);
      return std::make_shared<toml::value<std::string>>(*parsed.get_as<std::string>("v"));
    }
    if (found.is_former)
      throw Error(ExitCode::usage, where + key + " must be one of " + joined(known) + "; it is now called " + present_key);
  }
  if (found.is_former) note_former_name(root, where, key, present_key);
  return {};
}

void adopt_former_table(CaseNode& root, CaseNode& parent, const Section& section) {
  if (section.former_name.empty()) return;
  parent.former_tables[section.name] = section.former_name;
  const auto former = parent.tables.find(section.former_name);
  auto& present = parent.tables[section.name];
  if (former != parent.tables.end()) {
    const auto list = std::move(former->second);
    parent.tables.erase(former);
    if (list.size() > 1) throw Error(ExitCode::usage, list[1]->where() + " is given more than once; write one [" + section.name + "]");
    note_former_name(root, place_of(list[0]->file, list[0]->line) + ": ", "[" + list[0]->name + "]", "[" + section.name + "]");
    if (present.empty()) {
      present.push_back(std::make_unique<CaseNode>());
      present[0]->file = list[0]->file;
    }
    present[0]->name = section.name;
    merge(*present[0], *list[0]);
  }
  const auto below = [](const std::string& above, const std::string& name) { return above.empty() ? name : above + "." + name; };
  for (const auto& child : present) set_names(*child, below(parent.name, section.name), below(parent.first_name, section.former_name));
  if (present.empty()) parent.tables.erase(section.name);
}

std::string translated(const CaseNode& root, const std::string& override_text, Names names) {
  const auto equals = override_text.find('=');
  std::string value = equals == std::string::npos ? "" : override_text.substr(equals + 1);
  std::vector<std::string> steps = split(override_text.substr(0, equals), '.');
  const CaseNode* node = &root;
  for (std::size_t i = 0; i + 1 < steps.size() && node; ++i) {
    std::string name = steps[i];
    for (const auto& [present, former] : node->former_tables)
      if (steps[i] == present || steps[i] == former) name = present, steps[i] = names == Names::first ? former : present;
    std::size_t index = 0;
    const std::string& next = steps[i + 1];
    if (std::from_chars(next.data(), next.data() + next.size(), index).ec == std::errc()) ++i;
    const auto found = node->tables.find(name);
    node = found != node->tables.end() && index < found->second.size() ? found->second[index].get() : nullptr;
  }
  for (const RenamedKey& key : node ? node->renamed_keys : std::vector<RenamedKey>{}) {
    const auto found = match(steps.back(), {.key = key.key, .target = {}, .unit = key.unit, .former = key.former});
    if (!found) continue;
    const RenamedKey before{key.former.key.empty() ? key.key : key.former.key, first_unit(key.former, key.unit), {}};
    if (found->is_former && names == Names::present) steps.back() = with_name(steps.back(), before, key);
    if (!found->is_former && names == Names::first) steps.back() = with_name(steps.back(), key, before);
    for (const auto& [former, present] : key.former.values) {
      const auto& [from, to] = names == Names::first ? std::tie(present, former) : std::tie(former, present);
      if (value == from || toml_text(value) == from) {
        value = to;
        break;
      }
    }
  }
  std::string text;
  for (const std::string& step : steps) text += (text.empty() ? "" : ".") + step;
  return equals == std::string::npos ? text : text + "=" + value;
}

}  // namespace snag
