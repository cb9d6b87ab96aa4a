#include "casework/observable_source.hpp"

namespace snag {

std::map<std::type_index, ObservableSource>& observable_sources() {
  static std::map<std::type_index, ObservableSource> all;
  return all;
}

const std::any& RunReader::source(std::type_index type) {
  std::any& made = made_[type];
  if (!made.has_value()) made = observable_sources().at(type).in_memory(run_);
  return made;
}

}  // namespace snag
