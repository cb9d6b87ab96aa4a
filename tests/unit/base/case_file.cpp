#include "base/case_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
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

// A word that may stand in the place of a number, whatever the unit in the key; a misspelt one is refused with what is allowed.
TEST(CaseFile, WordInThePlaceOfANumber) {
  const auto read = [](const std::string& line) {
    double step = 1;
    const Parameter parameter{.key = "step", .target = &step, .unit = "s", .minimum = 0, .maximum = 1, .choices = {"auto"}};
    CaseFile::parse("[time]\n" + line, "case.toml").root().table("time").read({parameter});
    return step;
  };
  for (const char* line : {"step = \"auto\"", "step_ms = \"auto\"", "step_s = \"auto\""}) EXPECT_TRUE(std::isnan(read(line))) << line;
  EXPECT_EQ(read("step_ms = 2"), 2e-3);
  EXPECT_EQ(read("step = \"2 ms\""), 2e-3);
  EXPECT_THROW(read("step = \"2\""), Error);
  try {
    read("step = \"atuo\"");
    FAIL();
  } catch (const Error& error) {
    EXPECT_TRUE(contains(error.what(), "must be a number with a unit, or one of auto; did you mean \"auto\"?")) << error.what();
  }
}

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
TEST(CaseFile, TextGivesEachFileItsOverridesAlone) {
  const CaseFile::Text text("[fluid]\ndensity_kg_m3 = 1000\n", "water.toml");
  const auto density = [&](const std::vector<std::string>& overrides) {
    return text.with(overrides).root().table("fluid").numbers().front().second;
  };
  EXPECT_EQ(density({"fluid.density_kg_m3=998"}), 998);
  EXPECT_EQ(density({}), 1000);
  EXPECT_EQ(text.with({}).root().table("fluid").where(), "water.toml:1: [fluid]");
}

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

namespace {

struct Renamed {
  int n_correctors = 1;
  double rotation_speed = 0, factor = 1;
  std::string model = "mass", bonds = "published";
  Section section() {
    return {"rag_passage",
            "A table that had another name.",
            {renamed({"n_correctors", &n_correctors, "1", 1, 50, Basis::assumed, "Count."}, {.key = "correctors"}),
             renamed({"rotation_speed", &rotation_speed, "rad/s", -infinity, infinity, Basis::assumed, "Speed."},
                     {.key = "speed", .unit = "1/s"}),
             renamed(setting("model", &model, "Model.", {"mass", "jensen_2018"}),
                     {.key = "as_published", .values = {{"false", "\"mass\""}, {"true", "\"jensen_2018\""}}}),
             renamed(setting("bonds", &bonds, "Bonds.", {"published", "custom"}), {.values = {{"\"given\"", "\"custom\""}}}),
             {"factor", &factor, "1", 0, 10, Basis::assumed, "Factor."}},
            false,
            "passage"};
  }
};

/// As an earlier version read it: the hash of today is held against this one.
struct Earlier {
  int correctors = 1;
  double speed = 0, factor = 1;
  bool as_published = false;
  std::string bonds = "published";
  std::vector<Parameter> parameters() {
    return {{"correctors", &correctors, "1", 1, 50, Basis::assumed, "Count."},
            {"speed", &speed, "1/s", -infinity, infinity, Basis::assumed, "Speed."},
            setting("as_published", &as_published, "Model."),
            setting("bonds", &bonds, "Bonds.", {"published", "given"}),
            {"factor", &factor, "1", 0, 10, Basis::assumed, "Factor."}};
  }
};

CaseFile read_renamed(Renamed& s, const std::string& text, const std::vector<std::string>& overrides = {}) {
  auto file = CaseFile::parse(text, "case.toml", overrides);
  if (const Section section = s.section(); file.root().has(section)) file.root().table(section).read(section.parameters);
  file.reject_unread();
  return file;
}

std::string refusal(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    Renamed settings;
    read_renamed(settings, text, overrides);
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    return error.what();
  }
  return "";
}

const std::string with_former_names = "[passage]\ncorrectors = 2\nspeed_rpm = 60\nas_published = true\nbonds = \"given\"\n";
const std::string with_present_names =
    "[rag_passage]\nn_correctors = 2\nrotation_speed_rpm = 60\nmodel = \"jensen_2018\"\nbonds = \"custom\"\n";

}  // namespace

