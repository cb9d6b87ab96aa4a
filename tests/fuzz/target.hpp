#pragma once
// Untrusted input: a target reads one file as the program does. Whatever the file holds, it reads it or throws an Error with the documented
// code; anything else (a signal, another exception, an allocation without measure, a hang) is a finding.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace snag::fuzz {

struct Target {
  std::string name;
  std::string ending;                               // of the file's name
  std::function<std::vector<std::string>()> seeds;  // contents of sound files
  void (*read)(const std::filesystem::path& file);
};

/// Those of this program, in the order of their names.
std::vector<Target>& targets();

struct Registration {
  explicit Registration(Target target);
};

/// Content of a file of the source tree.
std::string source_file(const std::string& path);

}  // namespace snag::fuzz
