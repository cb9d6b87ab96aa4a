#pragma once
// Checkpoints: HDF5, two alternating slots, valid only when complete. A run resumes from the newest valid slot on any number of ranks.
//
//   DIR/slot_a.h5, DIR/slot_b.h5     root attributes: case_sha256, ranks, time_step, time_s, date, version, sequence (counts the
//                                    checkpoints of the folder: the newest is the one written last); at the end a checksum of all bytes,
//                                    written last
// Arrays are stored rank by rank (each rank its rows, in rank order) beside the ids of the rows and a checksum, so that on the same ranks
//   with the same ids every value returns to its place to the bit, and on others it is sent to the rank that asks for its id.
#include <mpi.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace snag {

struct CheckpointStamp {
  std::string case_sha256;  // of all but what a resumed run may change
  int ranks = 1;
  std::int64_t time_step = 0;
  double time = 0;  // s
};

class CheckpointWriter {
 public:
  /// Opens the slot that does not hold the newest valid checkpoint of `folder`. Collective; throws Error(io).
  CheckpointWriter(MPI_Comm comm, const std::filesystem::path& folder, const CheckpointStamp& stamp);
  ~CheckpointWriter();
  /// Rows with ids: `values` has components values per id. `name` such as "flow/velocity". Collective.
  void rows(const std::string& name, std::span<const std::int64_t> ids, std::span<const double> values, int components);
  void rows(const std::string& name, std::span<const std::int64_t> ids, std::span<const std::int64_t> values, int components);
  /// The same small array on every rank; rank 0's is written. Collective.
  void shared(const std::string& name, std::span<const double> values);
  void shared(const std::string& name, std::span<const std::int64_t> values);
  void text(const std::string& name, const std::string& value);
  /// Marks the slot complete by its checksum (flushed to disk before). A slot without it is never read. Collective.
  void finish();

 private:
  struct File;
  std::unique_ptr<File> file_;
};

class CheckpointReader {
 public:
  /// Opens the complete slot that was written last. Collective; throws Error(io) that names the folder, what is wrong with each slot
  /// (absent, incomplete, damaged) and the remedy. Whether it belongs to this case is for the caller to compare: stamp().case_sha256.
  CheckpointReader(MPI_Comm comm, const std::filesystem::path& folder);
  ~CheckpointReader();
  const CheckpointStamp& stamp() const;
  /// What is wrong with the other slot and which one is read instead, for a warning; empty if nothing is.
  const std::string& fallback() const;
  bool has(const std::string& name) const;
  /// Values of the rows with these ids, in this order. Throws Error(io) if an id is not in the file. Collective.
  std::vector<double> rows(const std::string& name, std::span<const std::int64_t> ids, int components);
  std::vector<std::int64_t> integer_rows(const std::string& name, std::span<const std::int64_t> ids, int components);
  /// Ids this rank wrote, if it has the same rank in a run on as many ranks; otherwise an equal share of all ids. Collective.
  std::vector<std::int64_t> ids(const std::string& name);
  std::vector<double> shared(const std::string& name);
  std::vector<std::int64_t> shared_integers(const std::string& name);
  std::string text(const std::string& name);

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace snag