// Former names of tables, keys and values are read with one warning each, which names file, line, old and new name; the resolved case has
// the present names.
TEST(CaseFile, ReadsFormerNames) {
  Renamed s;
  const auto file = read_renamed(s, with_former_names);
  EXPECT_EQ(s.n_correctors, 2);
  EXPECT_NEAR(s.rotation_speed, 6.283185307, 1e-9);
  EXPECT_EQ(s.model, "jensen_2018");
  EXPECT_EQ(s.bonds, "custom");
  const std::string end = "; the old name is read until 1.0";
  EXPECT_EQ(file.former_names(),
            (std::vector<std::string>{"case.toml:1: [passage] is now called [rag_passage]" + end,
                                      "case.toml:2: [rag_passage] correctors is now called n_correctors" + end,
                                      "case.toml:3: [rag_passage] speed_rpm is now called rotation_speed_rpm" + end,
                                      "case.toml:4: [rag_passage] as_published = true is now called model = \"jensen_2018\"" + end,
                                      "case.toml:5: [rag_passage] bonds = \"given\" is now called bonds = \"custom\"" + end}));
  const std::string resolved = file.resolved();
  for (const char* part :
       {"[rag_passage]", "n_correctors = 2", "rotation_speed_rad_s = 6.28", "model = \"jensen_2018\"", "bonds = \"custom\""})
    EXPECT_TRUE(contains(resolved, part)) << resolved;
  for (const char* part : {"[passage]", "\ncorrectors", "\nspeed", "as_published", "given"})
    EXPECT_FALSE(contains(resolved, part)) << resolved;
  Renamed again;
  const auto reread = read_renamed(again, resolved);
  EXPECT_EQ(reread.resolved(), resolved);
  EXPECT_TRUE(reread.former_names().empty());
}

// A new name changes neither the hash of a case nor that of a resumed run: with the former names, with the present ones, and as an earlier
// version computed it.
TEST(CaseFile, NewNamesLeaveTheHashAsItIs) {
  for (const auto& [former, present] :
       {std::pair{with_former_names, with_present_names}, {std::string("[passage]\n"), std::string("[rag_passage]\n")}}) {
    const auto earlier = CaseFile::parse(former);
    Earlier e;
    ASSERT_TRUE(earlier.root().has("passage"));
    earlier.root().table("passage").read(e.parameters());
    Renamed s, t;
    const auto old_names = read_renamed(s, former), new_names = read_renamed(t, present);
    EXPECT_EQ(old_names.sha256(), earlier.sha256());
    EXPECT_EQ(new_names.sha256(), earlier.sha256());
    EXPECT_EQ(old_names.resume_sha256(), earlier.resume_sha256());
    EXPECT_EQ(new_names.resume_sha256(), earlier.resume_sha256());
    Renamed u;
    EXPECT_NE(read_renamed(u, present + "factor = 2\n").sha256(), earlier.sha256());
  }
}

// The former and the present name of one thing contradict each other.
TEST(CaseFile, RefusesFormerAndPresentName) {
  EXPECT_TRUE(contains(refusal("[rag_passage]\ncorrectors = 2\nn_correctors = 2\n"), "given twice, as correctors and n_correctors"));
  EXPECT_TRUE(contains(refusal("[rag_passage]\nas_published = true\nmodel = \"mass\"\n"), "given twice"));
  EXPECT_TRUE(contains(refusal("[rag_passage]\nfactor = 2\n[passage]\nfactor = 2\n"),
                       "case.toml:3: [passage] is the former name of [rag_passage]"));
  EXPECT_TRUE(contains(refusal("[rag_passage]\n", {"rag_passage.correctors=2", "rag_passage.n_correctors=3"}), "given twice"));
  EXPECT_TRUE(contains(refusal("[rag_passage]\nas_published = 3\n"), "must be one of false, true; it is now called model"));
  EXPECT_TRUE(contains(refusal("[rag_passage]\nmodel = true\n"), "must be a text in quotes"));
}

// An override replaces the value of the file, whichever name either has.
TEST(CaseFile, OverridesOfFormerNames) {
  Renamed s, t, u;
  read_renamed(s, with_present_names, {"passage.correctors=3", "rag_passage.as_published=false"});
  EXPECT_EQ(s.n_correctors, 3);
  EXPECT_EQ(s.model, "mass");
  EXPECT_EQ(s.bonds, "custom");
  const auto file = read_renamed(t, with_former_names, {"rag_passage.n_correctors=3", "passage.bonds=given"});
  EXPECT_EQ(t.n_correctors, 3);
  EXPECT_EQ(t.bonds, "custom");
  EXPECT_NEAR(t.rotation_speed, 6.283185307, 1e-9);
  EXPECT_TRUE(contains(read_renamed(u, "", {"passage.correctors=3"}).former_names().at(1), "case.toml, --set: [rag_passage] correctors"));
  EXPECT_EQ(u.n_correctors, 3);
}

// Overrides of tables of runs have the first names, those of a run the present ones.
TEST(CaseFile, TranslatesOverrides) {
  Renamed s;
  const auto file = read_renamed(s, with_present_names);
  for (const auto& [first, present] : {std::pair<std::string, std::string>{"passage.correctors=3", "rag_passage.n_correctors=3"},
                                       {"passage.speed_per_s=3", "rag_passage.rotation_speed_rad_s=3"},
                                       {"passage.speed_rpm=60", "rag_passage.rotation_speed_rpm=60"},
                                       {"passage.as_published=true", "rag_passage.model=\"jensen_2018\""},
                                       {"passage.factor=2", "rag_passage.factor=2"},
                                       {"passage.speed_per_s", "rag_passage.rotation_speed_rad_s"},
                                       {"rag.0.seed=2", "rag.0.seed=2"}}) {
    EXPECT_EQ(file.with_first_names(present), first);
    EXPECT_EQ(file.with_present_names(first), present);
    EXPECT_EQ(file.with_first_names(first), first);
    EXPECT_EQ(file.with_present_names(present), present);
  }
}
