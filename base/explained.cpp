#include "base/explained.hpp"

#include <filesystem>
#include <new>

#include "base/memory.hpp"
#include "base/quotation.hpp"
#include "base/words.hpp"

namespace snag {

Error explained(const std::exception& failure) {
  if (const auto* known = dynamic_cast<const Error*>(&failure)) return *known;
  const std::string text = shortened(failure.what());
  if (dynamic_cast<const std::bad_alloc*>(&failure) || dynamic_cast<const std::length_error*>(&failure))
    return {ExitCode::io,
            "the memory of this machine (" + number_text(physical_memory() / 1e9) +
                " GB) does not hold what the input asks for; take a smaller mesh, fewer particles or smaller pictures, or more "
                "machines (" +
                text + ")"};
  if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&failure)) {
    constexpr std::size_t longest_path = 400;  // bytes; a longer one is no path that someone wrote
    const std::string path = file->path1().string();
    return {ExitCode::io, (path.size() > longest_path ? shortened(path) : path) + ": cannot be used (" + file->code().message() +
                              "); check the path and its permissions"};
  }
  return {ExitCode::io,
          "an input that Snag does not foresee has stopped it; this is a defect of the program: please report it with the "
          "input (" +
              text + ")"};
}

}  // namespace snag
