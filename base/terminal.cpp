#include "base/terminal.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <string>

#include "base/error.hpp"

namespace snag {

bool is_watched() {
  if (isatty(STDOUT_FILENO) == 0) return false;
  if (std::getenv("OMPI_COMM_WORLD_RANK") == nullptr) return true;
  std::error_code failure;
  const auto output = std::filesystem::read_symlink("/proc/" + std::to_string(getppid()) + "/fd/1", failure);
  return !failure && (output.string().starts_with("/dev/pts/") || output.string().starts_with("/dev/tty"));
}

void check_standard_output() {
  if (std::cout << std::flush && std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  throw Error(ExitCode::io, std::string("standard output: cannot be written (") + std::strerror(errno) +
                                "); check where it is redirected to, and that the disk has space");
}

}  // namespace snag
