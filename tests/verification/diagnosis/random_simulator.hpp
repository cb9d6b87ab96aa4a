#pragma once
// A simulator whose runs are random: a formula of normal numbers of the seed.
#include <vector>

#include "diagnosis/data/simulator.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {

class RandomSimulator : public Simulator {
 public:
  const std::vector<Effect>& effects() const override { return effects_; }
  const std::vector<Nuisance>& nuisances() const override { return nuisances_; }
  const std::vector<Slot>& slots(int) const override { return slots_; }
  std::vector<RunResult> run(std::span<const RunRequest> requests) override {
    std::vector<RunResult> results;
    for (const RunRequest& r : requests) {
      ++n_runs_;
      NormalNumbers random(r.seed * 100 + static_cast<std::uint64_t>(r.point));
      results.push_back({values(r, random), ""});
    }
    return results;
  }
  int n_runs() const override { return n_runs_; }

 protected:
  /// One for each slot.
  virtual std::vector<double> values(const RunRequest& request, NormalNumbers& random) const = 0;

  std::vector<Effect> effects_;
  std::vector<Nuisance> nuisances_;
  std::vector<Slot> slots_;

 private:
  int n_runs_ = 0;
};

}  // namespace snag
