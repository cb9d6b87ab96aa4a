#pragma once
// Whether a person watches: decides on colours and on lines that are rewritten.

namespace snag {

/// True if standard output goes to a terminal. A launcher of MPI gives its processes a terminal of its own, whatever its own output is:
/// that one counts.
bool is_watched();

}  // namespace snag
