#include "diagnosis/data/experiment.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "tests/keys_of_sections.hpp"

using namespace snag;

namespace {

class ReadExperiment : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("snag-experiment-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& toml, const std::string& csv) const {
    std::ofstream(folder_ / "data.csv") << csv;
    std::ofstream(folder_ / "DIAGNOSIS.toml") << toml;
    return folder_ / "DIAGNOSIS.toml";
  }
  std::string message(const std::string& toml, const std::string& csv) const {
    try {
      read_experiment(write(toml, csv));
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  }

  std::filesystem::path folder_;
};

const std::string head = "[experiment]\nname = \"drop\"\ndata = \"data.csv\"\n";
const std::string x_mm = "[[observable]]\nid = \"x\"\nunit = \"mm\"\nnoise_u = 0.1\nbias_u = 0.2\n";
const std::string A = "[[point]]\nid = \"A\"\ncase = \"a.toml\"\ninput_u = { \"flow.amplitude\" = 0.05 }\n";
const std::string B = "[[point]]\nid = \"B\"\ncase = \"b.toml\"\nrole = \"withheld\"\n";
const std::string columns = "point,replicate,t_s,observable,value\n";

#define EXPECT_TOLD(told, part) EXPECT_NE((told).find(part), std::string::npos) << (told)

}  // namespace

TEST_F(ReadExperiment, ConvertsAndSorts) {
  const auto e = read_experiment(
      write(head + x_mm + A + B +
                "[model]\ncandidates = [\"lift\"]\npairs = false\n[budget]\nmax_runs = 50\nseed = 7\ncost = { \"flow.amplitude\" = 2.5 }\n",
            columns + "B,0,0.1,x,7\r\n# a remark\nA,0,0.2,x,2\nA,0,0.1,x,+1\n\nA,1,0.1,x,1.5\n"));
  ASSERT_EQ(e.data.size(), 4u);
  EXPECT_DOUBLE_EQ(e.data[0].value, 1e-3);
  EXPECT_DOUBLE_EQ(e.data[1].time, 0.2);
  EXPECT_EQ(e.data[3].point, 1);
  EXPECT_DOUBLE_EQ(e.observables[0].noise_u, 1e-4);
  EXPECT_DOUBLE_EQ(e.observables[0].bias_u, 2e-4);
  EXPECT_TRUE(e.points[1].withheld);
  ASSERT_EQ(e.points[0].input_u.size(), 1u);
  EXPECT_EQ(e.points[0].input_u[0].first, "flow.amplitude");
  EXPECT_EQ(e.candidates, std::vector<std::string>{"lift"});
  EXPECT_FALSE(e.pairs);
  EXPECT_EQ(e.max_runs, 50);
  EXPECT_EQ(e.seed, 7u);
  EXPECT_EQ(e.costs, (std::vector<std::pair<std::string, double>>{{"flow.amplitude", 2.5}}));
  EXPECT_EQ(e.data_sha256.size(), 64u);
  // The fingerprint of what is withheld does not depend on the training data.
  const auto other =
      read_experiment(write(head + x_mm + A + B + "[model]\ncandidates = \"all\"\n", columns + "B,0,0.1,x,7\nA,0,0.2,x,3\n"));
  EXPECT_TRUE(other.candidates.empty());
  EXPECT_EQ(other.withheld_sha256, e.withheld_sha256);
  EXPECT_NE(other.data_sha256, e.data_sha256);
}

