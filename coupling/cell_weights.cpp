#include "coupling/cell_weights.hpp"

namespace snag {

int WeightRows::place_of(int cell) {
  if (static_cast<std::size_t>(cell) >= place_of_.size()) place_of_.resize(static_cast<std::size_t>(cell) + 1, -1);
  int& known = place_of_[static_cast<std::size_t>(cell)];
  if (known < 0) {
    known = static_cast<int>(cells_.size());
    cells_.push_back(cell);
  }
  return known;
}

void WeightRows::clear() {
  for (const int cell : cells_) place_of_[static_cast<std::size_t>(cell)] = -1;
  row.clear(), place.clear(), weight.clear(), cells_.clear();
  start.assign(1, 0);
}

void WeightRows::close_row() {
  row.push_back(n_rows());
  start.push_back(static_cast<int>(place.size()));
}

void CellWeights::keep(std::span<const char> keeps) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < keeps.size(); ++i)
    if (keeps[i]) rows_.row[n++] = rows_.row[i];
  rows_.row.resize(n);
}

}  // namespace snag
