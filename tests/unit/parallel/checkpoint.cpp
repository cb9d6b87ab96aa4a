// ranks: 1 3
// long ranks: 2 5
// Checkpoints: every bit comes back on any number of ranks, and only complete, undamaged slots are ever read.
#include "parallel/checkpoint.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <limits>

#include "base/error.hpp"
#include "parallel/checkpoint_trailer.hpp"
#include "parallel/session.hpp"

namespace snag {
namespace {

constexpr std::int64_t n_ids = 1009;  // prime: ids are spread by multiplication

/// A communicator of the first n ranks of the world; null on the others.
struct FirstRanks {
  MPI_Comm comm = MPI_COMM_NULL;
  explicit FirstRanks(int n) { MPI_Comm_split(MPI_COMM_WORLD, rank_of(MPI_COMM_WORLD) < n ? 0 : MPI_UNDEFINED, 0, &comm); }
  ~FirstRanks() {
    if (comm != MPI_COMM_NULL) MPI_Comm_free(&comm);
  }
};

/// Ids of this rank, in an order of no pattern; rank 1 (where there are more than two) has none.
std::vector<std::int64_t> ids_of(MPI_Comm comm, std::int64_t stride) {
  const int size = size_of(comm), rank = rank_of(comm);
  std::vector<std::int64_t> ids;
  for (std::int64_t i = 0; i < n_ids; ++i) {
    const std::int64_t id = i * stride % n_ids;
    int owner = static_cast<int>((id / 13 + stride) % size);
    if (size > 2 && owner == 1) owner = 0;
    if (owner == rank) ids.push_back(1000000007 * id - 5);  // large numbers and a negative one
  }
  return ids;
}

/// Numbers of all kinds, each its own: ordinary, negative zero, denormal, infinite and not-a-number with the id as payload.
double odd_value(std::int64_t id, int component) {
  switch ((id + component) % 5) {
    case 0:
      return -0.0;
    case 1:
      return std::bit_cast<double>(std::uint64_t{0x7ff8000000000000} | (static_cast<std::uint64_t>(id) & 0xffffffff));
    case 2:
      return std::numeric_limits<double>::denorm_min() * static_cast<double>(id & 0xfff);
    case 3:
      return -std::numeric_limits<double>::infinity();
    default:
      return std::sin(static_cast<double>(id) + component);
  }
}

std::vector<double> odd_values(const std::vector<std::int64_t>& ids, int components) {
  std::vector<double> values;
  for (const auto id : ids)
    for (int c = 0; c < components; ++c) values.push_back(odd_value(id, c));
  return values;
}

/// Number of values whose bits differ.
int differing(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return -1;
  int n = 0;
  for (std::size_t i = 0; i < a.size(); ++i) n += std::bit_cast<std::uint64_t>(a[i]) != std::bit_cast<std::uint64_t>(b[i]);
  return n;
}

class Checkpoint : public testing::Test {
 protected:
  std::filesystem::path folder;
  int rank = rank_of(MPI_COMM_WORLD), size = size_of(MPI_COMM_WORLD);

  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "snag_checkpoint_XXXXXX").string();
    if (rank == 0) {
      ASSERT_NE(mkdtemp(name.data()), nullptr);
    }
    MPI_Bcast(name.data(), static_cast<int>(name.size()), MPI_CHAR, 0, MPI_COMM_WORLD);
    folder = name;
  }
  void TearDown() override {
    MPI_Barrier(MPI_COMM_WORLD);
    if (rank == 0) std::filesystem::remove_all(folder);
  }
  /// A checkpoint of one array on all ranks of a communicator.
  void write(std::int64_t time_step, bool finish = true, MPI_Comm comm = MPI_COMM_WORLD) {
    if (comm == MPI_COMM_NULL) return;
    CheckpointWriter writer(comm, folder, {.case_sha256 = "feed", .time_step = time_step, .time = 0.1 * static_cast<double>(time_step)});
    const auto ids = ids_of(comm, 7);
    writer.rows("flow/velocity", ids, odd_values(ids, 3), 3);
    writer.text("step", "step " + std::to_string(time_step));
    if (finish) writer.finish();
  }
  /// On rank 0 only, then all go on.
  template <class Work>
  void on_first_rank(Work work) {
    MPI_Barrier(MPI_COMM_WORLD);
    if (rank == 0) work();
    MPI_Barrier(MPI_COMM_WORLD);
  }
  std::string read_text() { return CheckpointReader(MPI_COMM_WORLD, folder).text("step"); }
  /// Message of the Error that reading throws; the same on every rank.
  template <class Work>
  std::string refusal(Work work) {
    try {
      work();
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::io);
      return error.what();
    }
    ADD_FAILURE() << "not refused";
    return "";
  }
  static bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }
};