TEST_F(ReadExperiment, ExplainsMistakesOfTheFile) {
  const std::string row = columns + "A,0,0.1,x,1\n";
  EXPECT_TOLD(message(head + "[[observable]]\nid = \"x\"\nnoise_u = 1\n" + A, row), "unit");
  EXPECT_TOLD(message(head + "[[observable]]\nid = \"x\"\nunit = \"furlong\"\nnoise_u = 1\n" + A, row), "unknown unit \"furlong\"");
  EXPECT_TOLD(message(head + x_mm + A + B, row), "point \"B\" has no rows");
  EXPECT_TOLD(message(head + x_mm + B, columns + "B,0,0.1,x,1\n"), "every point is withheld");
  EXPECT_TOLD(message(head + x_mm + B + "[[point]]\nid = \"B\"\ncase = \"b.toml\"\n", row), "never both");
  EXPECT_TOLD(message(head + x_mm + "kind = \"gauss\"\n" + A, row), "gaussian");
  EXPECT_TOLD(message(head + x_mm + A + "[budget]\ncost = { \"flow.amplitude\" = 0 }\n", row), "more than 0 repeats");
  EXPECT_TOLD(message(head + x_mm + A + "[model]\ncandidate = \"all\"\n", row), "did you mean \"candidates\"");
  std::string copied = columns;
  for (int i = 0; i < 10; ++i)
    for (const char point : {'A', 'B'})
      copied += std::string(1, point) + ",0," + std::to_string(0.1 * i) + ",x," + std::to_string(i * i) + "\n";
  EXPECT_TOLD(message(head + x_mm + A + B, copied), "withheld data must not be trained on");
}

/// Requirement: the unit of an observable that runs give is one of its kind.
TEST_F(ReadExperiment, UnitsAreOfTheKindOfTheObservable) {
  const auto read = [&](const std::string& id, const std::string& unit) {
    return message(head + "[[observable]]\nid = \"" + id + "\"\nunit = \"" + unit + "\"\nnoise_u = 1\n" + A,
                   columns + "A,0,0.1," + id + ",1\n");
  };
  for (const char* unit : {"kg", "s", "N", "m/s", "1"})
    EXPECT_TOLD(read("x", unit), std::string("the unit \"") + unit + "\" must be of the kind of \"m\", in which runs give x");
  EXPECT_TOLD(read("vx", "mm"), "must be of the kind of \"m/s\"");
  EXPECT_EQ(read("x", "mm"), "accepted");
  EXPECT_EQ(read("vx", "mm/s"), "accepted");
  EXPECT_EQ(read("orientation", "deg"), "accepted");
}

/// Requirement: tables as spreadsheets write them are read, or refused with what is to be changed.
TEST_F(ReadExperiment, TablesOfSpreadsheets) {
  const std::string row = "A,0,0.1,x,1\n";
  EXPECT_EQ(message(head + x_mm + A, "\xEF\xBB\xBF" + columns + row), "accepted");
  EXPECT_EQ(message(head + x_mm + A, "\"point\",\"replicate\",\"t_s\",\"observable\",\"value\"\r\n\"A\",0,0.1,\"x\",1\r\n"), "accepted");
  EXPECT_TOLD(message(head + x_mm + A, columns + "A,0,0.1,x,\"1,5\"\n"), "data.csv:2: a field in quotes holds a comma");
  EXPECT_TOLD(message(head + x_mm + A, "point;replicate;t_s;observable;value\nA;0;0,1;x;1\n"),
              "data.csv:1: the columns are separated by semicolons");
  EXPECT_TOLD(message(head + x_mm + A, "point\treplicate\tt_s\tobservable\tvalue\n"), "the columns are separated by tabs");
}

/// Requirement: tests that ended at the same time before the event are no copy of a withheld point.
TEST_F(ReadExperiment, PointsThatAreAllCensoredAreNoCopies) {
  const std::string time = "[[observable]]\nid = \"retention_time\"\nunit = \"s\"\nkind = \"lognormal\"\nnoise_u = 0.03\n";
  std::string ended = "point,replicate,t_s,observable,value,censored\n";
  for (int i = 0; i < 10; ++i)
    for (const char point : {'A', 'B'}) ended += std::string(1, point) + "," + std::to_string(i) + ",,retention_time,60,1\n";
  EXPECT_EQ(message(head + time + A + B, ended), "accepted");
}

