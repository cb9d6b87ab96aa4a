#include "parallel/checkpoint_slots.hpp"

#include "base/words.hpp"
#include "parallel/checkpoint_trailer.hpp"
#include "parallel/hdf5_file.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

/// The stamp of a slot that has the bytes it was written with.
CheckpointSlot inspected(const std::filesystem::path& file) {
  CheckpointSlot slot{.file = file, .state = "", .stamp = {}};
  hdf5::silence();
  const hdf5::Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access, false, true);  // shared file systems often have no locks, and nobody else writes
  const hdf5::Handle opened(H5Fopen(file.c_str(), H5F_ACC_RDONLY, access), H5Fclose);
  if (opened < 0) {
    slot.state = "no HDF5 file (" + hdf5::last_reason() + ")";
    return slot;
  }
  const auto time_step = hdf5::integer_attribute(opened, "time_step"), ranks = hdf5::integer_attribute(opened, "ranks"),
             sequence = hdf5::integer_attribute(opened, "sequence");
  const auto time = hdf5::number_attribute(opened, "time_s");
  const auto hash = hdf5::text_attribute(opened, "case_sha256");
  if (!time_step || !ranks || !sequence || !time || !hash) {
    slot.state = "not a checkpoint of Snag (attributes are missing)";
  } else {
    slot.valid = true;
    slot.sequence = *sequence;
    slot.stamp = {*hash, static_cast<int>(*ranks), *time_step, *time};
    slot.state = "complete, time step " + std::to_string(*time_step) + " at " + number_text(*time) + " s";
  }
  return slot;
}

void broadcast(MPI_Comm comm, std::string& text) {
  int length = static_cast<int>(text.size());
  MPI_Bcast(&length, 1, MPI_INT, 0, comm);
  text.resize(length);
  MPI_Bcast(text.data(), length, MPI_CHAR, 0, comm);
}

}  // namespace

std::array<CheckpointSlot, 2> checkpoint_slots(MPI_Comm comm, const std::filesystem::path& folder) {
  std::array<CheckpointSlot, 2> slots;
  const char* const names[] = {"slot_a.h5", "slot_b.h5"};
  for (int i = 0; i < 2; ++i) {
    auto& slot = slots[i];
    slot.file = folder / names[i];
    slot.state = damage_of(comm, slot.file);
    if (!slot.state.empty()) continue;
    if (rank_of(comm) == 0) slot = inspected(slot.file);
    std::int64_t numbers[] = {slot.valid, slot.sequence, slot.stamp.ranks, slot.stamp.time_step};
    MPI_Bcast(numbers, 4, MPI_INT64_T, 0, comm);
    MPI_Bcast(&slot.stamp.time, 1, MPI_DOUBLE, 0, comm);
    broadcast(comm, slot.state);
    broadcast(comm, slot.stamp.case_sha256);
    slot.valid = numbers[0] != 0;
    slot.sequence = numbers[1];
    slot.stamp.ranks = static_cast<int>(numbers[2]);
    slot.stamp.time_step = numbers[3];
  }
  return slots;
}

int newest(const std::array<CheckpointSlot, 2>& slots) {
  int best = -1;
  for (int i = 0; i < 2; ++i)
    if (slots[i].valid && (best < 0 || slots[i].sequence > slots[best].sequence)) best = i;
  return best;
}

std::string states(const std::array<CheckpointSlot, 2>& slots) {
  return slots[0].file.filename().string() + ": " + slots[0].state + "; " + slots[1].file.filename().string() + ": " + slots[1].state;
}

std::string fallback_of(const std::array<CheckpointSlot, 2>& slots) {
  const int used = newest(slots);
  if (used < 0 || slots[1 - used].valid || slots[1 - used].state == "absent") return "";
  return "checkpoint " + slots[1 - used].file.string() + ": " + slots[1 - used].state + "; " + slots[used].file.filename().string() +
         " is read instead: " + slots[used].state;
}

}  // namespace snag
