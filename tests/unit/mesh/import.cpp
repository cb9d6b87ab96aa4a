// ranks: 1 3
// long ranks: 2 5
#include "mesh/import/import.hpp"

#include <cstdlib>
#include <sstream>

#include "base/error.hpp"
#include "check.hpp"
#include "sample.hpp"
#include "tests/sources.hpp"

namespace {

using namespace snag;
using test::Format;

std::filesystem::path pump(const std::string& name) { return in_sources("cases/meshes/" + name); }

Mesh imported(const test::Sample& sample, Format format, const ImportOptions& options = {}) {
  const test::TemporaryFile file(sample, format);
  return import_mesh(file.path(), MPI_COMM_WORLD, options);
}

/// The message of the error that an import ends with, the same code on every rank.
std::string failure(const std::filesystem::path& file, ExitCode code, const ImportOptions& options = {}) {
  try {
    import_mesh(file, MPI_COMM_WORLD, options);
  } catch (const Error& error) {
    EXPECT_EQ(error.code, code) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}
std::string failure(const test::Sample& sample, ExitCode code, const ImportOptions& options = {}) {
  const test::TemporaryFile file(sample, Format::ascii22);
  return failure(file.path(), code, options);
}

/// Cells and nodes lie where the sample has those of the same number.
void expect_numbers_of(const test::Sample& sample, const Mesh& mesh) {
  std::vector<const test::Element*> cells;
  for (const auto& element : sample.element)
    if (element.dimension() == 3) cells.push_back(&element);
  ASSERT_EQ(mesh.n_cells_global, static_cast<std::int64_t>(cells.size()));
  for (int c = 0; c < mesh.n_cells; ++c) {
    const test::Element& cell = *cells[static_cast<std::size_t>(mesh.cell_id[c])];
    const auto shape = std::array{CellShape::tetrahedron, CellShape::hexahedron, CellShape::prism, CellShape::pyramid}[cell.type - 4];
    EXPECT_EQ(mesh.cell_shape[c], shape);
    EXPECT_EQ(mesh.zones[static_cast<std::size_t>(mesh.cell_zone[c])], sample.volumes[static_cast<std::size_t>(cell.tag - 1)].second);
    std::vector<std::int64_t> nodes, expected(cell.node.begin(), cell.node.end());
    for (int i = mesh.cell_node_start[c]; i < mesh.cell_node_start[c + 1]; ++i) nodes.push_back(mesh.node_id[mesh.cell_node[i]]);
    std::sort(nodes.begin(), nodes.end()), std::sort(expected.begin(), expected.end());
    EXPECT_EQ(nodes, expected);
  }
  for (std::size_t i = 0; i < mesh.node.size(); ++i) EXPECT_EQ(mesh.node[i], sample.node[static_cast<std::size_t>(mesh.node_id[i])]);
}

// Every format gives the cells, nodes, names and shapes of the file under the file's numbers, and closed cells of the right volume,
// although shapes alternate in it.
TEST(Import, ReadsAllShapesInAllFormats) {
  const auto sample = test::mixed_units(7);
  for (const Format format : {Format::ascii22, Format::binary22, Format::ascii41, Format::binary41}) {
    SCOPED_TRACE(static_cast<int>(format));
    const Mesh mesh = imported(sample, format);
    test::expect_sound(mesh);
    expect_numbers_of(sample, mesh);
    EXPECT_EQ(mesh.zones, (std::vector<std::string>{"block", "roof"}));
    ASSERT_EQ(mesh.patches.size(), 4U);
    const std::array<std::pair<const char*, int>, 4> patches{{{"back", 1}, {"bottom", 14}, {"front", 1}, {"sides", 56}}};
    for (std::size_t p = 0; p < 4; ++p) {
      EXPECT_EQ(mesh.patches[p].name, patches[p].first);
      EXPECT_EQ(mesh.patches[p].count_global, patches[p].second);
    }
    EXPECT_NEAR(test::volume(mesh), 14, 1e-13);
    EXPECT_LT(test::closure(mesh), 1e-15);
    for (int c = 0; c < mesh.n_cells; ++c) {
      const auto shape = static_cast<std::size_t>(mesh.cell_shape[c]);
      EXPECT_NEAR(mesh.cell_volume[c], (std::array{1.0 / 6, 1.0 / 3, 0.5, 1.0}[shape]), 1e-15);
      EXPECT_NEAR(mesh.cell_centre[c].x, (std::array{1.125, 0.5, 4.0 / 3, 0.5}[shape]), 1e-15);
      EXPECT_NEAR(mesh.cell_centre[c].z, (std::array{1.25, 1.25, 0.5, 0.5}[shape]), 1e-15);
    }
  }
}

// Four cells on up to five ranks: ranks without cells, or without cells of a zone, take part.
TEST(Import, MayHaveFewerCellsThanRanks) {
  const Mesh mesh = imported(test::mixed_units(1), Format::ascii22);
  test::expect_sound(mesh);
  expect_numbers_of(test::mixed_units(1), mesh);
  EXPECT_NEAR(test::volume(mesh), 2, 1e-14);
}

// A scale turns the unit of the file into metres.
TEST(Import, ScalesTheFile) {
  ImportOptions options;
  options.scale = 1e-3;
  EXPECT_NEAR(test::volume(imported(test::mixed_units(2), Format::ascii41, options)), 4e-9, 1e-23);
}

// The coarse pump: published counts and volumes, closed zones, and the same arrays on any number of ranks and from both formats.
TEST(Import, CoarsePumpIsTheSameOnAnyNumberOfRanks) {
  const Mesh mesh = import_mesh(pump("pump_coarse.msh"), MPI_COMM_WORLD);
  test::expect_sound(mesh);
  EXPECT_EQ(mesh.n_cells_global, 30454);
  EXPECT_EQ(mesh.zones, (std::vector<std::string>{"rotor", "stator"}));
  EXPECT_LT(test::closure(mesh), 1e-12);
  std::array<std::vector<double>, 2> volume;
  for (int c = 0; c < mesh.n_cells; ++c) volume[static_cast<std::size_t>(mesh.cell_zone[c])].push_back(mesh.cell_volume[c]);
  EXPECT_NEAR(sum(mesh.comm, volume[0]), 2.617628e-3 * (1 - 1.3e-3), 3e-7);  // of the solid, less the error of its chords
  EXPECT_NEAR(sum(mesh.comm, volume[1]), 1.0960971e-2 * (1 - 1.0e-2), 1e-6);
  EXPECT_EQ(sum(mesh.comm, static_cast<std::int64_t>(volume[0].size())), 11430);
  const std::array<std::pair<const char*, int>, 6> patches{{{"casing_walls", 6601},
                                                            {"impeller_walls", 2888},
                                                            {"inlet", 63},
                                                            {"interface_rotor", 1530},
                                                            {"interface_stator", 1550},
                                                            {"outlet", 30}}};
  ASSERT_EQ(mesh.patches.size(), patches.size());
  std::array<std::vector<Vec3>, 2> outward;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    EXPECT_EQ(mesh.patches[p].name, patches[p].first);
    EXPECT_EQ(mesh.patches[p].count_global, patches[p].second);
    for (int f = mesh.patches[p].first; f < mesh.patches[p].end(); ++f)
      outward[static_cast<std::size_t>(mesh.cell_zone[mesh.owner[f]])].push_back(mesh.face_vector[f]);
  }
  for (const auto& faces : outward) EXPECT_LT(norm(sum(mesh.comm, faces)), 1e-15);

  const auto spread = test::fingerprint(mesh), other = test::fingerprint(import_mesh(pump("pump_coarse_v41.msh"), MPI_COMM_WORLD));
  std::vector<double> alone(spread.size());
  if (rank_of(MPI_COMM_WORLD) == 0) alone = test::fingerprint(import_mesh(pump("pump_coarse.msh"), MPI_COMM_SELF));
  MPI_Bcast(alone.data(), static_cast<int>(alone.size()), MPI_DOUBLE, 0, MPI_COMM_WORLD);
  for (std::size_t i = 0; i < spread.size(); ++i) {
    EXPECT_NEAR(spread[i], alone[i], 1e-13 * std::abs(alone[i]));
    EXPECT_NEAR(other[i], alone[i], 1e-13 * std::abs(alone[i]));
  }
}

// A run that resumes gets each cell on the rank that had it.
TEST(Import, TakesAPartition) {
  const auto sample = test::mixed_units(7);
  ImportOptions options;
  options.partition = std::vector<int>(28);
  for (int c = 0; c < 28; ++c) (*options.partition)[static_cast<std::size_t>(c)] = (c * c) % size_of(MPI_COMM_WORLD);
  const Mesh mesh = imported(sample, Format::ascii22, options);
  EXPECT_EQ(partition_of(mesh), *options.partition);
  test::expect_sound(mesh);
  expect_numbers_of(sample, mesh);
  options.partition->pop_back();
  EXPECT_NE(failure(sample, ExitCode::mesh, options).find("partition"), std::string::npos);
}

// Periodic patches become interior faces with the way across the period.
TEST(Import, JoinsPeriodicPatches) {
  ImportOptions options;
  options.periodic = {{"front", "back", {0, 7, 0}}};
  const Mesh plain = imported(test::mixed_units(7), Format::ascii22), mesh = imported(test::mixed_units(7), Format::ascii22, options);
  test::expect_sound(mesh);
  EXPECT_EQ(mesh.n_interior_global, plain.n_interior_global + 1);
  EXPECT_EQ(mesh.patches.size(), 2U);
  EXPECT_LT(test::closure(mesh), 1e-15);
  std::int64_t n_across = 0;
  for (int f = 0; f < mesh.n_interior; ++f) {
    const Vec3 x_P = mesh.cell_centre[mesh.owner[f]], x_N = mesh.cell_centre[mesh.neighbour[f]];
    if (norm(x_P + mesh.delta[f] - x_N) < 1 || mesh.owner[f] >= mesh.n_cells) continue;
    ++n_across;
    EXPECT_NEAR(norm(mesh.delta[f] - Vec3{0, -1, 0}), 0, 1e-14);
    EXPECT_NEAR(mesh.weight[f], 0.5, 1e-14);
  }
  EXPECT_EQ(sum(mesh.comm, n_across), 1);
  options.periodic = {{"front", "back", {0, 6.999, 0}}};
  EXPECT_NE(failure(test::mixed_units(7), ExitCode::mesh, options).find("\"front\" has no partner"), std::string::npos);
  options.periodic = {{"front", "bottom", {0, 7, 0}}};
  EXPECT_NE(failure(test::mixed_units(7), ExitCode::mesh, options).find("no equal number"), std::string::npos);
  options.periodic = {{"front", "rear", {0, 7, 0}}};
  EXPECT_NE(failure(test::mixed_units(7), ExitCode::mesh, options).find("back, bottom, front, sides"), std::string::npos);
}

// A missing file, or one cut off, is an input error that names the file, on every rank.
TEST(Import, RefusesMissingAndCutOffFiles) {
  EXPECT_NE(failure("no/such/mesh.msh", ExitCode::io).find("no/such/mesh.msh: the mesh file does not exist"), std::string::npos);
  EXPECT_NE(failure("/dev/zero", ExitCode::io).find("device"), std::string::npos);
  for (const Format format : {Format::ascii22, Format::binary22, Format::ascii41, Format::binary41})
    for (const double part : {0.0, 0.02, 0.5, 0.97}) {
      const test::TemporaryFile file(test::mixed_units(3), format);
      if (rank_of(MPI_COMM_WORLD) == 0)
        std::filesystem::resize_file(file.path(),
                                     static_cast<std::uintmax_t>(part * static_cast<double>(std::filesystem::file_size(file.path()))));
      MPI_Barrier(MPI_COMM_WORLD);
      EXPECT_NE(failure(file.path(), ExitCode::io).find(file.path().string()), std::string::npos);
    }
}

/// Puts `by` in the place of `what` in a file.
void replace_in(const std::filesystem::path& file, const std::string& what, const std::string& by) {
  if (rank_of(MPI_COMM_WORLD) == 0) {
    std::ostringstream content;
    content << std::ifstream(file).rdbuf();
    std::string text = content.str();
    const std::size_t at = text.find(what);
    if (at != std::string::npos) text.replace(at, what.size(), by);
    std::ofstream(file) << text;
  }
  MPI_Barrier(MPI_COMM_WORLD);
}

// Damage inside a file is found on rank 0 alone: every rank gets the same error, with the line.
TEST(Import, RefusesDamagedFiles) {
  const auto damaged = [](const std::string& what, const std::string& by) {
    const test::TemporaryFile file(test::mixed_units(2), Format::ascii22);
    replace_in(file.path(), what, by);
    return failure(file.path(), ExitCode::io);
  };
  EXPECT_NE(damaged("\n3 0 0 1", "\n3 0 zero 1").find("line 17, section $Nodes: a number is expected, found \"zero\""), std::string::npos);
  EXPECT_NE(damaged("\n3 0 0 1", "\n3 0 zero 1").find("number is expected"), std::string::npos);
  EXPECT_NE(damaged("\n3 0 0 1", "\n3 0 nan 1").find("not finite"), std::string::npos);
  EXPECT_NE(damaged("\n3 0 0 1", "\n4 0 0 1").find("node number 4 occurs twice"), std::string::npos);
  EXPECT_NE(damaged("1 3 2 1 2 1 2", "1 3 2 1 2 1 222").find("node 222"), std::string::npos);
}

// Groups that no gmsh writes: each ends with an error or is read, never with a crash.
TEST(Import, RefusesImpossibleGroups) {
  const auto damaged = [](const std::string& what, const std::string& by, ExitCode code) {
    const test::TemporaryFile file(test::mixed_units(2), Format::ascii41);
    replace_in(file.path(), what, by);
    return failure(file.path(), code);
  };
  const std::string surface = "\n11 0 0 0 9 9 9 1 1 0", counts = "\n0 0 4 2";
  EXPECT_NE(damaged(surface, "\n11 0 0 0 9 9 9 -1 1 0", ExitCode::io).find("physical tags is -1"), std::string::npos);
  EXPECT_NE(damaged(surface, "\n2147483648 0 0 0 9 9 9 1 1 0", ExitCode::io).find("2147483648 is too large"), std::string::npos);
  EXPECT_NE(damaged(surface, "\n11 0 0 0 9 9 9 1000000000 1 0", ExitCode::io).find("number is expected"), std::string::npos);
  EXPECT_NE(damaged(counts, "\n0 0 1000000000 2", ExitCode::io).find("section $Entities"), std::string::npos);
  EXPECT_NE(damaged(surface, "\n-5 0 0 0 9 9 9 1 1 0", ExitCode::mesh).find("have no name"), std::string::npos);
  EXPECT_NE(damaged("\"front\"", "\"" + std::string(5000, 'f') + "\"", ExitCode::io).find("ffff...\" has 5000 bytes"), std::string::npos);
}

// Words of any length may stand where no number or name is read.
TEST(Import, PassesOverLongComments) {
  const test::TemporaryFile file(test::mixed_units(2), Format::ascii22);
  replace_in(file.path(), "$PhysicalNames", "$Comments\n" + std::string(5000, 'c') + "\n$EndComments\n$PhysicalNames");
  EXPECT_NEAR(test::volume(import_mesh(file.path(), MPI_COMM_WORLD)), 4, 1e-13);
}

// Cells that do not fit together: exit code 3 and the place on every rank.
TEST(Import, RefusesCellsThatDoNotFit) {
  auto twisted = test::mixed_units(3);
  std::swap(twisted.element[6].node[2], twisted.element[6].node[3]);
  EXPECT_NE(failure(twisted, ExitCode::mesh).find("at (0.5, 0.5, 1) m has its corners in another cycle"), std::string::npos);
  auto crossed = test::mixed_units(3);
  std::swap(crossed.element[4].node[2], crossed.element[4].node[3]);
  EXPECT_NE(failure(crossed, ExitCode::mesh).find("is not a face of a cell"), std::string::npos);
  auto gap = test::mixed_units(3);
  std::erase_if(gap.element, [](const auto& element) { return element.type == 7 && element.node[0] == 2; });
  EXPECT_NE(failure(gap, ExitCode::mesh).find("is not a face of a cell"), std::string::npos);
  auto folded = test::mixed_units(3);
  folded.element[4].node[7] = folded.element[4].node[6];
  EXPECT_NE(failure(folded, ExitCode::mesh).find("twice"), std::string::npos);
}

// What is not a gmsh file is named, with the way to make it one.
TEST(Import, NamesOtherFormats) {
  const auto refused = [](const std::string& ending, const std::string& content) {
    const test::TemporaryFile file(ending);
    if (rank_of(MPI_COMM_WORLD) == 0) std::ofstream(file.path()) << content;
    MPI_Barrier(MPI_COMM_WORLD);
    return failure(file.path(), ExitCode::mesh);
  };
  const std::vector<std::array<std::string, 3>> formats{{".step", "ISO-10303-21;\nHEADER;", "STEP"},
                                                        {".msh", "solid pump\nfacet normal 0 0 1\n", "STL"},
                                                        {".vtk", "# vtk DataFile Version 3.0\n", "VTK"},
                                                        {".vtu", "<?xml version=\"1.0\"?>\n<VTKFile>", "VTK"},
                                                        {".unv", "    -1\n  2411\n", "UNV"},
                                                        {".msh", "(0 \"Fluent\")\n(2 3)\n", "Fluent"},
                                                        {".cgns", "\x89HDF\r\n", "HDF5"},
                                                        {".msh", "FoamFile\n{ version 2.0; class vectorField; }", "OpenFOAM"},
                                                        {".bdf", "GRID,1,,0.,0.,0.\n", "Nastran"}};
  for (const auto& [ending, content, name] : formats) {
    const std::string message = refused(ending, content);
    EXPECT_NE(message.find(name), std::string::npos) << message;
    EXPECT_NE(message.find("gmsh"), std::string::npos) << message;
  }
  EXPECT_NE(refused(".msh", "hello").find("begins with \"hello\""), std::string::npos);
}

// Meshes that Snag cannot use are refused with the place or the remedy.
TEST(Import, RefusesUnnamedAndCurvedParts) {
  auto unnamed_face = test::mixed_units(3);
  unnamed_face.element.pop_back();  // the back
  EXPECT_NE(failure(unnamed_face, ExitCode::mesh).find("(0.5, 3, 0.5) m"), std::string::npos);
  auto unnamed_volume = test::mixed_units(3);
  unnamed_volume.volumes.pop_back();
  EXPECT_NE(failure(unnamed_volume, ExitCode::mesh).find("Physical Volume"), std::string::npos);
  auto surface_only = test::mixed_units(2);
  std::erase_if(surface_only.element, [](const auto& element) { return element.dimension() == 3; });
  EXPECT_NE(failure(surface_only, ExitCode::mesh).find("no volume cells"), std::string::npos);
  auto curved = test::mixed_units(2);
  curved.element[0].type = 10;
  EXPECT_NE(failure(curved, ExitCode::mesh).find("ElementOrder"), std::string::npos);
  auto doubled = test::mixed_units(2);
  doubled.element.push_back(doubled.element[4]);
  EXPECT_NE(failure(doubled, ExitCode::mesh).find("at most two"), std::string::npos);
}

}  // namespace