// On the same ranks every double returns to its place to the bit: negative zero, denormals, infinities, payloads of not-a-number.
TEST_F(Checkpoint, ReturnsEveryBitOnTheSameRanks) {
  const auto ids = ids_of(MPI_COMM_WORLD, 7);
  const auto velocity = odd_values(ids, 3), pressure = odd_values(ids, 1);
  {
    CheckpointWriter writer(MPI_COMM_WORLD, folder, {.case_sha256 = "feed", .time_step = 12, .time = 1.0 / 3});
    writer.rows("flow/velocity", ids, velocity, 3);
    writer.rows("flow/pressure", ids, pressure, 1);
    writer.finish();
  }
  CheckpointReader reader(MPI_COMM_WORLD, folder);
  EXPECT_EQ(reader.stamp().case_sha256, "feed");
  EXPECT_EQ(reader.stamp().time_step, 12);
  EXPECT_EQ(reader.stamp().time, 1.0 / 3);
  EXPECT_EQ(reader.stamp().ranks, size);
  EXPECT_EQ(reader.ids("flow/pressure"), ids);
  EXPECT_EQ(differing(reader.rows("flow/velocity", ids, 3), velocity), 0);
  EXPECT_EQ(differing(reader.rows("flow/pressure", ids, 1), pressure), 0);
}

// What n ranks wrote, any other number of ranks reads by id, in any order and also several times, ranks without rows included.
TEST_F(Checkpoint, ReturnsEveryBitOnOtherRanks) {
  for (int n_writing = 1; n_writing <= size; ++n_writing) {
    const FirstRanks writing(n_writing);
    if (writing.comm != MPI_COMM_NULL) {
      CheckpointWriter writer(writing.comm, folder, {.case_sha256 = "feed", .time_step = n_writing});
      const auto ids = ids_of(writing.comm, 7);
      std::vector<std::int64_t> integers;
      for (const auto id : ids) integers.insert(integers.end(), {id, -id});
      writer.rows("flow/velocity", ids, odd_values(ids, 3), 3);
      writer.rows("flow/zone", ids, integers, 2);
      writer.rows("flow/pressure", ids, odd_values(ids, 1), 1);
      writer.finish();
    }
    MPI_Barrier(MPI_COMM_WORLD);
    CheckpointReader reader(MPI_COMM_WORLD, folder);
    EXPECT_EQ(reader.stamp().ranks, n_writing);
    auto ids = ids_of(MPI_COMM_WORLD, 101);
    if (!ids.empty()) ids.push_back(ids.front());  // two may ask for the same row
    EXPECT_EQ(differing(reader.rows("flow/velocity", ids, 3), odd_values(ids, 3)), 0) << n_writing << " ranks wrote";
    EXPECT_EQ(differing(reader.rows("flow/pressure", ids, 1), odd_values(ids, 1)), 0) << n_writing << " ranks wrote";
    const auto zone = reader.integer_rows("flow/zone", ids, 2);
    ASSERT_EQ(zone.size(), 2 * ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) EXPECT_TRUE(zone[2 * i] == ids[i] && zone[2 * i + 1] == -ids[i]);
  }
}

