#include "base/log.hpp"

#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <set>

#include "base/error.hpp"
#include "base/terminal.hpp"

namespace snag::log {

namespace {

spdlog::logger& logger() {
  static auto instance = [] {
    auto terminal =
        std::make_shared<spdlog::sinks::stdout_color_sink_mt>(is_watched() ? spdlog::color_mode::automatic : spdlog::color_mode::never);
    terminal->set_pattern("%^%v%$");
    auto made = std::make_shared<spdlog::logger>("snag", terminal);
    made->set_level(spdlog::level::info);
    return made;
  }();
  return *instance;
}

constexpr std::size_t terminal = 0, log_file = 1;  // places among the sinks

/// Calls a sink. A log file that cannot be written (the disk is full) is given up with a warning: whether the run can go on without that
/// disk is for its results to say. A terminal that is gone has nobody to warn.
template <class Call>
void with_sink(std::size_t sink, Call call) {
  if (sink >= logger().sinks().size()) return;
  try {
    call(*logger().sinks()[sink]);
  } catch (const spdlog::spdlog_ex& failure) {
    if (sink == terminal) return;
    logger().sinks().resize(log_file);
    std::fprintf(stderr, "warning: the log ends here: %s\n", failure.what());
  }
}

/// To one place only: the terminal and the file mark the kind of a message each in its own way.
void write(std::size_t sink, spdlog::level::level_enum level, const std::string& message) {
  with_sink(sink, [&](spdlog::sinks::sink& place) {
    if (!logger().should_log(level) || !place.should_log(level)) return;
    place.log({"snag", level, message});
    place.flush();  // a run that is killed leaves all lines
  });
}

}  // namespace

void start(int rank, bool quiet) {
  if (rank != 0) logger().set_level(spdlog::level::off);
  if (quiet) logger().sinks().front()->set_level(spdlog::level::warn);
}

void open(const std::filesystem::path& file, bool append) {
  if (logger().level() == spdlog::level::off) return;
  try {
    auto sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>(file.string(), !append);
    sink->set_pattern("%Y-%m-%d %H:%M:%S %l: %v");
    logger().sinks().resize(1);
    logger().sinks().push_back(sink);
  } catch (const spdlog::spdlog_ex& failure) {
    throw Error(ExitCode::io, file.string() + ": cannot be written (" + failure.what() + "); choose another --out");
  }
}

void info(const std::string& message) {
  write(terminal, spdlog::level::info, message);
  write(log_file, spdlog::level::info, message);
}
void warning(const std::string& message) {
  write(terminal, spdlog::level::warn, "warning: " + message);
  write(log_file, spdlog::level::warn, message);
}

void warning_once(const std::string& message) {
  static std::set<std::string> written;
  if (logger().should_log(spdlog::level::warn) && written.insert(message).second) warning(message);
}

// Errors go to stderr, so that they are seen where stdout is redirected; to the file as well.
void error(const std::string& message) {
  if (logger().level() == spdlog::level::off) return;
  flush();
  std::fprintf(stderr, "error: %s\n", message.c_str());
  write(log_file, spdlog::level::err, message);
}

void flush() {
  for (const std::size_t sink : {terminal, log_file}) with_sink(sink, [](spdlog::sinks::sink& place) { place.flush(); });
}

Silence::Silence() : level_(logger().level()) { logger().set_level(std::max(logger().level(), spdlog::level::err)); }
Silence::~Silence() { logger().set_level(static_cast<spdlog::level::level_enum>(level_)); }

}  // namespace snag::log
