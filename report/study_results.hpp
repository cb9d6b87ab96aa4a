#pragma once
// What came out of a study: study.csv and study.html, from the summaries of its runs.
#include <filesystem>

#include "simulation/study.hpp"

namespace snag {

/// Writes both from the runs that have a summary; returns the results of all runs side by side, for people. One rank only; throws
/// Error(io).
std::string write_study_results(const Study& study, const std::filesystem::path& folder);

}  // namespace snag
