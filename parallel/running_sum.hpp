#pragma once
// Sums to which a rank adds terms over a time, in double-double numbers (parallel/sum.cpp).
#include <mpi.h>

#include <span>
#include <vector>

namespace snag {

/// high + low with |low| <= ulp(high)/2.
struct DoubleDouble {
  double high = 0, low = 0;
};
static_assert(sizeof(DoubleDouble) == 2 * sizeof(double), "sent as two doubles");

class RunningSum {
 public:
  void add(double term);

 private:
  friend std::vector<double> sums(MPI_Comm comm, std::span<const RunningSum> partial);
  DoubleDouble partial_;
};

/// Each of them over all ranks: it does not depend on how the terms are spread over these (but for the last bits). Collective.
std::vector<double> sums(MPI_Comm comm, std::span<const RunningSum> partial);

}  // namespace snag
