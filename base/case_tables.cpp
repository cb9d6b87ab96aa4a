#include "base/case_tables.hpp"

#include <map>
#include <stdexcept>
#include <string>

namespace snag {

namespace {

std::map<int, std::function<CaseTable()>>& makers() {
  static std::map<int, std::function<CaseTable()>> all;
  return all;
}

}  // namespace

bool add_case_table(int place, std::function<CaseTable()> make) {
  if (!makers().emplace(place, std::move(make)).second)
    throw std::logic_error("two tables of the case file have the place " + std::to_string(place));
  return true;
}

bool add_case_table(int place, std::vector<Section> (*sections)()) {
  return add_case_table(place, std::function<CaseTable()>([sections] { return CaseTable{nullptr, sections()}; }));
}

CaseTables::CaseTables() {
  for (const auto& [place, make] : makers()) tables_.push_back(make());
}

std::vector<Section> CaseTables::sections() const {
  std::vector<Section> all;
  for (const CaseTable& table : tables_) all.insert(all.end(), table.sections.begin(), table.sections.end());
  return all;
}

}  // namespace snag
