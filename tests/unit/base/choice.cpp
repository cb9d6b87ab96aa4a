// A choice is a word in the case file and an enumeration in the program.
#include "base/choice.hpp"

#include <gtest/gtest.h>

#include "base/case_file.hpp"
#include "base/error.hpp"
#include "base/section_text.hpp"

namespace snag {
namespace {

struct Settings {
  enum class Shape { sphere, fibre, sheet };
  Choice<Shape> shape{Shape::fibre, {"sphere", "fibre", "sheet"}};
  Section section(std::vector<std::string> allowed = {}) {
    return {"piece", "A piece.", {setting("shape", &shape, "What it is.", std::move(allowed))}};
  }
};

CaseFile read(const std::string& text, Settings& settings, std::vector<std::string> allowed = {}) {
  CaseFile file = CaseFile::parse(text);
  file.root().table("piece").read(settings.section(std::move(allowed)).parameters);
  return file;
}

std::string message_of(const std::string& text, std::vector<std::string> allowed = {}) {
  Settings settings;
  try {
    read(text, settings, std::move(allowed));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Requirement: the word of the file becomes the value of the enumeration; without the key it is the default.
TEST(Choice, IsReadByItsWord) {
  Settings settings;
  read("", settings);
  EXPECT_EQ(settings.shape, Settings::Shape::fibre);
  const CaseFile file = read("[piece]\nshape = \"sheet\"\n", settings);
  EXPECT_EQ(settings.shape, Settings::Shape::sheet);
  EXPECT_EQ(settings.shape.word(), "sheet");
  EXPECT_NE(file.resolved().find("shape = \"sheet\""), std::string::npos) << file.resolved();
  settings.shape = Settings::Shape::sphere;
  EXPECT_EQ(settings.shape.word(), "sphere");
}

/// Requirement: another word is refused with the known ones and the nearest of them; so is one that this table does not allow.
TEST(Choice, RefusesOtherWords) {
  EXPECT_NE(
      message_of("[piece]\nshape = \"shet\"\n").find("is \"shet\", but it must be one of sphere, fibre, sheet; did you mean \"sheet\"?"),
      std::string::npos);
  EXPECT_NE(message_of("[piece]\nshape = 2\n").find("it must be a text in quotes"), std::string::npos);
  EXPECT_NE(message_of("[piece]\nshape = \"sheet\"\n", {"sphere", "fibre"}).find("it must be one of sphere, fibre"), std::string::npos);
  Settings settings;
  EXPECT_THROW(settings.shape.choose("shet"), std::logic_error);
}

/// Requirement: the manual shows the default and all words.
TEST(Choice, IsInTheManual) {
  Settings settings;
  EXPECT_NE(section_text(settings.section()).find("| `shape` |  | `\"fibre\"` | [sphere, fibre, sheet] |"), std::string::npos)
      << section_text(settings.section());
}

}  // namespace
}  // namespace snag
