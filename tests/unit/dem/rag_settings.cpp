// Pieces of cloth from a case file, and their lattices.
#include "dem/templates/rag_settings.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>
#include <set>

#include "base/error.hpp"
#include "dem/rag_system.hpp"
#include "dem/templates/pose_file.hpp"

namespace snag {
namespace {

RagPiece piece_of(const std::string& text) {
  const CaseFile file = CaseFile::parse(text);
  const std::vector<RagPiece> pieces = read_pieces(file);
  file.reject_unread();
  EXPECT_EQ(pieces.size(), 1u);
  return pieces.at(0);
}

TEST(RagSettings, PublishedClothHasItsParticlesAndBonds) {
  // Requirement: the rag of the thesis at r_p = 1 mm is an in-line grid of 150 x 110 spheres with the bonds of Tables 3.3 and 3.4.
  const RagPiece piece = piece_of("[[rag]]\nradius_mm = 1.0\ndensity_model = \"jensen_2018\"\n");
  const Rag& rag = piece.rag;
  EXPECT_EQ(rag.n_columns, 150);
  EXPECT_EQ(rag.n_rows, 110);
  EXPECT_EQ(count_particles(piece), 16500);
  EXPECT_EQ(count_bonds(piece), 149 * 110 + 150 * 109);
  EXPECT_NEAR(rag.mass, 538 * std::numbers::pi / 6 * 8e-9, 1e-18);
  EXPECT_NEAR(rag.hydrodynamic_volume * 16500, 0.77e-3 * 0.300 * 0.220, 1e-15);
  EXPECT_EQ(rag.bond[0].normal_stiffness, 7.65e8);
  EXPECT_EQ(rag.bond[0].bending_stiffness, 3.86e7);
  EXPECT_EQ(rag.bond[1].normal_stiffness, 4.23e8);
  EXPECT_EQ(rag.bond[1].normal_strength, 2.23e5);
  EXPECT_EQ(rag.name, "rag 1");
}

/// Bonds that a cut of a sheet of 6 x 4 particles of 1 mm takes away, as "column,row,direction".
std::set<std::string> cut_bonds(const std::string& from, const std::string& to) {
  const std::string sheet = "[[rag]]\nlength_mm = 12\nwidth_mm = 8\n";
  const Rag whole = piece_of(sheet).rag, cut = piece_of(sheet + "[[rag.cut]]\nfrom_mm = " + from + "\nto_mm = " + to + "\n").rag;
  std::set<std::string> gone;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 6; ++column)
      for (const int direction : {0, 1}) {
        EXPECT_LE(cut.has_bond(column, row, direction), whole.has_bond(column, row, direction));
        if (cut.has_bond(column, row, direction) != whole.has_bond(column, row, direction))
          gone.insert(std::to_string(column) + "," + std::to_string(row) + "," + std::to_string(direction));
      }
  return gone;
}

TEST(RagSettings, ACutTakesAwayTheBondsThatCrossIt) {
  // Requirement: exactly the bonds whose line from particle to particle crosses the cut are gone; the lattice has its particles at -5, -3
  // .. 5 mm along and -3, -1, 1, 3 mm across.
  using Bonds = std::set<std::string>;
  EXPECT_EQ(cut_bonds("[-9, 0]", "[-2, 0]"), (Bonds{"0,1,1", "1,1,1"})) << "along, from the edge into the cloth";
  EXPECT_EQ(cut_bonds("[-2, 0]", "[-9, 0]"), (Bonds{"0,1,1", "1,1,1"})) << "the other way";
  EXPECT_EQ(cut_bonds("[0, -9]", "[0, 9]"), (Bonds{"2,0,0", "2,1,0", "2,2,0", "2,3,0"})) << "right across";
  EXPECT_EQ(cut_bonds("[-3.5, -0.5]", "[-0.5, 2.5]"), (Bonds{"1,1,1", "1,2,0", "2,2,1"})) << "oblique, x - y = -3: a staircase";
  EXPECT_EQ(cut_bonds("[-3, -9]", "[-3, 9]"), (Bonds{"1,0,0", "1,1,0", "1,2,0", "1,3,0"}))
      << "through a column, upwards: it stays on the left";
  EXPECT_EQ(cut_bonds("[-3, 9]", "[-3, -9]"), (Bonds{"0,0,0", "0,1,0", "0,2,0", "0,3,0"})) << "downwards";
  EXPECT_EQ(cut_bonds("[-4, -0.1]", "[-4, -1]"), (Bonds{"0,1,0"})) << "as far as a bond";
}

TEST(RagSettings, ACutWithoutEffectIsRefused) {
  // Requirement: a cut that crosses no bond, between particles, beside the cloth or where another one is, ends with the remedy.
  const std::string sheet = "[[rag]]\nlength_mm = 12\nwidth_mm = 8\n", cut = "[[rag.cut]]\nfrom_mm = [-9, 0]\nto_mm = [-2, 0]\n";
  for (const std::string& useless : {std::string("[[rag.cut]]\nfrom_mm = [-3.5, 0.2]\nto_mm = [-3.2, 0.7]\n"),
                                     std::string("[[rag.cut]]\nfrom_mm = [7, -4]\nto_mm = [7, 4]\n"),
                                     std::string("[[rag.cut]]\nfrom_mm = [0, 0]\nto_mm = [0, 0]\n"), cut + cut}) {
    try {
      piece_of(sheet + useless);
      ADD_FAILURE() << "no error: " << useless;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::usage);
      EXPECT_NE(std::string(error.what()).find("crosses no bond"), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(piece_of(sheet + "[[rag.cut]]\nfrom_mm = [-9]\nto_mm = [-2, 0]\n"), Error);
  EXPECT_THROW(piece_of(sheet + "[[rag.cut]]\nto_mm = [-2, 0]\n"), Error);
  EXPECT_THROW(piece_of("[[fibre]]\n[[fibre.cut]]\nfrom_mm = [-9, 0]\nto_mm = [9, 0]\n"), Error) << "a key that nobody reads";
}

TEST(RagSettings, APieceBeyondTheMemoryIsRefused) {
  // Requirement: a slip of the unit ends with the number of particles, before they are made.
  try {
    piece_of("[[rag]]\nlength = \"20 km\"\nwidth = \"40 mm\"\nradius_mm = 1");
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find("2e+08 particles"), std::string::npos) << error.what();
  }
}

TEST(RagSettings, SoakedClothWeighsWhatItIsMeasuredToWeigh) {
  // Requirement: by default the mass of all particles is 0.785 kg/m2 times the area, whatever the particle radius.
  for (const char* radius : {"1.0", "1.5", "2.0"}) {
    const RagPiece piece = piece_of(std::string("[[rag]]\nlength = \"0.3 m\"\nwidth = \"0.24 m\"\nradius_mm = ") + radius);
    EXPECT_NEAR(piece.rag.mass * static_cast<double>(count_particles(piece)), 0.785 * 0.3 * 0.24, 1e-12);
  }
}

TEST(RagSettings, PublishedBondsAreInterpolatedBetweenTheRadiiOfTheTables) {
  // Requirement: printed values at 1.0, 1.5, 2.0 mm, straight lines in the logarithms between, an error outside.
  EXPECT_EQ(published_bond(1.5e-3, 0).bending_stiffness, 7.86e6);
  EXPECT_EQ(published_bond(2e-3, 1).tangential_stiffness, 5e5);
  const double middle = std::sqrt(1.0e-3 * 1.5e-3);
  EXPECT_NEAR(published_bond(middle, 0).normal_stiffness, std::sqrt(7.65e8 * 3.40e8), 1);
  EXPECT_THROW(published_bond(0.9e-3, 0), Error);
  EXPECT_THROW(piece_of("[[rag]]\nradius_mm = 3.0\n"), Error);
}

TEST(RagSettings, DiscHoldsThePublishedNumberOfParticles) {
  // Requirement: the disc of 210 mm holds 8664, 3852, 2171 particles in the thesis (Table 3.5); an in-line grid comes within 1 %.
  constexpr double published[3] = {8664, 3852, 2171};
  int k = 0;
  for (const char* radius : {"1.0", "1.5", "2.0"}) {
    const RagPiece piece = piece_of(std::string("[[disc]]\nradius_mm = ") + radius);
    EXPECT_NEAR(static_cast<double>(count_particles(piece)) / published[k++], 1, 0.01);
  }
}

TEST(RagSettings, SingleParticleTakesTheKeysOfTheDiagnosis) {
  // Requirement: diameter, density, position and velocity with the unit in the key make one sphere without bonds.
  const RagPiece piece =
      piece_of("[[particle]]\ndiameter_m = 5e-3\ndensity_kg_m3 = 1150\nposition_m = [1, 0, 2]\nvelocity_m_s = [0, 0.5, 0]\n");
  EXPECT_EQ(piece.rag.n_columns * piece.rag.n_rows, 1);
  EXPECT_NEAR(piece.rag.mass, 1150 * std::numbers::pi / 6 * 125e-9, 1e-15);
  EXPECT_EQ(piece.rag.hydrodynamic_diameter, 5e-3);
  EXPECT_EQ(piece.pose(0, 0).position, (Vec3{1, 0, 2}));
  EXPECT_EQ(count_bonds(piece), 0);
}

TEST(RagSettings, FibreIsABeamOfItsDiameter) {
  // Requirement: bonds in series give the stretching stiffness E A and bending stiffness E I of the fibre.
  const RagPiece piece =
      piece_of("[[fibre]]\nlength_mm = 20\nn_points = 10\ndiameter_mm = 0.5\nyoungs_modulus_Pa = 1e7\nlengthwise = [0, 0, 1]\n");
  const Rag& rag = piece.rag;
  const double d = 0.5e-3, pi = std::numbers::pi, l0 = 2e-3;
  EXPECT_NEAR(rag.radius, 1e-3, 1e-15);
  const BondCoefficients law = bonds_of(rag)->coefficients(0);
  EXPECT_NEAR(law.normal * l0, 1e7 * pi / 4 * d * d, 1e-12);
  EXPECT_NEAR(law.bending * l0, 1e7 * pi / 64 * d * d * d * d, 1e-18);
  EXPECT_NEAR(rag.mass * 10, 1380 * pi / 4 * d * d * 0.02, 1e-15);
  EXPECT_NEAR(piece.pose(9, 0).position.z - piece.pose(0, 0).position.z, 0.018, 1e-15);
}

TEST(RagSettings, ContactsAreNoHarderThanTheBeam) {
  // Requirement: without a shear modulus contacts have the published one, and of a soft beam its own; a given one holds.
  EXPECT_EQ(piece_of("[[rag]]\n").rag.shear_modulus, 1e6);
  EXPECT_EQ(piece_of("[[fibre]]\nyoungs_modulus_Pa = 1e7\n").rag.shear_modulus, 1e6);
  EXPECT_NEAR(piece_of("[[fibre]]\nyoungs_modulus_Pa = 1e5\n").rag.shear_modulus, 4e4, 1e-9);
  EXPECT_EQ(piece_of("[[fibre]]\nyoungs_modulus_Pa = 1e5\nshear_modulus_Pa = 2e6\n").rag.shear_modulus, 2e6);
}

TEST(RagSettings, GivenBondsMustBeGiven) {
  // Requirement: properties = "custom" without stiffness is an error that names the keys.
  try {
    piece_of("[[rag]]\nproperties = \"custom\"\n");
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find("normal_stiffness_lengthwise"), std::string::npos);
  }
  const RagPiece piece = piece_of(
      "[[rag]]\nlength_mm = 20\nwidth_mm = 10\nproperties = \"custom\"\nnormal_stiffness_lengthwise_N_m3 = 1e8\n"
      "normal_stiffness_crosswise_N_m3 = 2e8\nbending_stiffness_crosswise_N_m3 = 3e6\n");
  EXPECT_EQ(piece.rag.bond[1].normal_stiffness, 2e8);
  EXPECT_EQ(piece.rag.bond[1].bending_stiffness, 3e6);
}

TEST(RagSettings, PoseFilePlacesEveryParticle) {
  // Requirement: positions and orientations of a pose file reach the tiles; a missing or doubled id is an error.
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "snag_pose_test.csv";
  Rag rag;
  rag.n_columns = 3, rag.n_rows = 2;
  std::ofstream(file)
      << "id,x,y,z,qw,qx,qy,qz\n5,1,2,3,0,1,0,0\n0,0,0,0,1,0,0,0\n1,0,0,0,1,0,0,0\n2,0,0,0,1,0,0,0\n3,0,0,0,1,0,0,0\n4,0,0,0,1,0,0,0\n";
  const std::vector<ParticlePose> poses = read_pose_file(file, rag);
  EXPECT_EQ(poses[5].position, (Vec3{1, 2, 3}));
  EXPECT_EQ(poses[5].orientation.x, 1);
  std::ofstream(file) << "id,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n0,0,0,0,1,0,0,0\n";
  EXPECT_THROW(read_pose_file(file, rag), Error);
  std::filesystem::remove(file);
  EXPECT_THROW(read_pose_file(file, rag), Error);
}

TEST(Lattice, TilesCoverTheLatticeOnce) {
  // Requirement: every particle and every bond belongs to exactly one tile, sides are within the limits, rows are whole vectors of 8.
  for (const auto& [columns, rows] : {std::pair{150, 110}, {1, 1}, {159, 1}, {200, 73}, {75, 55}}) {
    RagPiece piece;
    piece.rag.n_columns = columns, piece.rag.n_rows = rows, piece.rag.radius = 1e-3;
    const TileGrid grid = tile_grid(columns, rows);
    std::vector<int> covered(static_cast<std::size_t>(columns) * rows, 0);
    double bonds = 0;
    for (int t = 0; t < grid.n_tiles(); ++t) {
      const Tile tile = make_tile(piece, 0, grid, t);
      EXPECT_LE(tile.nx, max_tile_columns);
      EXPECT_LE(tile.ny, max_tile_rows);
      EXPECT_EQ(tile.stride % 8, 0);
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(tile.field(Tile::wx)) % 64, 0u);
      for (int j = 0; j < tile.ny; ++j)
        for (int i = 0; i < tile.nx; ++i) {
          ++covered[particle_id(piece.rag, tile, i, j)];
          bonds += tile.bond_x[tile.index(i, j)] + tile.bond_y[tile.index(i, j)];
        }
    }
    EXPECT_EQ(std::count(covered.begin(), covered.end(), 1), std::ssize(covered));
    EXPECT_EQ(bonds, static_cast<double>(count_bonds(piece)));
  }
  EXPECT_EQ(tile_grid(150, 110).n_tiles(), 8);
}

TEST(Lattice, PoseFollowsItsDirections) {
  // Requirement: rows run along `lengthwise`, the other side along the part of `crosswise` across it; parallel directions are refused.
  const Quaternion q = rotation_to({0, 0, 2}, {1, 0, 5});
  EXPECT_NEAR(norm(rotate(q, {1, 0, 0}) - Vec3{0, 0, 1}), 0, 1e-15);
  EXPECT_NEAR(norm(rotate(q, {0, 1, 0}) - Vec3{1, 0, 0}), 0, 1e-15);
  EXPECT_THROW(rotation_to({0, 0, 1}, {0, 0, -3}), Error);
}

}  // namespace
}  // namespace snag