// Without knowing any id beforehand, a run on other ranks gets each id of the file exactly once.
TEST_F(Checkpoint, SharesOutTheIds) {
  const FirstRanks writing(1);
  write(1, true, writing.comm);
  MPI_Barrier(MPI_COMM_WORLD);
  CheckpointReader reader(MPI_COMM_WORLD, folder);
  const auto ids = reader.ids("flow/velocity");
  std::int64_t mine[2] = {static_cast<std::int64_t>(ids.size()), 0}, all[2] = {0, 0};
  for (const auto id : ids) mine[1] += id;
  MPI_Allreduce(mine, all, 2, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
  EXPECT_EQ(all[0], n_ids);
  EXPECT_EQ(all[1], 1000000007 * (n_ids * (n_ids - 1) / 2) - 5 * n_ids);
  EXPECT_LE(std::abs(mine[0] - n_ids / size), 1) << "an equal share";
  EXPECT_EQ(differing(reader.rows("flow/velocity", ids, 3), odd_values(ids, 3)), 0);
}

// Arrays that all ranks hold alike, texts, and arrays without a single row (no rag is left) come back as they were.
TEST_F(Checkpoint, KeepsSharedArraysTextsAndEmptyArrays) {
  {
    CheckpointWriter writer(MPI_COMM_WORLD, folder, {.case_sha256 = ""});
    writer.shared("rotor/angle", std::vector<double>{-0.0, 1.5});
    writer.shared("random/state", std::vector<std::int64_t>{std::numeric_limits<std::int64_t>::min(), 7});
    writer.shared("nothing", std::vector<double>{});
    writer.text("note", "Lappen \xC3\xBC \n");
    writer.text("empty", "");
    writer.rows("dem/position", std::vector<std::int64_t>{}, std::vector<double>{}, 3);
    writer.finish();
  }
  CheckpointReader reader(MPI_COMM_WORLD, folder);
  EXPECT_EQ(differing(reader.shared("rotor/angle"), {-0.0, 1.5}), 0);
  EXPECT_EQ(reader.shared_integers("random/state"), (std::vector<std::int64_t>{std::numeric_limits<std::int64_t>::min(), 7}));
  EXPECT_TRUE(reader.shared("nothing").empty());
  EXPECT_EQ(reader.text("note"), "Lappen \xC3\xBC \n");
  EXPECT_EQ(reader.text("empty"), "");
  EXPECT_TRUE(reader.ids("dem/position").empty());
  EXPECT_TRUE(reader.rows("dem/position", {}, 3).empty());
  EXPECT_EQ(reader.stamp().case_sha256, "");
  EXPECT_TRUE(reader.has("dem/position") && reader.has("note") && reader.has("rotor/angle"));
  EXPECT_FALSE(reader.has("dem/velocity"));
}

// The two slots alternate: the newest valid one is never the one that is written.
TEST_F(Checkpoint, SlotsAlternate) {
  for (int step = 1; step <= 5; ++step) {
    write(step);
    EXPECT_EQ(read_text(), "step " + std::to_string(step));
  }
  on_first_rank([&] { std::filesystem::remove(folder / "slot_a.h5"); });  // steps 1, 3, 5
  EXPECT_EQ(read_text(), "step 4");
  write(6);  // to slot a, which is free
  EXPECT_EQ(read_text(), "step 6");
  EXPECT_TRUE(std::filesystem::exists(folder / "slot_a.h5"));
}

// A run begun anew in the folder of a longer one resumes from its own checkpoint, not from the later step of the old run.
TEST_F(Checkpoint, NewestIsTheLastWritten) {
  write(1000);
  write(2000);
  write(3);
  EXPECT_EQ(read_text(), "step 3");
  write(4);
  EXPECT_EQ(read_text(), "step 4");
}

// A run that is killed while it writes leaves the last valid checkpoint the one that is read, and writes to the broken slot next.
TEST_F(Checkpoint, SurvivesAKillInTheMiddle) {
  write(1);
  write(2, false);
  EXPECT_EQ(read_text(), "step 1");
  write(3, false);
  EXPECT_EQ(read_text(), "step 1");
  {
    // What is on the disk at the moment of the kill: the file as it is while the writer has it open.
    CheckpointWriter writer(MPI_COMM_WORLD, folder, {.case_sha256 = "feed", .time_step = 4});
    const auto ids = ids_of(MPI_COMM_WORLD, 7);
    writer.rows("flow/velocity", ids, odd_values(ids, 3), 3);
    on_first_rank([&] { std::filesystem::copy_file(folder / "slot_b.h5", folder / "killed.h5"); });
  }
  on_first_rank([&] { std::filesystem::rename(folder / "killed.h5", folder / "slot_b.h5"); });
  EXPECT_EQ(read_text(), "step 1");
  write(5);
  EXPECT_EQ(read_text(), "step 5");
}

// A file cut short anywhere, or no HDF5 at all, is not valid; the other slot is read.
TEST_F(Checkpoint, PassesOverTruncatedAndForeignFiles) {
  write(1);
  write(2);
  const auto damaged = folder / "slot_b.h5";
  const auto length = static_cast<std::int64_t>(std::filesystem::file_size(damaged));
  for (const std::int64_t left : {length - 1, length / 2, std::int64_t{96}, std::int64_t{0}}) {
    on_first_rank([&] { std::filesystem::resize_file(damaged, static_cast<std::uintmax_t>(left)); });
    EXPECT_EQ(read_text(), "step 1") << left << " bytes left";
  }
  on_first_rank([&] { std::ofstream(damaged) << "not a checkpoint"; });
  EXPECT_EQ(read_text(), "step 1");
  write(3);
  EXPECT_EQ(read_text(), "step 3");
}

// With no valid slot the error names the folder, what is wrong with each slot and what to do, on every rank.
TEST_F(Checkpoint, SaysWhatIsWrongWithBothSlots) {
  const auto empty = refusal([&] { CheckpointReader(MPI_COMM_WORLD, folder); });
  EXPECT_TRUE(holds(empty, folder.string()) && holds(empty, "slot_a.h5: absent; slot_b.h5: absent") && holds(empty, "--resume")) << empty;
  write(1);
  write(2, false);
  on_first_rank([&] { std::filesystem::resize_file(folder / "slot_a.h5", 3000); });
  const auto both = refusal([&] { CheckpointReader(MPI_COMM_WORLD, folder); });
  EXPECT_TRUE(holds(both, "slot_a.h5: incomplete") && holds(both, "slot_b.h5: incomplete")) << both;
}

// Any bit of a slot that a disk has spoilt is found, also in the stamp, in the tables of HDF5 and in the checksum: the other slot is read,
// and a warning names both.
TEST_F(Checkpoint, FindsEverySpoiltBit) {
  write(1);
  write(2);
  const auto spoilt = folder / "slot_b.h5";
  EXPECT_EQ(CheckpointReader(MPI_COMM_WORLD, folder).fallback(), "");
  const auto length = static_cast<std::int64_t>(std::filesystem::file_size(spoilt));
  const auto flip = [&](std::int64_t byte, int bit) {
    on_first_rank([&] {
      std::fstream file(spoilt, std::ios::in | std::ios::out | std::ios::binary);
      const int value = file.seekg(byte).get();
      file.seekp(byte).put(static_cast<char>(value ^ (1 << bit)));
    });
  };
  // The head with the stamp, the checksum at the end, and a sample of the rest.
  for (std::int64_t byte = 0; byte < length; byte += byte < 2048 ? 31 : byte > length - 64 ? 1 : length / 67) {
    const int bit = static_cast<int>(byte % 8);
    flip(byte, bit);
    CheckpointReader reader(MPI_COMM_WORLD, folder);
    EXPECT_EQ(reader.stamp().time_step, 1) << "bit " << bit << " of byte " << byte;
    EXPECT_TRUE(holds(reader.fallback(), "slot_b.h5") && holds(reader.fallback(), "slot_a.h5 is read instead") &&
                holds(reader.fallback(), "time step 1 at 0.1 s"))
        << reader.fallback();
    flip(byte, bit);
  }
  EXPECT_EQ(read_text(), "step 2") << "every bit is as it was";
  flip(length / 2, 3);
  write(3);  // to the spoilt slot
  EXPECT_EQ(CheckpointReader(MPI_COMM_WORLD, folder).fallback(), "");
  EXPECT_EQ(read_text(), "step 3");
}

// A number that got wrong on its way to the file, so that the trailer was written for it, is found by the checksum of its array, on the
// ranks that wrote it and on others.
TEST_F(Checkpoint, FindsSpoiltNumbers) {
  const double marker = 123456.789012345678;
  for (const int n_writing : {size, 1}) {
    const FirstRanks writing(n_writing);
    if (writing.comm != MPI_COMM_NULL) {
      CheckpointWriter writer(writing.comm, folder, {.case_sha256 = "feed"});
      const std::vector<std::int64_t> ids = {rank_of(writing.comm)};
      writer.rows("dem/position", ids, std::vector<double>{marker}, 1);
      writer.finish();
    }
    on_first_rank([&] {
      for (const char* name : {"slot_a.h5", "slot_b.h5"}) {
        std::fstream file(folder / name, std::ios::in | std::ios::out | std::ios::binary);
        const std::string content{std::istreambuf_iterator<char>(file), {}};
        const auto at = content.find(std::string(reinterpret_cast<const char*>(&marker), sizeof marker));
        if (at == std::string::npos) continue;
        file.clear();
        file.seekp(static_cast<std::streamoff>(at) + 3).put('\x5a');
        file.close();
        std::filesystem::resize_file(folder / name, content.rfind("\nsnag checkpoint: "));
        append_trailer(MPI_COMM_SELF, folder / name);
      }
    });
    CheckpointReader reader(MPI_COMM_WORLD, folder);
    std::vector<std::int64_t> ids;
    if (rank < n_writing) ids = {rank};
    const auto message = refusal([&] { reader.rows("dem/position", ids, 1); });
    EXPECT_TRUE(holds(message, "dem/position") && holds(message, "checksum")) << message;
  }
}

// An id that is not in the file, one written twice, an array that is not there, other components or kinds of numbers: errors on every rank.
TEST_F(Checkpoint, RefusesWhatDoesNotFit) {
  const auto ids = ids_of(MPI_COMM_WORLD, 7);
  {
    CheckpointWriter writer(MPI_COMM_WORLD, folder, {.case_sha256 = "feed"});
    writer.rows("flow/velocity", ids, odd_values(ids, 3), 3);
    EXPECT_TRUE(holds(refusal([&] {
                        writer.rows("bad", std::vector<std::int64_t>{3, 3}, std::vector<double>(2), 1);
                      }),
                      "id 3 occurs twice"));
    // One rank alone is wrong; all are told.
    const std::vector<double> values(ids.size() + (rank == size - 1 ? 1 : 0));
    EXPECT_TRUE(holds(refusal([&] { writer.rows("bad", ids, values, 1); }), "one row per id"));
    writer.finish();
  }
  CheckpointReader reader(MPI_COMM_WORLD, folder);
  auto strange = ids;
  if (rank == size - 1) strange.push_back(77);
  EXPECT_TRUE(holds(refusal([&] { reader.rows("flow/velocity", strange, 3); }), "no row with id 77"));
  EXPECT_TRUE(holds(refusal([&] { reader.rows("flow/pressure", ids, 1); }), "rows/flow/velocity"));
  EXPECT_TRUE(holds(refusal([&] { reader.rows("flow/velocity", ids, 1); }), "3 components"));
  EXPECT_TRUE(holds(refusal([&] { reader.integer_rows("flow/velocity", ids, 3); }), "integers"));
  EXPECT_EQ(differing(reader.rows("flow/velocity", ids, 3), odd_values(ids, 3)), 0) << "still usable after a refusal";
}

// A folder that cannot be made is an input/output error on every rank.
TEST_F(Checkpoint, ReportsAFolderThatCannotBeMade) {
  on_first_rank([&] { std::ofstream(folder / "file") << "x"; });
  const auto message = refusal([&] { CheckpointWriter(MPI_COMM_WORLD, folder / "file" / "checkpoint", {.case_sha256 = ""}); });
  EXPECT_TRUE(holds(message, "--out")) << message;
}

}  // namespace
}  // namespace snag
