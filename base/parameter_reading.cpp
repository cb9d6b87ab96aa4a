#include "base/parameter_reading.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <sstream>

#include "base/error.hpp"
#include "base/parameter_text.hpp"
#include "base/quotation.hpp"
#include "base/units.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

class Reading {
 public:
  Reading(const Parameter& parameter, const std::string& factor_unit, const std::string& where)
      : parameter_(parameter), factor_unit_(factor_unit), where_(where) {}

  void into_target(const toml::node& node) const {
    std::visit([&](auto* target) { read(node, *target); }, parameter_.target);
  }

 private:
  Error wrong(const std::string& found, const std::string& rule) const {
    return {ExitCode::usage, where_ + " is " + found + ", but " + rule};
  }
  static std::string shown(const toml::node& node) {
    if (node.is_floating_point()) return toml_text(*node.value<double>());
    std::ostringstream out;
    node.visit([&](const auto& concrete) { out << concrete; });
    return shortened(out.str());
  }

  double number(const toml::node& node) const {
    double value = 0;
    if (is_word(node)) {
      check_choice(*node.value<std::string>());
      return std::numeric_limits<double>::quiet_NaN();
    }
    if (const auto* text = node.as_string()) {
      value = quantity(text->get(), parameter_.unit, where_);
    } else if (node.is_number()) {
      if (factor_unit_.empty() && parameter_.unit != "1")
        throw wrong(shown(node) + " without a unit", "a unit is needed; write " + key_with_unit(parameter_) + " = " + shown(node) + " or " +
                                                         parameter_.key + " = \"" + shown(node) + " " + parameter_.unit + "\"");
      value = *node.value<double>() * (factor_unit_.empty() ? 1 : parse_unit(factor_unit_)->factor);
    } else {
      throw wrong(shown(node), "it must be a number");
    }
    if (!std::isfinite(value)) throw wrong(shown(node), "it must be a finite number");
    if (value < parameter_.minimum || value > parameter_.maximum) throw wrong(shown(node), "it must " + range());
    return value;
  }
  /// A word such as "auto" in the place of a number.
  bool is_word(const toml::node& node) const {
    const auto* text = node.as_string();
    return text && !parameter_.choices.empty() && !text->get().empty() && std::isalpha(static_cast<unsigned char>(text->get().front()));
  }
  std::string range() const {
    const std::string unit = parameter_.unit == "1" ? "" : " " + parameter_.unit;
    if (std::isinf(parameter_.maximum)) return "be at least " + toml_text(parameter_.minimum) + unit;
    if (std::isinf(parameter_.minimum)) return "be at most " + toml_text(parameter_.maximum) + unit;
    return "lie between " + toml_text(parameter_.minimum) + " and " + toml_text(parameter_.maximum) + unit;
  }
  const toml::array& array(const toml::node& node, std::size_t size) const {
    const auto* found = node.as_array();
    if (!found || (size > 0 && found->size() != size))
      throw wrong(shown(node), size > 0 ? "it must be a list of " + std::to_string(size) : "it must be a list");
    return *found;
  }
  void check_choice(const std::string& word) const {
    if (parameter_.choices.empty() || std::find(parameter_.choices.begin(), parameter_.choices.end(), word) != parameter_.choices.end())
      return;
    const std::string near = nearest_name(word, parameter_.choices);
    const std::string number = parameter_.unit.empty() ? "" : "a number with a unit, or ";
    throw wrong("\"" + shortened(word) + "\"",
                "it must be " + number + "one of " + joined(parameter_.choices) + (near.empty() ? "" : "; did you mean \"" + near + "\"?"));
  }

  void read(const toml::node& node, double& target) const { target = number(node); }
  void read(const toml::node& node, std::optional<double>& target) const { target = number(node); }
  void read(const toml::node& node, int& target) const {
    if (!node.is_integer()) throw wrong(shown(node), "it must be a whole number");
    const auto value = *node.value<std::int64_t>();
    if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max())
      throw wrong(shown(node), "it must lie between -2147483648 and 2147483647");
    target = static_cast<int>(number(node));
  }
  void read(const toml::node& node, bool& target) const {
    if (!node.is_boolean()) throw wrong(shown(node), "it must be true or false");
    target = *node.value<bool>();
  }
  void read(const toml::node& node, std::string& target) const {
    if (!node.is_string()) throw wrong(shown(node), "it must be a text in quotes");
    check_choice(*node.value<std::string>());
    target = *node.value<std::string>();
  }
  void read(const toml::node& node, AnyChoice& target) const {
    std::string word;
    read(node, word);
    target.choose(word);
  }
  void read(const toml::node& node, Vec3& target) const {
    const auto& list = array(node, 3);
    for (int i = 0; i < 3; ++i) target[i] = number(list[i]);
  }
  void read(const toml::node& node, Mat3& target) const {
    const auto& list = array(node, 3);
    for (int i = 0; i < 3; ++i) read(list[i], target[i]);
  }
  void read(const toml::node& node, std::vector<double>& target) const {
    target.clear();
    for (const toml::node& element : array(node, 0)) target.push_back(number(element));
  }
  void read(const toml::node& node, std::vector<Vec3>& target) const {
    target.clear();
    for (const toml::node& element : array(node, 0)) read(element, target.emplace_back());
  }
  void read(const toml::node& node, std::vector<std::string>& target) const {
    target.clear();
    for (const toml::node& element : array(node, 0)) read(element, target.emplace_back());
  }

  const Parameter& parameter_;
  const std::string& factor_unit_;  // of a number whose unit stands in the key
  const std::string& where_;
};

}  // namespace

void read_parameter(const Parameter& parameter, const std::string& unit_of_key, const toml::node& node, const std::string& where) {
  Reading(parameter, unit_of_key, where).into_target(node);
}

}  // namespace snag
