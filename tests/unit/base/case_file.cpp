#include "base/case_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/error.hpp"

using namespace snag;

namespace {

struct Settings {
  double density = 998.2, factor = 1, radius = 1e-3;
  int count = 2;
  bool active = true;
  std::string kind = "sheet";
  std::optional<double> step;
  Vec3 centre;
  std::vector<std::string> forces;
  std::vector<Parameter> parameters() {
    return {{"density", &density, "kg/m3", 1, 2e4, Basis::literature, "Density."},
            {"factor", &factor, "1", 0, 10, Basis::assumed, "Factor."},
            {"radius", &radius, "m", 1e-5, 1, Basis::assumed, "Radius."},
            {"count", &count, "1", 0, 100, Basis::assumed, "Count."},
            setting("active", &active, "On."),
            setting("kind", &kind, "Shape.", {"sheet", "disc"}),
            {"step", &step, "s", 0, 1, Basis::assumed, "Step; chosen if not given."},
            {"centre", &centre, "m", -10, 10, Basis::assumed, "Centre."},
            setting("forces", &forces, "Forces.")};
  }
};

std::string message_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    const auto file = CaseFile::parse(text, "case.toml", overrides);
    Settings settings;
    file.root().table("rag").read(settings.parameters());
    file.reject_unread();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

// Both ways of giving a unit, and every type of value, are read.
TEST(CaseFile, ReadsValues) {
  const auto file = CaseFile::parse(R"([rag]
density = "1.2 g/mL"
radius_mm = 1.5
factor = 3
count = 7
active = false
kind = "disc"
centre_m = [1, 2.5, -3]
forces = ["a", "b"])");
  Settings s;
  file.root().table("rag").read(s.parameters());
  file.reject_unread();
  EXPECT_DOUBLE_EQ(s.density, 1200);
  EXPECT_DOUBLE_EQ(s.radius, 1.5e-3);
  EXPECT_DOUBLE_EQ(s.factor, 3);
  EXPECT_EQ(s.count, 7);
  EXPECT_FALSE(s.active);
  EXPECT_EQ(s.kind, "disc");
  EXPECT_FALSE(s.step);
  EXPECT_EQ(s.centre, (Vec3{1, 2.5, -3}));
  EXPECT_EQ(s.forces.size(), 2u);
}

// A unit that is a product is found by its dimension: Pa_s is Pa s, though m_s is m/s.
TEST(CaseFile, ProductsOfUnitsInKeys) {
  double viscosity = 0, speed = 0;
  const std::vector<Parameter> parameters{{.key = "viscosity", .target = &viscosity, .unit = "Pa s"},
                                          {.key = "speed", .target = &speed, .unit = "m/s"}};
  const auto file = CaseFile::parse("[flow]\nviscosity_Pa_s = 1e-3\nspeed_mm_s = 2");
  file.root().table("flow").read(parameters);
  file.reject_unread();
  EXPECT_DOUBLE_EQ(viscosity, 1e-3);
  EXPECT_DOUBLE_EQ(speed, 2e-3);
  const auto again = CaseFile::parse(file.resolved());
  again.root().table("flow").read(parameters);
  again.reject_unread();
  EXPECT_DOUBLE_EQ(speed, 2e-3);
}

// Each mistake gets a message with the place, the value, the rule and the remedy.
TEST(CaseFile, ExplainsMistakes) {
  EXPECT_TRUE(contains(message_of("[rag]\n\ndensty_kg_m3 = 5"), "case.toml:3"));
  EXPECT_TRUE(contains(message_of("[rag]\ndensty_kg_m3 = 5"), "did you mean \"density_kg_m3\""));
  EXPECT_TRUE(contains(message_of("[rag]\ndensity = 5"), "without a unit"));
  EXPECT_TRUE(contains(message_of("[rag]\ndensity = \"5 mm\""), "wrong unit"));
  EXPECT_TRUE(contains(message_of("[rag]\ndensity_mm = 5"), "unknown key"));
  EXPECT_TRUE(contains(message_of("[rag]\ndensity = \"5 kg/m3\"\ndensity_kg_m3 = 5"), "given twice"));
  EXPECT_TRUE(contains(message_of("[rag]\ndensity_kg_m3 = -5"), "between 1 and 20000 kg/m3") ||
              contains(message_of("[rag]\ndensity_kg_m3 = -5"), "between 1.0"));
  EXPECT_TRUE(contains(message_of("[rag]\ndensity_kg_m3 = nan"), "finite"));
  EXPECT_TRUE(contains(message_of("[rag]\nkind = \"disk\""), "did you mean \"disc\""));
  EXPECT_TRUE(contains(message_of("[rag]\ncount = 1.5"), "whole number"));
  EXPECT_TRUE(contains(message_of("[rag]\nactive = 1"), "true or false"));
  EXPECT_TRUE(contains(message_of("[rag]\ncentre_m = [1, 2]"), "list of 3"));
  EXPECT_TRUE(contains(message_of("[rags]\ncount = 1"), "did you mean [rag]"));
  EXPECT_TRUE(contains(message_of("[rag\ncount = 1"), "no valid TOML"));
  EXPECT_TRUE(contains(message_of("[[rag]]\ncount = 1\n[[rag]]\ncount = 2"), "more than once"));
}

// Overrides reach keys, repeated tables and tables that the file does not have; mistakes in them are explained.
TEST(CaseFile, Overrides) {
  const auto file =
      CaseFile::parse("[[rag]]\ncount = 1\n[[rag]]\ncount = 2\n", "case", {"rag.1.count=5", "rag.0.kind=disc", "flow.factor=2"});
  Settings a, b, c;
  const auto rags = file.root().tables("rag");
  ASSERT_EQ(rags.size(), 2u);
  rags[0].read(a.parameters());
  rags[1].read(b.parameters());
  file.root().table("flow").read(c.parameters());
  file.reject_unread();
  EXPECT_EQ(a.kind, "disc");
  EXPECT_EQ(b.count, 5);
  EXPECT_DOUBLE_EQ(c.factor, 2);
  EXPECT_TRUE(contains(message_of("[rag]\n", {"rag.count"}), "has no \"=\""));
  EXPECT_TRUE(contains(message_of("[rag]\n", {"rag.coutn=3"}), "did you mean \"count\""));
}

// The resolved case reads back as the same case, so its hash is that of the physics and not of the spelling.
TEST(CaseFile, ResolvedCaseIsTheSameCase) {
  const auto read = [](const std::string& text, Settings& s) {
    const auto file = CaseFile::parse(text);
    for (const Table& table : file.root().tables("rag")) table.read(s.parameters());
    file.reject_unread();
    return std::pair(file.resolved(), file.sha256());
  };
  Settings s, t, u;
  const auto [first, hash] = read("[[rag]]\nradius = \"0.1 mm\"\nforces=[\"x\"]\nstep_s=1e-7", s);
  const auto [second, again] = read(first, t);
  EXPECT_EQ(first, second);
  EXPECT_EQ(hash, again);
  EXPECT_EQ(s.radius, t.radius);
  EXPECT_NE(read("[[rag]]\nradius = \"0.2 mm\"", u).second, hash);
}

// A new key or a new section at its default does not change the hash of a case, so a table of runs from an earlier version stays valid.
TEST(CaseFile, NewKeysLeaveTheHashAsItIs) {
  const auto hash_of = [](const std::string& text, bool later_version) {
    const auto file = CaseFile::parse(text);
    double step = 1, factor = 2, width = 3;
    std::vector<Parameter> known{{"step", &step, "s", 0, 10, Basis::assumed, "Step."}};
    if (later_version) known.push_back({"factor", &factor, "1", 0, 10, Basis::assumed, "Factor."});
    file.root().table("time").read(known);
    if (later_version) file.root().table("water").read({{"width", &width, "m", 0, 10, Basis::assumed, "Width."}});
    const Table pump = file.root().table("pump");
    if (pump.present()) pump.read({{"speed", &factor, "1", 0, 10, Basis::assumed, "Speed."}});
    return file.sha256();
  };
  const std::string text = "[time]\nstep_s = 0.1\n";
  EXPECT_EQ(hash_of(text, false), hash_of(text, true));
  EXPECT_EQ(hash_of(text, true), hash_of(text + "factor = 2\n[water]\nwidth_m = 3\n", true));
  EXPECT_NE(hash_of(text, true), hash_of(text + "factor = 2.5\n", true));
  EXPECT_NE(hash_of(text, true), hash_of(text + "[pump]\n", true));
}

// An override replaces the value of the file whatever unit stands in either key; two overrides of one value contradict each other.
TEST(CaseFile, OverridesInAnotherUnit) {
  const auto file = CaseFile::parse("[rag]\nradius = \"1 mm\"\n", "case", {"rag.radius_m=0.002"});
  Settings s;
  file.root().table("rag").read(s.parameters());
  file.reject_unread();
  EXPECT_DOUBLE_EQ(s.radius, 2e-3);
  EXPECT_TRUE(contains(message_of("[rag]\n", {"rag.radius_m=0.002", "rag.radius_mm=3"}), "given twice"));
}

// Messages about overrides name them, not a line of the file; numbers must be finite; a section is no value.
TEST(CaseFile, OverridesInMessages) {
  EXPECT_TRUE(contains(message_of("[rag]\n", {"rag.factor=11"}), "case.toml, --set: [rag] factor"));
  EXPECT_TRUE(contains(message_of("[rag]\n", {"rag.centre_m=[0, inf, 0]"}), "finite"));
  EXPECT_TRUE(contains(message_of("[rag]\n", {"rag=1"}), "names a section"));
  EXPECT_TRUE(contains(message_of("[rag]\n", {"=1"}), "names no key"));
  EXPECT_TRUE(contains(message_of("rag = 1\n"), "write [rag]"));
}

// The resolved case names files by their whole path; the fingerprint holds their content, so it is the same from any folder.
TEST(CaseFile, ResolvedNamesFilesFromAnyFolder) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("snag-case-file-" + std::to_string(getpid()));
  fs::create_directories(folder / "a");
  const auto write = [](const fs::path& file, const std::string& text) { std::ofstream(file) << text; };
  std::string kept;
  const auto read = [&](const fs::path& path) {
    const auto file = CaseFile::read(path);
    std::string mesh;
    file.root().table("mesh").read({file_setting("file", &mesh, "Mesh.")});
    kept = file.resolved();
    EXPECT_TRUE(fs::exists(file.path(mesh)));
    return file.sha256();
  };
  write(folder / "mesh.msh", "nodes"), write(folder / "case.toml", "[mesh]\nfile = \"mesh.msh\"\n");
  const std::string first = read(folder / "case.toml");
  write(folder / "a" / "case.resolved.toml", kept);
  EXPECT_EQ(read(folder / "a" / "case.resolved.toml"), first);
  write(folder / "mesh.msh", "other nodes");
  EXPECT_NE(read(folder / "case.toml"), first);
  fs::remove_all(folder);
}
