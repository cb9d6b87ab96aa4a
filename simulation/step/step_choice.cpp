#include "simulation/step/step_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace snag {

namespace {

// The water is of second order in time where steps are small; at degrees a step less was observed: 0.77 for the torque of a pump.
constexpr double order_least = 0.5, order_most = 2, order_of_two = 1;
constexpr double safety = 1.25;

/// One quantity of all trials.
class Quantity {
 public:
  Quantity(const std::vector<StepTrial>& trials, std::size_t quantity) : trials_(trials), quantity_(quantity) {}

  std::size_t finest() const { return trials_.size() - 1; }
  double value(std::size_t i, std::size_t before_last = 0) const {
    const auto& means = trials_[i].means;
    return means[means.size() - 1 - before_last][quantity_];
  }
  double difference(std::size_t i) const { return value(i) - value(i - 1); }
  /// u, not yet relative.
  double change(std::size_t i) const {
    if (trials_[i].means.size() < 2) return 0;
    const std::size_t of = std::min(i, finest() - 1);
    return std::abs((value(of) - value(finest())) - (value(of, 1) - value(finest(), 1)));
  }
  bool converges() const {
    if (trials_.size() < 3) return true;
    const double before = difference(finest() - 1), last = difference(finest());
    return last == 0 || (before * last > 0 && std::abs(last) < std::abs(before));
  }
  double finest_error() const {
    double order = order_of_two;
    if (trials_.size() > 2 && converges() && difference(finest()) != 0)
      order = std::clamp(std::log2(difference(finest() - 1) / difference(finest())), order_least, order_most);
    return safety * std::abs(difference(finest())) / (std::exp2(order) - 1);
  }
  double relative(double of) const {
    const double scale = std::abs(value(finest()));
    return scale > 0 ? of / scale : std::numeric_limits<double>::infinity();
  }

 private:
  const std::vector<StepTrial>& trials_;
  std::size_t quantity_;
};

}  // namespace

StepChoice choose_step(const std::vector<StepTrial>& trials, double accuracy) {
  StepChoice choice{.chosen = {}, .error = std::vector<std::vector<double>>(trials.size())};
  for (std::size_t q = 0; q < trials.front().means.front().size(); ++q) {
    const Quantity of(trials, q);
    choice.converges = choice.converges && of.converges();
    for (std::size_t i = 0; i < trials.size(); ++i) {
      choice.error[i].push_back(of.relative(std::abs(of.value(i) - of.value(of.finest())) + of.finest_error() + of.change(i)));
      choice.has_settled = choice.has_settled && of.relative(of.change(i)) <= accuracy;
    }
  }
  const auto is_accurate = [&](const std::vector<double>& errors) {
    return std::all_of(errors.begin(), errors.end(), [&](double e) { return e <= accuracy; });  // not a number is none
  };
  for (std::size_t i = trials.size(); i > 0 && is_accurate(choice.error[i - 1]); --i) choice.chosen = i - 1;
  return choice;
}

}  // namespace snag
