#pragma once
// The motion of a rag until it first touches a wall or begins to leave: what a simulation predicts before contacts make it chaotic, so that
// kernels, meshes and steps can be compared one with one. Until then
//
//   J = sum over steps of the water's impulse on the rag, N s;    s = sum over steps of |x_{n+1} - x_n|, x the centre of mass, m
//
// A rag that does neither moves freely to the end of the run.
#include <optional>
#include <vector>

#include "dem/rag_system.hpp"
#include "simulation/output/rag_forces.hpp"
#include "simulation/setup/passage.hpp"

namespace snag {

struct FreeMotionResult {
  std::optional<double> first_contact;  // with a wall, end of that step, s; absent: none yet
  double duration = 0, path = 0;        // s, m
  Vec3 impulse;                         // N s
  Vec3 mean_force() const { return duration > 0 ? impulse / duration : Vec3{}; }
};

/// Of all rags of a run, the same on every rank.
class FreeMotion {
 public:
  explicit FreeMotion(std::size_t n_rags) : rags_(n_rags) {}
  /// After a step dt that led to `time`, seen by `passage`. The step of the first contact counts. Collective.
  void after_step(const RagSystem& rags, const Passage& passage, const RagForces& forces, double time, double dt);
  const FreeMotionResult& result(std::size_t rag) const { return rags_[rag].result; }

  std::vector<double> state() const;
  void restore(const std::vector<double>& state);

 private:
  struct OfRag {
    FreeMotionResult result;
    std::optional<Vec3> centre;  // at the end of the last step
    bool is_over = false;
  };
  std::vector<OfRag> rags_;
};

}  // namespace snag
