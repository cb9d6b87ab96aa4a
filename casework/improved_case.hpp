#pragma once
// The base case of each operating point with the effects that a verdict names, ready to run: all its keys, as the run that the verdict
// rests on had them.
#include <filesystem>
#include <string>
#include <vector>

#include "casework/case_simulator.hpp"
#include "diagnosis/data/verdict.hpp"

namespace snag {

struct ImprovedCase {
  std::string file;  // case_with_effects.toml; of several points case_with_effects_POINT.toml
  std::string text;
};

/// Of a verdict that names effects of the model; none where it names no cause, or mistakes of the measurement alone, which change no case.
/// `verdict.improved` gets the names of the files, or the reason why there are none. Collective over the ranks of the simulator; throws
/// Error.
std::vector<ImprovedCase> improved_cases(CaseSimulator& simulator, const Experiment& experiment, Verdict& verdict);

/// Writes them; those that an earlier verdict left in the folder are removed.
void write_improved_cases(const std::filesystem::path& folder, const Experiment& experiment, const std::vector<ImprovedCase>& cases);

}  // namespace snag
