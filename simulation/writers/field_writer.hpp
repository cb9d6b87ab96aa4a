#pragma once
// Formats of the files with fields of the water, walls and rags: one format, one file in simulation/writers/formats/, chosen by
// [output] format = "...". A data set is a VtkPiece whatever the format: points, cells and arrays in the terms of VTK.
#include <mpi.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "base/registry.hpp"
#include "base/vtk_file.hpp"

namespace snag {

/// Data sets of one kind over time.
class FieldSeries {
 public:
  virtual ~FieldSeries() = default;
  /// Writes the data set of a time, s, in place of one of that time or later. Throws Error(io).
  virtual void add(double time, std::int64_t time_step, const VtkPiece& piece) = 0;
};

/// Where a series lies, and how much of an earlier part is kept.
struct SeriesPlace {
  std::filesystem::path folder;
  std::string name;  // its files begin with it
  VtkKind kind = VtkKind::unstructured_grid;
  bool resume = false;   // keep the entries of the run before ...
  double from_time = 0;  // ... up to this time, s
};

class FieldWriter {
 public:
  virtual ~FieldWriter() = default;
  /// One sentence for the manual: the files and who reads them.
  virtual std::string meaning() const = 0;
  /// A series of which each rank writes its piece: its add() is collective.
  virtual std::unique_ptr<FieldSeries> series_of_pieces(const SeriesPlace& place, MPI_Comm comm) const = 0;
  /// A series that one rank writes.
  virtual std::unique_ptr<FieldSeries> series(const SeriesPlace& place) const = 0;
  /// A data set without a time; one rank calls it. Throws Error(io).
  virtual void write(const std::filesystem::path& folder, const std::string& name, VtkKind kind, const VtkPiece& piece) const = 0;
};

Registry<FieldWriter>& field_writers();
/// Meaning of the key `format`, with what each format is.
std::string field_format_meaning();

}  // namespace snag
