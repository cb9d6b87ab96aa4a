#pragma once
// A place and a size in words, for messages.
#include <cstdio>
#include <string>

#include "base/vec3.hpp"

namespace snag {

inline std::string words(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

inline std::string place(const Vec3& x) {
  std::string text = "(";
  return text.append(words(x.x)).append(", ").append(words(x.y)).append(", ").append(words(x.z)).append(") m");
}

}  // namespace snag
