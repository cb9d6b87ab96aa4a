#pragma once
// The two slots of a checkpoint folder: what each holds, and which is the newest that is valid.
#include <array>
#include <filesystem>
#include <string>

#include "parallel/checkpoint.hpp"

namespace snag {

struct CheckpointSlot {
  std::filesystem::path file;
  bool valid = false;
  std::string state;           // "complete, time step 120 at 0.12 s" or what is wrong with it
  std::int64_t sequence = -1;  // counts the checkpoints written to the folder: also a run begun anew is newer than what it found
  CheckpointStamp stamp;
};

/// Slots a and b of a folder, read in full to verify them. Collective; never throws for a bad slot.
std::array<CheckpointSlot, 2> checkpoint_slots(MPI_Comm comm, const std::filesystem::path& folder);
/// Index of the newest valid slot, or -1.
int newest(const std::array<CheckpointSlot, 2>& slots);
/// "slot_a.h5: absent; slot_b.h5: incomplete: ...".
std::string states(const std::array<CheckpointSlot, 2>& slots);
/// What is wrong with one slot and which is read instead; empty if both are valid, or one was never written.
std::string fallback_of(const std::array<CheckpointSlot, 2>& slots);

}  // namespace snag
