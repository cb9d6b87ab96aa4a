#pragma once
// The log: to the terminal and to log.txt on rank 0, silent on the other ranks.
#include <filesystem>
#include <string>

namespace snag::log {

/// Called once after MPI has started; quiet: warnings and errors only on the terminal (the file has all messages).
void start(int rank, bool quiet = false);
/// Also write to this file from now on (appends after a resume).
void open(const std::filesystem::path& file, bool append);
void info(const std::string& message);
void warning(const std::string& message);
/// A warning that is written once, however often it comes; not at all while a Silence lives.
void warning_once(const std::string& message);
void error(const std::string& message);
void flush();

/// While an object of this class lives, only errors are logged: for a run in memory that is one of many.
class Silence {
 public:
  Silence();
  ~Silence();
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  int level_;
};

}  // namespace snag::log
