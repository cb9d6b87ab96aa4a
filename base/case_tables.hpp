#pragma once
// Tables of the case file, each registered beside its settings.
#include <functional>
#include <memory>
#include <vector>

#include "base/parameter.hpp"

namespace snag {

/// Sections of the manual, and the settings that their records point into.
struct CaseTable {
  std::shared_ptr<void> settings;
  std::vector<Section> sections;
};

/// Registers a table. `place`: where the manual lists it; no two are the same. Returns true, so that a constant can hold the registration.
bool add_case_table(int place, std::function<CaseTable()> make);

/// The same for sections whose records point into objects that live as long as the program.
bool add_case_table(int place, std::vector<Section> (*sections)());

/// The same for settings with a function section(), made of `arguments`.
template <class Settings, class... Arguments>
bool add_case_table(int place, Arguments... arguments) {
  return add_case_table(place, std::function<CaseTable()>([=] {
                          const auto settings = std::make_shared<Settings>(arguments...);
                          return CaseTable{settings, {settings->section()}};
                        }));
}

/// Every section of the case file in the order of the manual, with the defaults of its settings; they live as long as this object.
class CaseTables {
 public:
  CaseTables();
  std::vector<Section> sections() const;

 private:
  std::vector<CaseTable> tables_;
};

}  // namespace snag
