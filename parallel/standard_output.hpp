#pragma once
// What a command prints as its result, as the manual does: a result that was not written is an error, as with a file. Lines of the log are
// none: a run goes on without its terminal.
#include <functional>
#include <string>

namespace snag {

/// On rank 0. Collective; throws Error(io).
void print(const std::string& text);

/// The text to the file of --out; without one it is printed. Rank 0 makes and writes it. Collective; throws Error(io).
void write_or_print(const std::string& file, const std::function<std::string()>& text);

}  // namespace snag