TEST_F(ReadExperiment, ExplainsMistakesOfTheData) {
  const std::string bare = "[[observable]]\nid = \"x\"\nunit = \"mm\"\n";
  EXPECT_TOLD(message(head + x_mm + A, columns + "A,0,0.1,x,nan\n"), "data.csv:2");
  EXPECT_TOLD(message(head + x_mm + A, columns + "A,0,inf,x,1\n"), "finite number of seconds");
  EXPECT_TOLD(message(head + x_mm + A, columns + "A,0,0.1,x,-1e308\n"), "value \"-1e308\" of x must be a finite number of at most 1e+30");
  EXPECT_TOLD(message(head + x_mm + A, columns + "A,0,0.1,y,1\n"), "unknown observable \"y\"");
  EXPECT_TOLD(message(head + x_mm + A, columns + "C,0,0.1,x,1\n"), "unknown point \"C\"");
  EXPECT_TOLD(message(head + x_mm + A, columns + "A,0,0.1,x\n"), "4 fields");
  EXPECT_TOLD(message(head + x_mm + A, columns + "A,0,0.1,x,1\nA,0,0.1,x,2\n"), "as line 2");
  EXPECT_TOLD(message(head + x_mm + A, "point,replicate,t_s,value\n"), "\"observable\" is missing");
  EXPECT_TOLD(message(head + x_mm + A, "point,replicate,t_s,observable,value,colour\n"), "unknown column \"colour\"");
  EXPECT_TOLD(message(head + x_mm + A, "# nothing\n"), "is empty");
  EXPECT_TOLD(message(head + bare + A, columns + "A,0,0.1,x,1\nA,1,0.1,x,1\n"), "without scatter");
  EXPECT_TOLD(message(head + bare + A, columns + "A,0,0.1,x,1\nA,0,0.2,x,2\n"), "one repeat");
  const std::string time = "[[observable]]\nid = \"retention_time\"\nunit = \"s\"\nkind = \"lognormal\"\n";
  EXPECT_TOLD(message(head + time + A, columns + "A,0,,retention_time,0\n"), "positive");
  const std::string count = "[[observable]]\nid = \"recirculations\"\nunit = \"1\"\nkind = \"count\"\n";
  EXPECT_TOLD(message(head + count + A, columns + "A,0,,recirculations,1.5\n"), "whole number");
  EXPECT_TOLD(message(head + count + A, "point,replicate,t_s,observable,value,censored\nA,0,,recirculations,1,1\n"), "censored");
  EXPECT_EQ(message(head + count + A, columns + "A,0,,recirculations,0\n"), "accepted");
}

/// Requirement: without noise_u each number has its scatter, at each point and time; one elsewhere is not enough.
TEST_F(ReadExperiment, EachNumberHasItsScatter) {
  const std::string bare = head + "[[observable]]\nid = \"x\"\nunit = \"mm\"\n" + A;
  const std::string means = "point,replicate,t_s,observable,value,n,sd\n";
  EXPECT_EQ(message(bare, columns + "A,0,0.1,x,1\nA,1,0.1,x,2\nA,0,0.2,x,3\nA,1,0.2,x,4\n"), "accepted");
  EXPECT_TOLD(message(bare, columns + "A,0,0.1,x,1\nA,1,0.1,x,2\nA,0,0.2,x,3\nA,1,0.2,x,3\n"),
              "data.csv:4: observable \"x\" at point \"A\" at t = 0.2 s has 2 repeats without scatter (0.003 SI) and no noise_u");
  EXPECT_TOLD(message(bare, columns + "A,0,0.1,x,1\nA,1,0.1,x,2\nA,0,0.2,x,3\n"),
              "data.csv:4: observable \"x\" at point \"A\" at t = 0.2 s has one repeat and no noise_u");
  EXPECT_EQ(message(bare, means + "A,0,0.1,x,1,10,0.2\nA,0,0.2,x,2,5,0.3\n"), "accepted");
  EXPECT_TOLD(message(bare, means + "A,0,0.1,x,1,10,0.2\nA,0,0.2,x,2,5,\n"), "t = 0.2 s has 5 repeats without scatter");
  EXPECT_TOLD(message(bare, means + "A,0,0.1,x,1,5,\nA,5,0.1,x,2,5,\n"), "t = 0.1 s has 10 repeats without scatter");
  EXPECT_TOLD(message(bare, means + "A,0,,x,1,10,0\n"), "point \"A\" has 10 repeats without scatter");
  EXPECT_EQ(message(head + x_mm + A, means + "A,0,0.1,x,1,10,\nA,0,0.2,x,2,1,\n"), "accepted");
}

