#pragma once
// Node numbers of a mesh file: any, in any order. Position p of a number: the p-th node of the file has it.
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "mesh/import/gmsh_reader.hpp"

namespace snag {

class NodeNumbers {
 public:
  explicit NodeNumbers(const GmshReader& reader) : reader_(reader) {}

  void add(std::int64_t number) {
    constexpr std::int64_t largest = 2147483646;
    if (number < 0 || number > largest)
      reader_.throw_damaged("node number " + std::to_string(number) + " is not between 0 and " + std::to_string(largest));
    nodes_.push_back({static_cast<int>(number), static_cast<int>(nodes_.size())});
  }
  /// After the last add. Throws if a number occurs twice.
  void sort() {
    const auto by_number = [](const Node& a, const Node& b) { return a.number < b.number; };
    if (!std::is_sorted(nodes_.begin(), nodes_.end(), by_number)) std::sort(nodes_.begin(), nodes_.end(), by_number);
    for (std::size_t i = 1; i < nodes_.size(); ++i)
      if (nodes_[i].number == nodes_[i - 1].number)
        reader_.throw_damaged("node number " + std::to_string(nodes_[i].number) + " occurs twice");
  }
  int position(std::int64_t number) const {
    // Files number nodes nearly always 1, 2, 3, ...: look there first.
    const std::size_t guess = nodes_.empty() ? 0 : static_cast<std::size_t>(number) - static_cast<std::size_t>(nodes_.front().number);
    if (guess < nodes_.size() && nodes_[guess].number == number) return nodes_[guess].position;
    const auto found =
        std::lower_bound(nodes_.begin(), nodes_.end(), number, [](const Node& node, std::int64_t wanted) { return node.number < wanted; });
    if (found == nodes_.end() || found->number != number)
      reader_.throw_damaged("an element has node " + std::to_string(number) + ", which does not exist");
    return found->position;
  }

 private:
  struct Node {
    int number, position;
  };
  const GmshReader& reader_;
  std::vector<Node> nodes_;
};

}  // namespace snag
