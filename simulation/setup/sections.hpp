#pragma once
// Every section of the case file in the order of the manual; new folders add theirs here.
#include <vector>

#include "base/parameter.hpp"

namespace snag {

/// Owns settings with their defaults for as long as the sections are used.
class AllSections {
 public:
  AllSections();
  ~AllSections();
  AllSections(const AllSections&) = delete;
  AllSections& operator=(const AllSections&) = delete;
  std::vector<Section> list();

 private:
  struct Settings;
  Settings* settings_;
};

}  // namespace snag