/// Requirement: what comes back after half a turn is an angle, whatever is stated.
TEST_F(ReadExperiment, OrientationIsAnAngle) {
  for (const char* kind : {"", "kind = \"gaussian\"\n", "kind = \"angle\"\n"}) {
    const auto e = read_experiment(write(head + "[[observable]]\nid = \"orientation\"\nunit = \"deg\"\nnoise_u = 1\n" + kind + A,
                                         columns + "A,0,0.1,orientation,1\n"));
    EXPECT_EQ(e.observables[0].kind, Observable::Kind::angle) << kind;
  }
}

// Published means stand for their repeats: number, mean and scatter come back exactly.
TEST_F(ReadExperiment, RowsForSeveralRepeats) {
  const std::string all = "point,replicate,t_s,observable,value,censored,n,sd\n";
  const auto told = [](const std::string& id, const std::string& kind, const std::string& unit = "1") {
    return "[[observable]]\nid = \"" + id + "\"\nunit = \"" + unit + "\"\nkind = \"" + kind + "\"\n";
  };
  const auto e = read_experiment(write(head + told("retention_time", "lognormal", "s") + told("area", "gaussian", "m2") +
                                           told("recirculations", "count") + told("exited", "event") + A,
                                       all + "A,0,,retention_time,0.239,,50,0.075\nA,60,,retention_time,30,1,2,\nA,0,,area,4,,7,0.5\n"
                                             "A,0,,recirculations,0.25,,50,\nA,0,,exited,0.04,,50,\n"));
  const auto moments = [&](int observable, auto value) {
    double n = 0, sum = 0, square = 0;
    for (const Datum& d : e.data)
      if (d.observable == observable && !d.censored) ++n, sum += value(d.value), square += value(d.value) * value(d.value);
    return std::array{n, sum / n, std::sqrt((square - sum * sum / n) / (n - 1))};
  };
  const auto log_time = moments(0, [](double v) { return std::log(v); });
  const double sigma = std::sqrt(std::log(1 + std::pow(0.075 / 0.239, 2)));
  EXPECT_EQ(log_time[0], 50);
  EXPECT_NEAR(log_time[1], std::log(0.239) - 0.5 * sigma * sigma, 1e-12);
  EXPECT_NEAR(log_time[2], sigma, 1e-12);
  EXPECT_EQ(std::count_if(e.data.begin(), e.data.end(), [](const Datum& d) { return d.censored && d.value == 30; }), 2);
  const auto area = moments(1, [](double v) { return v; });
  EXPECT_NEAR(area[1], 4, 1e-12);
  EXPECT_NEAR(area[2], 0.5, 1e-12);
  EXPECT_NEAR(moments(2, [](double v) { return v; })[1], 13 / 50.0, 1e-12);  // 12.5 recirculations of 50 rags are 12 or 13
  EXPECT_NEAR(moments(3, [](double v) { return v; })[1], 0.04, 1e-12);
  EXPECT_TOLD(message(head + told("area", "gaussian", "m2") + A, all + "A,0,,area,4,,1,0.5\n"), "one repeat");
  EXPECT_TOLD(message(head + told("area", "gaussian", "m2") + A, all + "A,0,,area,4,,0,\n"), "whole number of repeats");
  EXPECT_TOLD(message(head + told("area", "gaussian", "m2") + A, all + "A,0,,area,4,,9,0.5\nA,3,,area,4,,,\n"), "as line 2");
  EXPECT_TOLD(message(head + told("exited", "event") + A, all + "A,0,,exited,1.2,,50,\n"), "share");
  EXPECT_TOLD(message(head + told("recirculations", "count") + A, all + "A,0,,recirculations,2,,50,1\n"), "leave sd empty");
}

