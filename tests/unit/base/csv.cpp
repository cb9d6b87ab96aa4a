// Names with commas and quotes stay one field of a CSV line; long values are cut in messages.
#include "base/csv.hpp"

#include <gtest/gtest.h>

#include "base/quotation.hpp"

namespace snag {
namespace {

TEST(Csv, FieldsComeBack) {
  const std::vector<std::string> fields{"plain", "a,b", "say \"no\"", "", "\"", ","};
  std::string line;
  for (const std::string& field : fields) line += (line.empty() ? "" : ",") + csv_field(field);
  EXPECT_EQ(line, "plain,\"a,b\",\"say \"\"no\"\"\",,\"\"\"\",\",\"");
  EXPECT_EQ(csv_fields(line), fields);
}

TEST(Csv, ShortenedValuesKeepWholeCharacters) {
  EXPECT_EQ(shortened("radius"), "radius");
  EXPECT_EQ(shortened(std::string(5000, 'x')), std::string(80, 'x') + "...");
  EXPECT_EQ(shortened(std::string(79, 'x') + "\u00e9" + "y"), std::string(79, 'x') + "...");
  EXPECT_EQ(shortened("red\x1b[31m\n"), "red?[31m?");
}

}  // namespace
}  // namespace snag
