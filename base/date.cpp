#include "base/date.hpp"

#include <ctime>

namespace snag {

std::string date() {
  char text[32] = "";
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", gmtime_r(&now, &utc));
  return text;
}

}  // namespace snag
