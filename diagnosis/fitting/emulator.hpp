#pragma once
// Between runs at some strengths of one effect: what comes of chance differs from run to run, and says little of a small change of
// strength. Each row is a Gaussian process over the strength,
//
//   f(t) = c + b t + g(t),   g ~ GP(0, a^2 exp(-(t - t')^2/(2 l^2))),   noise: scatter of the runs over their number,
//
// t: strength over the range that was run, a and l those of the largest marginal likelihood on a grid.
// Source: Rasmussen and Williams (2006), Gaussian Processes for Machine Learning, Sections 2.2, 2.7 and 5.4.
#include <vector>

#include "diagnosis/fitting/response.hpp"

namespace snag {

class Emulator {
 public:
  /// `responses`: [strength][training point], strengths in ascending order.
  Emulator(std::vector<double> strengths, std::vector<std::vector<Response>> responses);
  /// Values between the strengths, never beyond those of the runs; scatter and paths are those of the nearest strength, and so are the rows
  /// that some runs have no number for.
  std::vector<Response> at(double strength) const;

 private:
  struct Row {
    Eigen::VectorXd weights;  // of the kernel at each strength; empty: not emulated
    double mean = 0, scale = 1, low = 0, high = 0, amplitude = 0, length = 1;
  };
  double share(double strength) const { return (strength - strengths_.front()) / (strengths_.back() - strengths_.front()); }
  Row emulated(std::size_t point, Eigen::Index row) const;

  std::vector<double> strengths_;
  std::vector<std::vector<Response>> responses_;
  std::vector<std::vector<Row>> rows_;  // by training point
};

}  // namespace snag