TEST_F(ReadExperiment, Alternatives) {
  const std::string rows = columns + "A,0,0.1,x,1\n";
  const std::string flow = "[[alternative]]\neffect = \"operating_point\"\nmeaning = \"m3/h\"\nset = [\"a.b=1\"]\n";
  const auto e = read_experiment(write(head + x_mm + A + flow + "[[alternative.at]]\npoint = \"A\"\nset = [\"a.b=2\"]\n", rows));
  ASSERT_EQ(e.alternatives.size(), 1u);
  EXPECT_EQ(overrides_at(e.alternatives[0], "A"), (std::vector<std::string>{"a.b=1", "a.b=2"}));
  EXPECT_EQ(overrides_at(e.alternatives[0], "C"), std::vector<std::string>{"a.b=1"});
  std::vector<Effect> effects{{.name = "operating_point", .mean = 0.15, .blind = "no flow"}};
  set_alternatives(effects, e.alternatives);
  EXPECT_TRUE(effects[0].fixed && effects[0].blind.empty());
  EXPECT_EQ(effects[0].mean, 1);
  EXPECT_TOLD(message(head + x_mm + A + flow + flow, rows), "second alternative");
  EXPECT_TOLD(message(head + x_mm + A + flow + "[[alternative.at]]\npoint = \"Z\"\nset = [\"a.b=2\"]\n", rows),
              "is not the name of a [[point]]");
  EXPECT_TOLD(message(head + x_mm + A + "[[alternative]]\neffect = \"geometry\"\n", rows), "changes nothing");
}

TEST_F(ReadExperiment, AlternativesOfNewNames) {
  const std::string rows = columns + "A,0,0.1,x,1\n", other = "[[alternative]]\neffect = \"other_mesh\"\nset = [\"a.b=1\"]\n";
  const auto e = read_experiment(write(head + x_mm + A + other, rows));
  std::vector<Effect> effects{{.name = "lift"}};
  set_alternatives(effects, e.alternatives);
  ASSERT_EQ(effects.size(), 2u);
  EXPECT_TRUE(effects[1].name == "other_mesh" && effects[1].fixed);
  EXPECT_TOLD(message(head + x_mm + A + other + "[model]\ncandidates = [\"other_mash\"]\n", rows),
              "[[alternative]] \"other_mesh\" is not among [model] candidates");
  EXPECT_TOLD(message(head + x_mm + A + "[[alternative]]\neffect = \"a+b\"\nset = [\"a.b=1\"]\n", rows), "cannot stand in a verdict");
}

