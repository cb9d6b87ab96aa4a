#include "base/log.hpp"

#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>

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
    made->flush_on(spdlog::level::info);  // a run that is killed leaves all lines
    return made;
  }();
  return *instance;
}

/// To one place only: the terminal and the file mark the kind of a message each in its own way.
void write(std::size_t sink, spdlog::level::level_enum level, const std::string& message) {
  if (sink >= logger().sinks().size() || !logger().should_log(level) || !logger().sinks()[sink]->should_log(level)) return;
  logger().sinks()[sink]->log({"snag", level, message});
  logger().sinks()[sink]->flush();  // as the logger does after each line
}
constexpr std::size_t terminal = 0, log_file = 1;

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

void info(const std::string& message) { logger().info(message); }
void warning(const std::string& message) {
  write(terminal, spdlog::level::warn, "warning: " + message);
  write(log_file, spdlog::level::warn, message);
}

// Errors go to stderr, so that they are seen where stdout is redirected; to the file as well.
void error(const std::string& message) {
  if (logger().level() == spdlog::level::off) return;
  flush();
  std::fprintf(stderr, "error: %s\n", message.c_str());
  write(log_file, spdlog::level::err, message);
}

void flush() { logger().flush(); }

Silence::Silence() : level_(logger().level()) { logger().set_level(std::max(logger().level(), spdlog::level::err)); }
Silence::~Silence() { logger().set_level(static_cast<spdlog::level::level_enum>(level_)); }

}  // namespace snag::log
