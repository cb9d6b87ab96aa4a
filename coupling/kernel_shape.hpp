#pragma once
// Smoothing kernels: how far the water around a particle counts. A kernel is a pure function of distance; weights, normalisation and
// transfers between ranks are the same for all of them (coupling/kernel.hpp).
#include <span>
#include <string>
#include <vector>

#include "base/parameter.hpp"
#include "base/registry.hpp"

namespace snag {

/// `width` delta is for every kernel the rms width per axis in m, so that kernels can be compared: delta^2 = int x^2 g dV / int g dV.
class KernelShape {
 public:
  virtual ~KernelShape() = default;
  virtual std::string equation() const = 0;
  virtual std::string source() const = 0;
  virtual std::vector<Parameter> parameters() { return {}; }
  /// Distance beyond which g is zero, m; 0: only the cell that holds the particle counts, whatever the width.
  virtual double support_radius(double width) const = 0;
  /// Replace squared distances (m2, all < support radius squared) by ln g, up to a constant that is the same for all calls.
  virtual void log_weights(std::span<double> distance_squared, double width) const = 0;
};

Registry<KernelShape>& kernel_shapes();

}  // namespace snag