TEST_F(ReadExperiment, OwnCandidates) {
  const std::string rows = columns + "A,0,0.1,x,1\n";
  const auto with = [&](const std::string& lines) {
    return head + x_mm + A + "[[candidate]]\nname = \"start\"\nkey = \"rag.centre_m\"\ndirection = [0, 1, 0]\nunit = \"mm\"\n" + lines;
  };
  const auto e = read_experiment(write(with("sd = 20\nminimum = -30\n"), rows));
  ASSERT_EQ(e.own_candidates.size(), 1u);
  const OwnCandidate& own = e.own_candidates[0];
  EXPECT_EQ(own.key, "rag.centre_m");
  EXPECT_DOUBLE_EQ(own.unit, 1e-3);
  EXPECT_EQ(own.effect.sd, 20);
  EXPECT_EQ(own.effect.minimum, -30);
  EXPECT_EQ(own.direction->y, 1);
  std::vector<Effect> effects{{.name = "lift"}};
  add_own_candidates(effects, e.own_candidates);
  EXPECT_EQ(effects.at(1).name, "start");
  EXPECT_THROW(add_own_candidates(effects, e.own_candidates), Error);
  const auto told = [&](const std::string& lines) { return message(with(lines), rows); };
  EXPECT_TOLD(told(""), "sd");
  EXPECT_TOLD(told("sd = 0\n"), "sd is 0");
  EXPECT_TOLD(told("sd = 1\nminimum = 2\n"), "has to hold 0");
  EXPECT_TOLD(told("sd = 1\nrandom = true\n"), "give minimum = 0");
  EXPECT_TOLD(told("sd = 1\nmean = 5\nmaximum = 4\n"), "outside of its range");
  EXPECT_TOLD(told("sd = 1\n[model]\ncandidates = [\"lift\"]\n"), "[[candidate]] \"start\" is not among [model] candidates");
  const auto unit = [&](const std::string& key, const std::string& text) {
    return message(head + x_mm + A + "[[candidate]]\nname = \"c\"\nkey = \"" + key + "\"\nsd = 1\nunit = \"" + text + "\"\n", rows);
  };
  EXPECT_TOLD(unit("rag.centre_m", "s"), "unit \"s\" is not one of key \"rag.centre_m\"");
  EXPECT_TOLD(unit("rag.bond_damping", "m"), "is not one of key");
  EXPECT_EQ(unit("rag.bond_damping", "1"), "accepted");
  EXPECT_EQ(unit("coupling.reconfiguration.reference_speed_m_s", "cm/s"), "accepted");
  EXPECT_EQ(unit("flow.dynamic_viscosity_Pa_s", "Pa s"), "accepted");
}

TEST_F(ReadExperiment, Regions) {
  const std::string rows = columns + "A,0,0.1,x,1\n", near = "[[region]]\nid = \"near\"\nupper_mm = [5, 0, 7]\n";
  const auto e = read_experiment(write(head + x_mm + A + near, rows));
  ASSERT_EQ(e.regions.size(), 1u);
  EXPECT_DOUBLE_EQ(e.regions[0].upper.x, 5e-3);
  EXPECT_LT(e.regions[0].lower.z, -1e6);
  EXPECT_TOLD(message(head + x_mm + A + near + "lower_mm = [0, 1, 0]\n", rows), "not below upper along y");
  EXPECT_TOLD(message(head + x_mm + A + near + near, rows), "is given twice");
}

// A million rows are read in some seconds of one processor.
TEST_F(ReadExperiment, MillionRows) {
  std::string csv = columns;
  for (int i = 0; i < 1000000; ++i)
    csv += "A," + std::to_string(i / 1000) + "," + std::to_string(i % 1000) + "e-3,x," + std::to_string(i % 77) + "\n";
  const auto file = write(head + x_mm + A, csv);
  rusage before, after;
  getrusage(RUSAGE_SELF, &before);
  EXPECT_EQ(read_experiment(file).data.size(), 1000000u);
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(static_cast<double>(after.ru_utime.tv_sec - before.ru_utime.tv_sec), 6);
}

TEST_F(ReadExperiment, EveryKeyIsInTheManual) {
  // Requirement: what the reader reads, the manual has; a key of its own would be read and nowhere explained.
  const CaseFile file = experiment_file(
      write(head + x_mm + A + B +
                "[[region]]\nid = \"front\"\n[model]\ncandidates = \"all\"\n[budget]\nseed = 7\ncost = { \"flow.amplitude\" = 2 }\n" +
                "[[candidate]]\nname = \"start\"\nkey = \"a.b_m\"\nunit = \"m\"\nsd = 1\n[[alternative]]\neffect = "
                "\"lift\"\n[[alternative.at]]\npoint = \"A\"\nset = [\"time.end_s=1\"]\n",
            columns + "A,0,0.1,x,1\nB,0,0.1,x,2\n"));
  read_experiment(file);
  EXPECT_EQ(keys_without_section(file, experiment_sections(), {"point.input_u", "budget.cost"}), std::vector<std::string>{});
  EXPECT_FALSE(keys_without_section(file, {}).empty());
}
