#pragma once
// Models that register themselves: one model, one file, chosen by name in the case file.
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/case_file.hpp"
#include "base/error.hpp"
#include "base/words.hpp"

namespace snag {

/// Models of one interface by name. A model M has a static `const char* name`.
template <class Interface>
class Registry {
 public:
  explicit Registry(std::string kind) : kind_(std::move(kind)) {}

  template <class Model>
  bool add() {
    return makers_.emplace(Model::name, [] { return std::make_unique<Model>(); }).second;
  }
  std::unique_ptr<Interface> make(const std::string& name, const std::string& where) const {
    const auto maker = makers_.find(name);
    if (maker == makers_.end()) {
      const auto near = nearest_name(name, names());
      throw Error(ExitCode::usage, where + ": unknown " + kind_ + " \"" + name + "\"; known: " + joined(names()) +
                                       (near.empty() ? "" : "; did you mean \"" + near + "\"?"));
    }
    return maker->second();
  }
  /// One model of each name, in the order of names(): for the manual.
  std::vector<std::unique_ptr<Interface>> make_all() const {
    std::vector<std::unique_ptr<Interface>> all;
    for (const auto& [name, maker] : makers_) all.push_back(maker());
    return all;
  }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& [name, maker] : makers_) all.push_back(name);
    return all;
  }

 private:
  std::string kind_;
  std::map<std::string, std::function<std::unique_ptr<Interface>()>> makers_;
};

}  // namespace snag
