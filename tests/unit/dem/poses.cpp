// ranks: 1
// long ranks: 2
// Poses in which a sheet is put into a run: folded, crumpled by a pipe, fallen through a hopper.
#include <gtest/gtest.h>

#include <filesystem>

#include "base/error.hpp"
#include "dem/poses/crumpled.hpp"
#include "dem/poses/pipe_wall.hpp"
#include "dem/rag_measures.hpp"
#include "dem/rag_system.hpp"
#include "dem/templates/folded.hpp"
#include "dem/templates/pose_file.hpp"
#include "parallel/session.hpp"

namespace snag {
namespace {

constexpr double pi = 3.14159265358979323846;

std::vector<RagPiece> pieces_of(const std::string& text) {
  const CaseFile file = CaseFile::parse(text);
  std::vector<RagPiece> pieces = read_pieces(file);
  file.reject_unread();
  return pieces;
}

const std::string small_sheet = "[[rag]]\nlength_mm = 120\nwidth_mm = 88\nradius_mm = 2\n";
const std::string confined = small_sheet + "pose = \"confined\"\nconfine_radius_mm = 28\n";

std::vector<RagPiece> made(const std::string& text) {
  std::vector<RagPiece> pieces = pieces_of(text);
  make_poses(MPI_COMM_WORLD, pieces, {});
  return pieces;
}

/// Message of the error that reading and making poses ends with.
std::string refusal(const std::string& text) {
  try {
    made(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    return error.what();
  }
  return "accepted";
}

/// Distance from the axis (direction `axis`, through the piece's centre) and along it, of all particles' surfaces, m.
struct Extent {
  double radius = 0, half_length = 0;
  Vec3 mean;
};
Extent extent(const RagPiece& piece, const Vec3& axis) {
  Extent e;
  for (int row = 0; row < piece.rag.n_rows; ++row)
    for (int column = 0; column < piece.rag.n_columns; ++column) {
      if (!piece.exists(column, row)) continue;
      const Vec3 x = piece.pose(column, row).position - piece.centre;
      const double along = dot(x, axis);
      e.radius = std::max(e.radius, norm(x - along * axis) + piece.rag.radius);
      e.half_length = std::max(e.half_length, std::abs(along) + piece.rag.radius);
      e.mean += x / static_cast<double>(count_particles(piece));
    }
  return e;
}

void expect_same_bits(const RagPiece& a, const RagPiece& b) {
  ASSERT_EQ(a.poses.size(), b.poses.size());
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    EXPECT_EQ(a.poses[i].position, b.poses[i].position);
    EXPECT_EQ(a.poses[i].orientation.w, b.poses[i].orientation.w);
    EXPECT_EQ(a.poses[i].orientation.z, b.poses[i].orientation.z);
  }
}

double nearest_unbonded(const RagPiece& piece) {
  double nearest = infinity;
  const auto& poses = piece.poses;
  const int n = piece.rag.n_columns;
  for (int a = 0; a < static_cast<int>(poses.size()); ++a)
    for (int b = a + 1; b < static_cast<int>(poses.size()); ++b) {
      const bool bonded = (b == a + 1 && b % n != 0) || b == a + n;
      if (!bonded) nearest = std::min(nearest, norm(poses[a].position - poses[b].position));
    }
  return nearest;
}

TEST(FoldedPose, LeavesTheBondsUnstretchedAndTheLayersApart) {
  // Requirement: every bond of a fan keeps its length and is not sheared, bent by at most pi/3, layers are 4 r apart and nothing touches.
  for (const std::string folds : {"folds_lengthwise = 3\n", "folds_crosswise = 2\n"}) {
    const std::vector<RagPiece> pieces =
        pieces_of(small_sheet + "pose = \"folded\"\nlengthwise = [0.3, 0.2, 1]\ncentre_m = [1, 2, 3]\n" + folds);
    const RagPiece& piece = pieces[0];
    EXPECT_LT(norm(extent(piece, {0, 0, 1}).mean), 1e-14);
    EXPECT_GT(nearest_unbonded(piece), 2 * piece.rag.radius * (1 + 1e-9));
    RagSystem rags(MPI_COMM_WORLD, {}, pieces);
    EXPECT_NEAR(bond_strain_quantile(rags, 0, 1), 0, 1e-11);
    EXPECT_NEAR(bond_strain_quantile(rags, 0, 0), 0, 1e-11);
    // Energy of bending alone: each bond of a bend by pi/m, 1/2 S_nb I (pi/m)^2.
    const bool lengthwise = piece.plan.folds_lengthwise > 0;
    const double bends = lengthwise ? 3. * piece.rag.n_rows : 2. * piece.rag.n_columns, angle = pi / bonds_of_bend;
    const double expected = bends * bonds_of_bend * 0.5 * bonds_of(piece.rag)->coefficients(lengthwise ? 0 : 1).bending * angle * angle;
    EXPECT_NEAR(rag_states(rags)[0].bond_energy, expected, 1e-9 * expected);
    const Vec3 normal = rotate(piece.orientation, {0, 0, 1});
    const int layers = lengthwise ? 4 : 3;
    EXPECT_NEAR(extent(piece, normal).half_length, piece.rag.radius + 0.5 * (layers - 1) * layer_distance_over_radius * piece.rag.radius,
                1e-3 * piece.rag.radius);
  }
}

TEST(ConfinedPose, FitsIntoThePipeWithItsBondsWhole) {
  // Requirement: all particles are within radius and length, the mean lies at the centre along a pipe without ends, bonds and contacts are
  // hardly strained, and the sheet put into a run moves slowly.
  const auto pieces =
      made(confined + "centre_m = [0.5, 0, -0.2]\nconfine_axis = [0, 1, 1]\nlengthwise = [1, 0, 0]\ncrosswise = [0, 1, -1]\n");
  const Vec3 axis = unit(Vec3{0, 1, 1});
  const Extent e = extent(pieces[0], axis);
  EXPECT_LE(e.radius, 0.028);
  EXPECT_GT(e.radius, 0.026);
  EXPECT_NEAR(dot(e.mean, axis), 0, 1e-14);
  EXPECT_GT(nearest_unbonded(pieces[0]), 2 * 0.002 * (1 - 0.15));
  RagSystem rags(MPI_COMM_WORLD, {}, pieces);
  EXPECT_LT(bond_strain_quantile(rags, 0, 0.99), 0.1);
  EXPECT_GT(rag_states(rags)[0].bond_energy, 0);
  rags.advance(1e-3);
  EXPECT_LT(rag_states(rags)[0].kinetic_energy, 0.2 * rag_states(rags)[0].bond_energy);

  const auto capped = made(confined + "confine_length_mm = 70\nlengthwise = [0, 0, 1]\n");
  EXPECT_LE(extent(capped[0], {0, 0, 1}).half_length, 0.035);
  EXPECT_LE(extent(capped[0], {0, 0, 1}).radius, 0.028);
}

TEST(ConfinedPose, FollowsTheSeedAlone) {
  // Requirement: one seed gives the same bits each time and on every rank, another seed another pose.
  const auto one = made(confined), again = made(confined), other = made(confined + "seed = 2\n");
  expect_same_bits(one[0], again[0]);
  double difference = 0;
  for (std::size_t i = 0; i < one[0].poses.size(); ++i)
    difference = std::max(difference, norm(one[0].poses[i].position - other[0].poses[i].position));
  EXPECT_GT(difference, 0.01);
  RagPiece alone = pieces_of(confined)[0];
  alone.poses = crumple(alone, {}).poses;  // each rank by itself
  expect_same_bits(one[0], alone);
}

TEST(ConfinedPose, IsRepeatedWithSlowerWallsWhereTheSheetIsCrushed) {
  // Requirement: a pipe whose walls crush the sheet of one seed closes more slowly, and the log gives the attempt and the speed.
  std::vector<RagPiece> pieces = pieces_of(small_sheet + "pose = \"confined\"\nconfine_radius_mm = 18\nseed = 3\n");
  const std::string line = make_poses(MPI_COMM_WORLD, pieces, {}).at(0);
  if (rank_of(MPI_COMM_WORLD) == 0) {
    EXPECT_NE(line.find("attempt 2, with walls that close at 0.5 m/s"), std::string::npos) << line;
  }
  EXPECT_LE(extent(pieces[0], {0, 0, 1}).radius, 0.018);
  RagSystem rags(MPI_COMM_WORLD, {}, pieces);
  EXPECT_LT(bond_strain_quantile(rags, 0, 0.99), 0.1);
  const std::string message = refusal(small_sheet + "pose = \"confined\"\nconfine_radius_mm = 11.7\n");
  std::printf("%s\n", message.c_str());
  EXPECT_NE(message.find("in the last of 4 attempts, with walls that close at 0.125 m/s"), std::string::npos) << message;
}

TEST(HopperPose, HasFallenIntoThePipe) {
  // Requirement: the whole sheet is within the pipe's radius but for the overlap with the wall, its bonds hardly strained.
  const auto pieces = made(small_sheet + "pose = \"hopper\"\nconfine_radius_mm = 35\nconfine_axis = [0, 0, -1]\n");
  const Extent e = extent(pieces[0], {0, 0, 1});
  EXPECT_LT(e.radius, 0.035 + 0.5 * 0.002);
  EXPECT_NEAR(e.mean.z, 0, 1e-14);
  RagSystem rags(MPI_COMM_WORLD, {}, pieces);
  EXPECT_LT(bond_strain_quantile(rags, 0, 0.99), 0.1);
}

TEST(PipeWall, PushesFromItsNearestPoint) {
  // Requirement: pipe, hopper, their edge and both ends push along the normal at the nearest point, from behind too.
  const PipeShape pipe{.axis = {0, 0, 1}, .radius = 0.05, .half_length = 0.1};
  const PipeContact side = pipe_contact(pipe, {0.0495, 0, 0.3}, 0.001);
  EXPECT_NEAR(side.overlap, 0.0005, 1e-15);
  EXPECT_EQ(side.normal, (Vec3{-1, 0, 0}));
  EXPECT_NEAR(end_contact(pipe, {0, 0, -0.0995}, 0.001).overlap, 0.0005, 1e-15);
  EXPECT_EQ(end_contact(pipe, {0, 0, -0.0995}, 0.001).normal, (Vec3{0, 0, 1}));

  const PipeShape hopper{.axis = {0, 0, -1}, .radius = 0.05, .half_length = infinity, .hopper_slope = 1};
  const double root = std::sqrt(0.5);
  const PipeContact cone = pipe_contact(hopper, {0.08 - root * 0.0005, 0, 0.03 + root * 0.0005}, 0.001);
  EXPECT_NEAR(cone.overlap, 0.0005, 1e-15);
  EXPECT_NEAR(norm(cone.normal - Vec3{-root, 0, root}), 0, 1e-12);
  const PipeContact behind = pipe_contact(hopper, {0.08 + root * 0.0005, 0, 0.03 - root * 0.0005}, 0.001);
  EXPECT_NEAR(behind.overlap, 0.0015, 1e-15);
  EXPECT_NEAR(norm(behind.normal - Vec3{-root, 0, root}), 0, 1e-12);
  const double tilt = pi / 8;  // between the normals of pipe and cone: the edge
  const PipeContact edge = pipe_contact(hopper, {0.05 - 0.0005 * std::cos(tilt), 0, 0.0005 * std::sin(tilt)}, 0.001);
  EXPECT_NEAR(edge.overlap, 0.0005, 1e-15);
  EXPECT_NEAR(norm(edge.normal - Vec3{-std::cos(tilt), 0, std::sin(tilt)}), 0, 1e-12);
  EXPECT_FALSE(pipe_contact(hopper, {0.06, 0, 0.03}, 0.001).overlap > 0);
}

TEST(PoseFile, GivesTheSamePoseAtAnotherPlace) {
  // Requirement: what was written is read bit by bit, and lies about the centre of the piece that takes it.
  const auto pieces = made(confined);
  const auto file = std::filesystem::temp_directory_path() / ("snag_pose_round_trip_" + std::to_string(rank_of(MPI_COMM_WORLD)) + ".csv");
  write_pose_file(file, pieces[0]);
  const auto taken = pieces_of(small_sheet + "pose_file = \"" + file.string() + "\"\ncentre_m = [0, 0, 1]\n");
  expect_same_bits(pieces[0], taken[0]);
  EXPECT_EQ(taken[0].pose(3, 4).position, (Vec3{0, 0, 1} + pieces[0].poses[4 * 30 + 3].position));
  std::filesystem::remove(file);
}

TEST(PoseSettings, RefuseWhatCannotBeDone) {
  // Requirement: errors name the key: what does not belong together, and a pipe that cannot hold the cloth.
  const auto names = [](const std::string& text, const std::string& key) {
    const std::string message = refusal(text);
    EXPECT_NE(message.find(key), std::string::npos) << message;
  };
  names(small_sheet + "pose = \"confined\"\n", "confine_radius");
  names(small_sheet + "pose = \"confined\"\nconfine_radius_mm = 7\n", "confine_radius of 0.007 m");
  names(confined + "confine_length_mm = 15\n", "confine_radius");
  names(confined + "pose_file = \"a.csv\"\n", "pose_file");
  names(confined + "folds_crosswise = 1\n", "folds_crosswise");
  names(confined + "confine_axis = [0, 0, 0]\n", "confine_axis");
  names(small_sheet + "confine_radius_mm = 30\n", "confine_radius");
  names(small_sheet + "pose = \"hopper\"\nconfine_radius_mm = 30\nconfine_length_mm = 30\n", "confine_length");
  names(small_sheet + "pose = \"folded\"\n", "folds_lengthwise");
  names(small_sheet + "pose = \"folded\"\nfolds_crosswise = 1\nfolds_lengthwise = 1\n", "folds_lengthwise");
  names(small_sheet + "pose = \"folded\"\nfolds_crosswise = 6\n", "folds_crosswise = 6");
  names(confined + "seed = -1\n", "seed");
}

}  // namespace
}  // namespace snag
