#pragma once
// Forces and torques of the rags on the walls, monitors/wall_contacts.csv: a group of columns for each part of the walls, means over the
// step.
#include <filesystem>
#include <vector>

#include "base/monitor.hpp"
#include "base/shaft.hpp"
#include "dem/contacts/wall_loads.hpp"
#include "dem/rag_system.hpp"
#include "dem/walls/walls.hpp"

namespace snag {

struct WallContactRecord {
  double time = 0;  // s
  std::vector<WallLoad> loads;
};

class WallContactOutput {
 public:
  /// `shaft`: at full speed; null without a rotor. Writes nothing without walls. Rank 0 writes; collective; throws Error(io).
  WallContactOutput(const std::filesystem::path& monitors, const RagSystem& rags, const WallSet& walls, const Shaft* shaft, bool resume,
                    double from_time);
  /// The step just done. Collective.
  void after_step(RagSystem& rags, double time);
  /// Of the rags on all walls that turn with the shaft, about its axis, mean over the last step, N m.
  double shaft_torque() const { return shaft_torque_; }
  const Series& series() const { return file_.series(); }

 private:
  Monitor<WallContactRecord> file_;  // open on rank 0
  std::vector<double> on_shaft_;     // [parts] 1 or -1 where the wall turns with the shaft about an axis along or against its own, else 0
  double shaft_torque_ = 0;
};

/// 1 if a wall turns with the shaft, about an axis of the same sense, -1 of the opposite sense; 0: it does not.
double turns_with(const WallMotion& wall, const Shaft& shaft);

/// Names of the parts for columns, letters and digits only, each once: the second "floor" is "floor_2".
std::vector<std::string> part_names(const WallSet& walls);

}  // namespace snag
