#pragma once
// The frame of the page: style and the sections in their order.
#include <string>
#include <string_view>

namespace snag {

/// Style of the page, for screen and paper.
extern const std::string_view report_style;

/// `<section>` with a heading; nothing if the content is empty.
std::string section(const std::string& heading, const std::string& content);

}  // namespace snag
