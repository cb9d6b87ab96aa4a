#pragma once
// Factors of cells at walls (coupling/kernel.hpp), kept from one kernel on a mesh to the next.
#include <deque>
#include <string>
#include <vector>

#include "coupling/kernel_shape.hpp"

namespace snag {

/// Factors d_c of the owned cells of one mesh, by kernel and width, for the kernels that are made on it one after another, as in the runs
/// of a diagnosis. Only the latest are kept: a fit of the width has another one in each run.
class KnownFactors {
 public:
  /// Those of a kernel, as they were kept; null if they are not. Valid until the next keep().
  const std::vector<double>* find(const KernelShape& shape, double width);
  const std::vector<double>& keep(const KernelShape& shape, double width, std::vector<double> factors);

 private:
  struct Entry {
    std::string equation;
    double width;
    std::vector<double> factors;
  };
  std::deque<Entry> entries_;  // the latest use is the last
};

}  // namespace snag
