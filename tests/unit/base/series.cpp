// Monitors as CSV: what is written comes back to the bit, and a resumed run leaves no line twice and no half line.
#include "base/series.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <sstream>

#include "base/error.hpp"

namespace snag {
namespace {

class SeriesFile : public testing::Test {
 protected:
  std::filesystem::path file = std::filesystem::temp_directory_path() / ("snag_series_" + std::to_string(getpid()) + ".csv");
  void TearDown() override { std::filesystem::remove(file); }
  std::string content() const {
    std::stringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }
  void append(const std::string& text) const { std::ofstream(file, std::ios::app) << text; }
};

// The header holds the units; numbers come back to the bit, also negative zero, denormals and what is not a number.
TEST_F(SeriesFile, KeepsNumbersToTheBit) {
  const std::vector<double> odd = {1.0 / 3, -0.0, 5e-324, NAN, INFINITY, -1e308};
  Series series(file, {"time [s]", "a [1]", "b [m]", "c [N]", "d [1]", "e [m/s]"});
  series.add(odd);
  EXPECT_TRUE(content().starts_with("time [s],a [1],b [m],c [N],d [1],e [m/s]\n0.33333333333333331,-0,"));
  const auto table = read_series(file);
  ASSERT_EQ(table.columns.size(), 6u);
  for (int i : {0, 1, 2, 4, 5}) {
    EXPECT_EQ(table.values[i].at(0), odd[i]);
    EXPECT_EQ(std::signbit(table.values[i].at(0)), std::signbit(odd[i]));
  }
  EXPECT_TRUE(std::isnan(table.values[3].at(0)));
}

// A record is on disk as soon as it is added: a run that dies keeps its monitors.
TEST_F(SeriesFile, IsFlushedLineByLine) {
  Series series(file, {"time [s]"});
  series.add({1});
  EXPECT_EQ(content(), "time [s]\n1\n");
}

// A file that was removed, by itself or with its folder, is missed at the next check, also if another one has its name by then.
TEST_F(SeriesFile, ReportsThatItWasRemoved) {
  Series series(file, {"time [s]"});
  series.add({1});
  EXPECT_NO_THROW(series.check());
  std::filesystem::remove(file);
  append("time [s]\n");
  series.add({2});
  try {
    series.check();
    ADD_FAILURE() << "not missed";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::io);
    EXPECT_TRUE(std::string(error.what()).starts_with(file.string() + ": was removed")) << error.what();
  }
}

// A record for which the disk has no room is an error of the next check, not of the call of the one rank that writes.
TEST_F(SeriesFile, ReportsAFullDisk) {
  Series series(file, {"time [s]"});
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit little{4, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &little);
  series.add({1});
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_THROW(series.check(), Error);
}

// A resume from t cuts what is later than t and keeps what is at t, also several lines of one time.
TEST_F(SeriesFile, ResumeCutsLaterLines) {
  const std::vector<std::string> columns = {"time [s]", "rag [1]"};
  {
    Series series(file, columns);
    for (int step = 1; step <= 4; ++step)
      for (int rag = 0; rag < 2; ++rag) series.add({0.1 * step, double(rag)});
  }
  {
    Series series(file, columns, true, 0.3);  // the lines say 0.1 * 3, which is larger by round-off
    series.add({0.35, 0});
  }
  EXPECT_EQ(content(),
            "time [s],rag [1]\n0.10000000000000001,0\n0.10000000000000001,1\n0.20000000000000001,0\n0.20000000000000001,1\n"
            "0.30000000000000004,0\n0.30000000000000004,1\n0.34999999999999998,0\n");
}

// The half line that a killed run leaves is dropped, even where it reads as a number of the right count.
TEST_F(SeriesFile, ResumeDropsATruncatedLastLine) {
  for (const char* half : {"0.2", "0.2,", "0.2,1.5", ""}) {
    { Series(file, {"time [s]", "head [m]"}).add({0.1, 8}); }
    append(half);
    EXPECT_EQ(read_series(file).column("head").size(), 1u) << half;
    { Series(file, {"time [s]", "head [m]"}, true, 1).add({0.2, 9}); }
    EXPECT_EQ(content(), "time [s],head [m]\n0.10000000000000001,8\n0.20000000000000001,9\n") << half;
  }
}

// A file whose header was cut off, or that is missing, is begun again on a resume.
TEST_F(SeriesFile, ResumeWithoutAHeaderBeginsAgain) {
  append("time [s");
  { Series(file, {"time [s]", "head [m]"}, true, 1).add({2, 9}); }
  EXPECT_EQ(content(), "time [s],head [m]\n2,9\n");
  std::filesystem::remove(file);
  { Series(file, {"time [s]", "head [m]"}, true, 1).add({2, 9}); }
  EXPECT_EQ(content(), "time [s],head [m]\n2,9\n");
}

// Without a resume an old file is begun again.
TEST_F(SeriesFile, StartBeginsAgain) {
  append("time [s]\n1\n");
  Series series(file, {"time [s]"});
  EXPECT_EQ(content(), "time [s]\n");
}

// Other columns than those in the file are an error on a resume, and the file is left as it was.
TEST_F(SeriesFile, ResumeRefusesOtherColumns) {
  append("time [s],head [m]\n1,2\n");
  try {
    Series series(file, {"time [s]", "head [cm]"}, true, 1);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::io);
    EXPECT_NE(std::string(error.what()).find("head [cm]"), std::string::npos);
  }
  EXPECT_EQ(content(), "time [s],head [m]\n1,2\n");
}

// A line that is no record is named with its number; nothing is skipped silently.
TEST_F(SeriesFile, NamesABadLine) {
  append("time [s],head [m]\n1,2\n1,x\n3,4\n");
  try {
    read_series(file);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(":3: \"1,x\""), std::string::npos) << error.what();
  }
}

// A column is found by its name without the unit; an unknown one lists the known ones; a wrong count of values is refused.
TEST_F(SeriesFile, FindsColumnsByName) {
  Series series(file, {"time [s]", "head [m]", "head_static [m]"});
  series.add({1, 2, 3});
  const auto table = read_series(file);
  EXPECT_EQ(table.column("head").at(0), 2);
  EXPECT_EQ(table.column("head_static [m]").at(0), 3);
  try {
    table.column("torque");
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("time [s],head [m],head_static [m]"), std::string::npos);
  }
  EXPECT_THROW(series.add({1, 2}), Error);
  EXPECT_THROW(Series(file, {"time [s]", "a\nb"}), Error);
}

// A patch may be called anything that stands on one line.
TEST_F(SeriesFile, KeepsNamesWithCommasAndQuotes) {
  const std::vector<std::string> columns{"time [s]", "a,b_flow [m3/s]", "\"c\"_flow [m3/s]"};
  {
    Series series(file, columns);
    series.add({1, 2, 3});
  }
  Series resumed(file, columns, true, 1);
  EXPECT_EQ(read_series(file).columns, columns);
  EXPECT_EQ(read_series(file).column("a,b_flow").at(0), 2);
}

}  // namespace
}  // namespace snag
