#pragma once
// The manual of the case file and of all other input files, generated from the parameter records; a test compares docs/case-file.md with
// it.
#include <string>

namespace snag {

/// Text of docs/case-file.md. On one rank; throws Error(io) if the mesh generator cannot be started.
std::string case_file_manual();

}  // namespace snag
