#pragma once
// Lines of CSV files: fields are separated by commas, a field with a comma or quotes stands in quotes (RFC 4180). A field has one line.
#include <string>
#include <string_view>
#include <vector>

namespace snag {

/// A field as it is written.
std::string csv_field(std::string_view text);
/// The fields of a line as they were before they were written; at least one.
std::vector<std::string> csv_fields(std::string_view line);

}  // namespace snag
