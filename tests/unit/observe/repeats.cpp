// Tables of repeats: what is read, what is compared, what is refused.
#include "observe/repeats.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>

#include "base/error.hpp"

using namespace snag;

namespace {

class Table {
 public:
  explicit Table(const std::string& text)
      : file_(std::filesystem::temp_directory_path() / ("snag-repeats-" + std::to_string(std::random_device{}()) + ".csv")) {
    std::ofstream(file_) << text;
  }
  ~Table() { std::filesystem::remove(file_); }
  Repeats read() const { return read_repeats(file_); }
  /// The message with which the table, or the comparison of it, is refused.
  std::string refusal() const {
    try {
      compare_groups(read(), "table");
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::usage);
      return error.what();
    }
    return "";
  }

 private:
  std::filesystem::path file_;
};

}  // namespace

// The two groups of PassesOfTheSameRag: F = 8/10 of all samples, 7/13 of it with 28/13 samples a group. With one degree of freedom between
// groups F is the square of Student's t; with six within them P(|t| > tan a sqrt 6) = 1 - sin a (1 + c/2 + 3/8 c^2), c = cos^2 a.
TEST(Repeats, TwoOperatingPoints) {
  const Table table("# two operating points\nrag, group, length [mm]\nA,55,1\nA,55,3\nB,55,5\nB,55,7\n\nA,90,2\nA,90,4\nB,90,8\nB,90,10\n");
  const std::vector<GroupComparison> found = compare_groups(table.read(), "table");
  ASSERT_EQ(found.size(), 1U);
  const GroupComparison& length = found[0];
  EXPECT_EQ(length.quantity.name + " " + length.quantity.unit, "length mm");
  EXPECT_NEAR(length.groups[1].values.mean, 6, 1e-12);
  EXPECT_NEAR(length.groups[1].values.sigma, std::sqrt(40.0 / 3), 1e-12);
  EXPECT_EQ(length.groups[1].n, 4);
  EXPECT_NEAR(length.groups[1].n_independent, 28.0 / 13, 1e-12);
  EXPECT_NEAR(length.by_count.F, 0.8, 1e-12);
  const double angle = std::atan(std::sqrt(0.8 / 6)), c = std::pow(std::cos(angle), 2);
  EXPECT_NEAR(length.by_count.p, 1 - std::sin(angle) * (1 + c / 2 + 3 * c * c / 8), 1e-12);
  EXPECT_NEAR(length.by_independent.value().F, 0.8 * 7 / 13, 1e-12);
  EXPECT_GT(length.by_independent->p, length.by_count.p);
}

TEST(Repeats, OrientationsAreAxes) {
  // Requirement: axes at 88 and -88 degrees lie around 90, not around 0, and do not differ from those at 87 and -89.
  const Table table("group,orientation [deg]\na,88\na,-88\nb,87\nb,-89\n");
  const GroupComparison found = compare_groups(table.read(), "table").at(0);
  EXPECT_NEAR(std::abs(found.groups[0].values.mean), 90, 1e-9);
  EXPECT_NEAR(found.groups[0].values.sigma, std::sqrt(8.0), 1e-9);
  EXPECT_NEAR(found.groups[1].values.mean, 89, 1e-9);
  EXPECT_NEAR(found.by_count.F, 1 / 8.0, 1e-9);  // means 1 apart, variance 8, 2 samples each: 4 x 1/4 / 8
}

TEST(Repeats, TooFewIndependentSamples) {
  // Requirement: one slow wave in each group is worth one sample a group, and of those there is no p.
  std::string text = "group,value\n";
  for (const char* group : {"a,", "b,"})
    for (int k = 0; k < 60; ++k) text += group + std::to_string(std::sin(2 * std::numbers::pi * (k + 0.5) / 60)) + "\n";
  const GroupComparison found = compare_groups(Table(text).read(), "table").at(0);
  EXPECT_EQ(found.dependence, Dependence::autocorrelation);
  EXPECT_EQ(found.groups[0].n_independent, 1);
  EXPECT_FALSE(found.by_independent);
  EXPECT_NE(words_of({found}).find("too few"), std::string::npos);
  EXPECT_NE(anova_csv({found}).find("nan,nan,autocorrelation"), std::string::npos);
}

TEST(Repeats, FalseAlarms) {
  // Requirement: of three groups of 20 rags seen 10 times each, drawn from one law with an intraclass correlation of 0.3, p_eff is below
  // 0.05 in about 5 % of the draws, where p is in nearly half of them.
  std::mt19937_64 engine(1);
  std::normal_distribution<double> normal;
  constexpr int n_draws = 400;
  int alarms = 0, alarms_eff = 0;
  for (int draw = 0; draw < n_draws; ++draw) {
    Repeats repeats{{"a", "b", "c"}, {{"area", "m2"}}, {}};
    for (int rag = 0; rag < 60; ++rag) {
      const double own = std::sqrt(0.3) * normal(engine);
      for (int pass = 0; pass < 10; ++pass) repeats.rows.push_back({rag / 20, rag % 20, {own + std::sqrt(0.7) * normal(engine)}});
    }
    const GroupComparison found = compare_groups(repeats, "draw").at(0);
    alarms += found.by_count.p < 0.05, alarms_eff += found.by_independent->p < 0.05;
  }
  EXPECT_GT(alarms, 0.35 * n_draws);
  EXPECT_GE(alarms_eff, 0.02 * n_draws);
  EXPECT_LE(alarms_eff, 0.09 * n_draws);
}

TEST(Repeats, Refused) {
  // Requirement: one message that names what is wrong and where.
  const auto refused = [](const std::string& text, const std::string& message) {
    EXPECT_NE(Table(text).refusal().find(message), std::string::npos) << Table(text).refusal();
  };
  refused("group,area [m2]\na,1\na,2\n", "at least two");
  refused("group,area [m2]\na,1\na,2\nb,3\n", "group \"b\" has 1 sample");
  refused("group,area [m2]\na,0.1\na,0.1\nb,0.1\nb,0.1\n", "does not vary");
  refused("group,area [m2]\na,1\na,1\nb,2\nb,2\n", "does not vary");
  refused("group,area [m2]\na,1\na,nan\nb,3\nb,4\n", ":3: area [m2] \"nan\" must be a finite number");
  refused("group,area [m2]\na,1\na,-1e308\nb,3\nb,4\n", ":3: area [m2] \"-1e308\" must be a finite number of at most 1e+30 in size");
  refused("group,area [m2]\na,1\na,\nb,3\nb,4\n", ":3: area [m2] \"\" must be a finite number");
  refused("group,area [m2]\na,1\na,2,3\n", ":3: 3 fields");
  refused("point,area [m2]\na,1\n", "no column \"group\"");
  refused("group,rag\na,1\n", "no column of values");
  const std::string long_name(3000, 'x');
  EXPECT_LT(Table("point" + long_name + ",area [m2]\na,1\n").refusal().size(), 1000u) << "a long name is cut";
  EXPECT_LT(Table("group,area [m2]\n" + long_name + ",1\n" + long_name + ",1\n").refusal().size(), 1000u);
  refused("group,orientation [rad]\na,1\n", "in degrees");
  refused("group,area,area\na,1,2\n", "is given twice");
  refused("", "is empty");
  Repeats unseen = Table("group,v\na,1\na,2\nb,1\nb,2\n").read();
  unseen.rows[2].values[0] = std::nan("");
  EXPECT_THROW(compare_groups(unseen, "pictures"), Error);
  EXPECT_THROW(read_repeats("none.csv"), Error);
}
