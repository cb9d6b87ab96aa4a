#include "base/vtk_reader.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "base/error.hpp"

using namespace snag;

TEST(VtkReader, ReadsWhatWasWritten) {
  // Requirement: points, polygons and arrays come back, blocks of several included; a file that is cut is refused.
  const auto folder = std::filesystem::temp_directory_path() / ("snag-vtk-" + std::to_string(std::random_device{}()));
  std::filesystem::create_directories(folder);
  VtkPiece piece;
  std::vector<double> speed;
  for (int k = 0; k < 40000; ++k) piece.points.push_back({0.1 * k, -1.0 / (k + 1), 3e-5 * k}), speed.push_back(0.25 * k);
  piece.connectivity = {0, 1, 2, 39999, 7, 8}, piece.offsets = {3, 6};
  piece.point_arrays = {vtk_array("speed [m/s]", std::span<const double>(speed), true)};
  write_vtk(folder / "a.vtp", VtkKind::polygons, piece);
  VtkCollection collection(folder / "all.pvd", false);
  collection.add(0.25, "a.vtp");
  const std::vector<VtkInstant> instants = read_collection(folder / "all.pvd");
  ASSERT_EQ(instants.size(), 1U);
  EXPECT_EQ(instants[0].time, 0.25);
  const VtkPiece read = read_polygons(instants[0].file);
  EXPECT_EQ(read.points, piece.points);
  EXPECT_EQ(read.connectivity, piece.connectivity);
  EXPECT_EQ(read.offsets, piece.offsets);
  EXPECT_EQ(array_named(read.point_arrays, "speed", "a.vtp"), speed);
  EXPECT_THROW(array_named(read.point_arrays, "spee", "a.vtp"), Error);
  std::filesystem::resize_file(folder / "a.vtp", std::filesystem::file_size(folder / "a.vtp") - 5000);
  EXPECT_THROW(read_polygons(folder / "a.vtp"), Error);
  EXPECT_THROW(read_polygons(folder / "b.vtp"), Error);
  std::filesystem::remove_all(folder);
}
