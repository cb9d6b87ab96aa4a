#pragma once
// Standard output: whether a person watches it, which decides on colours and on lines that are rewritten, and whether it takes what is
// written.

namespace snag {

/// True if standard output goes to a terminal. A launcher of MPI gives its processes a terminal of its own, whatever its own output is:
/// that one counts.
bool is_watched();

/// Throws Error(io) if not all that was printed so far, by C or C++, has been written. Call it at once: the error names what errno says.
void check_standard_output();

}  // namespace snag
