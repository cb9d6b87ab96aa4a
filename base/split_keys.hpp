#pragma once
// Keys of earlier versions that are several keys now. The former key is read until 1.0: its value goes to each present key that the case
// does not give, and one warning names them.
#include <string>
#include <vector>

namespace snag {

struct CaseNode;

struct SplitKey {
  const char* table;
  const char* former;
  std::vector<const char*> present;
  std::string present_names() const;  // "self_contact and mutual_contact"
};
const std::vector<SplitKey>& split_keys();

/// Moves the former keys of the tree that starts at `root`, and notes them.
void adopt_split_keys(CaseNode& root);

}  // namespace snag
