#pragma once
// The pressure level p that brings the flow Q through an outlet to a target Q_t. The water column obeys
//
//   I dQ/dt = H(Q, t) - p        I = rho/G: its inertance, kg/m4;   H: the level at which the flow would stay as it is, not known, Pa
//   H* <- H* + (1 - exp(-dt/T)) (p + I dQ/dt - H*),       p = H* + I (Q - Q_t)/T
//
// so that the error e = Q - Q_t obeys e'' + 2 e'/T + e/T^2 = H'/I: critically damped with the response time T, and none is left once H is
// steady. Losses that lower H by R dQ add R/I e': the flow then comes to its target from one side, in the time 2 T + R T^2/I. Stable for
// any I between 0 and 1/s times the true one (s = dt/T, explicit in time), so that I need not be exact; one that is too small makes the
// flow swing about the target.
#include <vector>

namespace snag {

class FlowTarget {
 public:
  /// `conductance`: G of the water column, m; `level`: p at the start, Pa.
  FlowTarget(double conductance, double level) : conductance_(conductance), level_(level), holding_(level) {}

  /// What a step of size dt begins with: flow out of the domain at its begin and one step before, m3/s.
  struct Measured {
    double flow = 0, flow_before = 0;
    double dt = 0, dt_before = 0;  // s; dt_before: 0 at the first step of a run, when there is no flow_before
  };
  /// The level for the step's end.
  void advance(const Measured& measured, double target, double density, double response_time);
  /// The level at the start where an initial field gives it.
  void set_level(double level) { level_ = holding_ = level; }
  /// p, Pa.
  double level() const { return level_; }

  /// All there is, for a checkpoint.
  std::vector<double> state() const { return {conductance_, level_, holding_, known_ ? 1.0 : 0.0}; }
  void restore(const std::vector<double>& state);

 private:
  double conductance_, level_, holding_;  // G, p, H*
  bool known_ = false;                    // H* has been measured
};

}  // namespace snag
