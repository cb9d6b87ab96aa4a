#pragma once
// A simulator whose runs are a formula, of normal numbers of the seed where they are random.
#include <map>
#include <string>
#include <vector>

#include "diagnosis/data/simulator.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {

/// Strength of an effect or deviation of an input; 0 where it is not in the request.
inline double number_of(const std::map<std::string, double>& numbers, const std::string& name) {
  const auto found = numbers.find(name);
  return found == numbers.end() ? 0 : found->second;
}

class TestSimulator : public Simulator {
 public:
  const std::vector<Effect>& effects() const override { return effects_; }
  const std::vector<Nuisance>& nuisances() const override { return nuisances_; }
  const std::vector<Slot>& slots(int) const override { return slots_; }
  std::vector<RunResult> run(std::span<const RunRequest> requests) override {
    std::vector<RunResult> results;
    for (const RunRequest& r : requests) {
      ++n_runs_;
      NormalNumbers random(r.seed * 100 + static_cast<std::uint64_t>(r.point));
      results.push_back({values(r, random), failure(r)});
    }
    return results;
  }
  int n_runs() const override { return n_runs_; }

 protected:
  /// One for each slot.
  virtual std::vector<double> values(const RunRequest& request, NormalNumbers& random) const = 0;
  /// Why the run fails; empty: it does not.
  virtual std::string failure(const RunRequest&) const { return ""; }

  std::vector<Effect> effects_;
  std::vector<Nuisance> nuisances_;
  std::vector<Slot> slots_;

 private:
  int n_runs_ = 0;
};

}  // namespace snag
