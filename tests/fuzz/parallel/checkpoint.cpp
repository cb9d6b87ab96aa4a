// A slot of a checkpoint, damaged: never a value that was not written.
#include <unistd.h>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "parallel/checkpoint.hpp"
#include "tests/fuzz/target.hpp"

namespace {

using namespace snag;

const std::vector<std::int64_t> ids{4, 7, 9};
const std::vector<double> values{1, 2, 3};
const std::string hash = "5d41402abc4b2a76";

std::filesystem::path folder() { return std::filesystem::temp_directory_path() / ("snag_slots_" + std::to_string(getpid())); }

std::string slot() {
  std::filesystem::create_directories(folder());
  {
    CheckpointWriter writer(MPI_COMM_SELF, folder(), {hash, 1, 12, 0.5});
    writer.rows("flow/pressure", ids, values, 1);
    writer.shared("clock", std::vector<double>{0.5});
    writer.text("poses", "flat");
    writer.finish();
  }
  std::string content = file_text(folder() / "slot_a.h5").value_or("");
  std::filesystem::remove_all(folder());
  return content;
}

void read(const std::filesystem::path& file) {
  std::filesystem::create_directories(folder());
  std::filesystem::copy_file(file, folder() / "slot_a.h5", std::filesystem::copy_options::overwrite_existing);
  CheckpointReader reader(MPI_COMM_SELF, folder());
  const CheckpointStamp stamp = reader.stamp();
  const bool is_as_written = stamp.case_sha256 == hash && stamp.ranks == 1 && stamp.time_step == 12 && stamp.time == 0.5 &&
                             reader.rows("flow/pressure", ids, 1) == values && reader.shared("clock") == std::vector<double>{0.5} &&
                             reader.text("poses") == "flat";
  if (!is_as_written) throw std::logic_error("a damaged checkpoint was read as if it were sound");
}

const fuzz::Registration checkpoint({"checkpoint", ".h5", [] { return std::vector{slot()}; }, read});

}  // namespace
