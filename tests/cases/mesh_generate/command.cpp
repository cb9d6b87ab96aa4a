// The command line: exit codes, messages, parameter files and formats.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/cases/mesh_generate/reader/program.hpp"

using namespace mesh_generate;

namespace {

void expect_error(const std::string& arguments, int code, const std::string& words) {
  const auto outcome = snag_mesh(arguments);
  EXPECT_EQ(outcome.code, code) << arguments << "\n" << outcome.output;
  EXPECT_NE(outcome.output.find(words), std::string::npos) << arguments << "\n" << outcome.output;
}

}  // namespace

// A wrong command line or parameter ends with code 2 and says what was wrong.
TEST(MeshCommand, RefusesWrongUsage) {
  expect_error("", 2, "subcommand");
  expect_error("bax --out x.msh", 2, "did you mean \"box\"");
  expect_error("box", 2, "--out");
  expect_error("box --out x.vtk", 2, ".msh");
  expect_error("box --set siz=0.1 --out x.msh", 2, "size");
  expect_error("box --set size_m=-1 --out x.msh", 2, "size");
  expect_error("box --set size='3 kg' --out x.msh", 2, "kg");
  expect_error("box --set size_m=2 --out x.msh", 2, "must hold a cell");
  expect_error("pump --set 'inlet_diameter=250 mm' --out x.msh", 2, "sliding radius");
  expect_error("pump --set 'leading_edge_radius=99 mm' --out x.msh", 2, "leading_edge_radius");
  expect_error("pump --set inlet=tank plate_distance='20 mm' --out x.msh", 2, "plate_distance");
  expect_error("pipe --set cells=swept n_layers=30 --out x.msh", 2, "layers");
  expect_error("box --format 3 --out x.msh", 2, "format");
}

// A mesh that fails its checks ends with code 3 and is not written: an octagon is no circle.
TEST(MeshCommand, RefusesABadMesh) {
  std::filesystem::remove(folder() / "octagon.msh");
  expect_error("pipe --set cells=swept n_around=8 --out octagon.msh", 3, "take smaller sizes");
  EXPECT_FALSE(std::filesystem::exists(folder() / "octagon.msh"));
}

// A file that cannot be written or read ends with code 6.
TEST(MeshCommand, ReportsFilesThatFail) {
  expect_error("box --set size_m=0.5 --out no_such_folder/box.msh", 6, "no_such_folder");
  expect_error("box no_such_file.toml --out box.msh", 6, "no_such_file.toml");
}

// Parameters come from a file, units are understood, and the resolved parameters written beside the mesh make it again.
TEST(MeshCommand, ReadsParametersAndWritesThemResolved) {
  std::ofstream(folder() / "given.toml") << "[box]\nsize = \"200 mm\"\nupper_m = [1.0, 2.0, 1.0]\n";
  ASSERT_EQ(snag_mesh("box given.toml --out given.msh").code, 0);
  ASSERT_EQ(snag_mesh("box given.resolved.toml --out again.msh").code, 0);
  EXPECT_TRUE(bytes(folder() / "given.msh") == bytes(folder() / "again.msh"));
  EXPECT_NEAR(read_mesh(folder() / "given.msh").volume("fluid"), 2, 1e-12);
}

// Both versions of the format are written, as text and binary.
TEST(MeshCommand, WritesEveryFormat) {
  const auto header = [](const std::string& options) {
    EXPECT_EQ(snag_mesh("box --set size_m=0.5 --out format.msh " + options).code, 0);
    return bytes(folder() / "format.msh").substr(0, 17);
  };
  EXPECT_EQ(header(""), "$MeshFormat\n2.2 0");
  EXPECT_EQ(header("--binary"), "$MeshFormat\n2.2 1");
  EXPECT_EQ(header("--format 4.1"), "$MeshFormat\n4.1 0");
  EXPECT_EQ(header("--format 4.1 --binary"), "$MeshFormat\n4.1 1");
}

// The help of a geometry lists its parameters with default, unit and meaning.
TEST(MeshCommand, HelpListsParameters) {
  const auto help = snag_mesh("pump --help");
  EXPECT_EQ(help.code, 0);
  EXPECT_NE(help.output.find("rotor_angle               7 deg"), std::string::npos) << help.output;
  EXPECT_NE(help.output.find("plate_distance            0.125 m"), std::string::npos) << help.output;
}

// The program knows every geometry: none is lost because it registers itself.
TEST(MeshCommand, KnowsEveryGeometry) {
  const auto help = snag_mesh("--help");
  for (const std::string name : {"box", "channel", "pipe", "pump", "tank"})
    EXPECT_NE(help.output.find("\n  " + name + " "), std::string::npos) << name;
}
