#pragma once
// A candidate that the experiment file declares: a number of the case that may be off, such as where a piece starts, how it is crumpled, or
// a length of a law. A run of strength theta has
//
//   value = value of the case + theta                    random:  + theta n(seed)
//   value = value of the case + theta * direction        of vectors
//
// n: standard normal deviate of the seed of a run (even_normal_deviate).
#include <optional>
#include <string>
#include <vector>

#include "base/case_file.hpp"
#include "base/vec3.hpp"
#include "diagnosis/data/simulator.hpp"

namespace snag {

struct OwnCandidate {
  Effect effect;    // its theta in the unit that the file states
  std::string key;  // of the case, with unit
  double unit = 1;  // SI value of one of theta
  std::optional<Vec3> direction{};
  std::string where{};  // "DIAGNOSIS.toml:12: [candidate] start", for messages
};

/// [[candidate]] of DIAGNOSIS.toml. Throws Error(usage).
std::vector<OwnCandidate> read_own_candidates(const Table& root);
/// Its table, for the manual.
Section own_candidate_section();

/// Adds them to the effects. Throws Error(usage) for a name that one has already.
void add_own_candidates(std::vector<Effect>& effects, const std::vector<OwnCandidate>& candidates);

/// Throws Error(usage) for a name that cannot stand for a hypothesis; `where`: of the table, for the message.
void check_name_of_hypothesis(const std::string& name, const std::string& where);

}  // namespace snag
