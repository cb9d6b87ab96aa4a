#include "simulation/output/step_record.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.hpp"

using namespace snag;

namespace {

StepRecord some_record() {
  StepRecord record{.step = 0.05 / 120, .steps_per_revolution = 120, .accuracy = 0.005, .settling_revolutions = 6, .wall = 75};
  record.water = {{60, 3, 0.05 / 60, 3.3, -10.75, 0.0091, std::numeric_limits<double>::infinity()},
                  {120, 3, 0.05 / 120, 3.32, -10.85, 0.003, 0.002}};
  record.rag = {{120, 0.05 / 120, 0.04, 0.13, 0.02, 0.01, 0.02}};
  record.notes = {"the flow had not settled"};
  return record;
}

}  // namespace

// What a run stores, a resume reads.
TEST(StepRecord, ReturnsFromItsFile) {
  const auto folder = std::filesystem::temp_directory_path() / ("snag-step-record-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  write_step_record(folder, some_record());
  const auto read = read_step_record(folder);
  ASSERT_TRUE(read);
  EXPECT_EQ(step_json(*read).dump(), step_json(some_record()).dump());
  EXPECT_EQ(step_in_words(*read), step_in_words(some_record()));
  std::ofstream(folder / "step.json") << "{\"step_s\": 1}";
  EXPECT_THROW(read_step_record(folder), Error);
  std::filesystem::remove_all(folder);
  EXPECT_FALSE(read_step_record(folder));
}

// The table shows each step with its error.
TEST(StepRecord, InWords) {
  const std::string words = step_in_words(some_record());
  for (const char* part : {"3 degrees a step", "120 steps a revolution", "accuracy of 0.5 %", "0.91 %", "-10.85",
                           "the flow had not settled", "the trial took 75 s"})
    EXPECT_NE(words.find(part), std::string::npos) << part << "\n" << words;
}
