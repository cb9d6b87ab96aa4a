#pragma once
// The sets of the blind benchmark: which are made, what is true of each, and how the truth is sealed.
//
// The truth goes to a file of its own whose SHA-256 is written down before the set is diagnosed; only the scorer opens it, and only if the
// fingerprint is still that one.
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace snag {

/// What is true of one set.
struct Truth {
  int number = 0;
  std::string kind;                     // null | null_off | single | pair | outside
  std::map<std::string, double> theta;  // of the effects that act
  std::string unmodelled;               // the force that acts instead
  double strength = 0;                  // of what acts, over what is physically expected
  std::string subset;                   // of observables: all | picture | passage
  int replicates = 1;
  double detectability =
      0;  // of what acts: signal over uncertainty, nuisances projected out; of a pair that of the weaker, given the other
  double gap_over_floor = 0;  // rms of the gap over rms of noise and inputs

  /// How the strengths are drawn, in a sentence for the score card: a diagnosis that knows its priors knows as much.
  static constexpr const char* strengths =
      "True strengths are the one that is physically expected times 1/8, 1/4, 1/2 or 1 (pairs, outside: 1/2 or 1) times a uniform number "
      "from 0.8 to 1.2, with either sign where both can be, within the physical range.";
  /// "added_mass+lift", "none", "outside": as the diagnosis names its hypotheses.
  std::string name() const;
};

/// Kind, effects, strengths, subset and replicates of set `number`, of effects that the twin can show, and of those that may be one of a
/// pair. The same for the same seed.
Truth planned_set(int number, std::uint64_t seed, const std::vector<std::string>& effects, const std::vector<std::string>& of_pairs,
                  const std::vector<std::string>& unmodelled_forces, const std::vector<std::string>& subsets);

/// Writes the truth; returns the fingerprint of the file. Throws Error(io).
std::string seal(const Truth& truth, const std::filesystem::path& file);
/// Throws Error(invariant) if the file is not the one that was sealed.
Truth opened(const std::filesystem::path& file, const std::string& sha256);

}  // namespace snag
