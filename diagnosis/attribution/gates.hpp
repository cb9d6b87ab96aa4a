#pragma once
// Where an effect may begin to act: families of gates, each of one number, the place of the gate.
//
//   time     from t_0 on
//   x, y, z  beyond a plane across the axis, on the side to which the pieces move
//
// The place of a gate is as likely anywhere in the range of its family.
#include <array>
#include <string>
#include <vector>

#include "diagnosis/fitting/response.hpp"

namespace snag {

struct GateFamily {
  int axis = -1;             // 0, 1, 2: x, y, z; -1: time
  bool is_upwards = true;    // open above the place
  double low = 0, high = 0;  // range of the place, s or m

  Gate at(double place) const;
  bool is_everywhere() const { return !(high > low); }
  std::string name() const { return axis < 0 ? "t" : std::string(1, "xyz"[axis]); }
  std::string unit() const { return axis < 0 ? "s" : "m"; }
};

/// Those that the paths of the training points can show; `base`: responses of the base model there.
std::vector<GateFamily> gate_families(const Responses& model, const std::vector<Response>& base);

}  // namespace snag
