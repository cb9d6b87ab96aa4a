#include "coupling/cell_weights.hpp"

namespace snag {

void WeightRows::clear() {
  row.clear(), cell.clear(), weight.clear();
  start.assign(1, 0);
}

void WeightRows::close_row() {
  row.push_back(n_rows());
  start.push_back(static_cast<int>(cell.size()));
}

void CellWeights::keep(std::span<const char> keeps) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < keeps.size(); ++i)
    if (keeps[i]) rows_.row[n++] = rows_.row[i];
  rows_.row.resize(n);
}

}  // namespace snag
