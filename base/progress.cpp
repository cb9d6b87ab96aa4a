#include "base/progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/log.hpp"
#include "base/terminal.hpp"

namespace snag {

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds terminal_interval{200};
constexpr std::chrono::seconds batch_interval{30};

double seconds_since(Clock::time_point then) { return std::chrono::duration<double>(Clock::now() - then).count(); }

}  // namespace

Progress::Progress(std::string what, double total, double start)
    : what_(std::move(what)), total_(total), start_(start), terminal_(is_watched()), begun_(Clock::now()) {
  // A terminal shows the first update at once; a batch log only what takes long.
  printed_ = terminal_ ? begun_ - terminal_interval : begun_;
}

void Progress::update(double done, const std::string& note) {
  const auto now = Clock::now();
  if (now - printed_ < (terminal_ ? Clock::duration(terminal_interval) : Clock::duration(batch_interval))) return;
  printed_ = now;
  const double part = total_ > 0 ? std::clamp(done / total_, 0.0, 1.0) : 1.0;
  char percent[16];
  std::snprintf(percent, sizeof percent, "%5.1f %%", 100 * part);
  std::string line = what_ + " " + percent;
  if (done > start_) line += ", " + duration(seconds_since(begun_) * std::max(0.0, total_ - done) / (done - start_)) + " left";
  if (!note.empty()) line += ", " + note;
  if (terminal_) {
    std::fputs(("\r\033[K" + line).c_str(), stdout);
    std::fflush(stdout);
  } else {
    log::info(line);
  }
}

void Progress::finish() {
  if (terminal_) {
    std::fputs("\r\033[K", stdout);
    std::fflush(stdout);
  }
  log::info(what_ + " done in " + duration(seconds_since(begun_)));
}

std::string duration(double seconds) {
  if (!std::isfinite(seconds) || seconds < 0) return "? s";
  char text[48];
  if (seconds < 9.95) {
    std::snprintf(text, sizeof text, "%.1f s", seconds);
    return text;
  }
  const double whole = std::round(seconds);
  if (whole < 120) {
    std::snprintf(text, sizeof text, "%.0f s", whole);
  } else if (whole < 3600) {
    std::snprintf(text, sizeof text, "%.0f min %02.0f s", std::floor(whole / 60), std::fmod(whole, 60));
  } else {
    const double minutes = std::round(seconds / 60);
    std::snprintf(text, sizeof text, "%.0f h %02.0f min", std::floor(minutes / 60), std::fmod(minutes, 60));
  }
  return text;
}

}  // namespace snag
