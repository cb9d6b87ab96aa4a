#pragma once
// A look at one subject: pictures that were taken, or a run and the pictures that a camera would take of it.
#include <cstdint>
#include <filesystem>

#include "observe/passage/findings.hpp"

namespace snag {

/// True of the output folder of a run.
bool is_run(const std::filesystem::path& subject);

/// What `camera` sees; null: nothing, the summary of a run alone is read, and `subject` must be one. Writes observations.csv, outlines/
/// and, of a run, pictures/ to `folder`; `seed` of the virtual camera's noise. Throws Error(usage, io).
Findings analyse(const std::filesystem::path& subject, const Camera* camera, const std::filesystem::path& folder, std::uint64_t seed);

}  // namespace snag
