#include "simulation/output/wall_contact_output.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "dem/contacts/contact_solver.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

std::vector<Column<WallContactRecord>> wall_contact_columns(const std::vector<std::string>& parts) {
  using Record = const WallContactRecord&;
  std::vector<Column<WallContactRecord>> all{{"time", "s", [](Record r) { return r.time; }}};
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const std::string& name = parts[p];
    add_components(all, name + "_normal_force_", "", "N", [p](Record r) { return r.loads[p].normal_force; });
    add_components(all, name + "_friction_force_", "", "N", [p](Record r) { return r.loads[p].friction_force; });
    all.push_back({name + "_normal_torque", "N m", [p](Record r) { return r.loads[p].normal_torque; }});
    all.push_back({name + "_friction_torque", "N m", [p](Record r) { return r.loads[p].friction_torque; }});
    all.push_back({name + "_power", "W", [p](Record r) { return r.loads[p].power; }});
  }
  return all;
}

}  // namespace

double turns_with(const WallMotion& wall, const Shaft& shaft) {
  constexpr double tolerance = 1e-9;
  if (wall.speed == 0 || norm_squared(wall.velocity) > 0) return 0;
  const Vec3 axis = unit(wall.axis), to_shaft = shaft.origin - wall.origin;
  const double along = dot(axis, shaft.axis), offset = norm(to_shaft - dot(to_shaft, shaft.axis) * shaft.axis);
  const bool same_axis = std::abs(along) > 1 - tolerance && offset <= tolerance * (norm(shaft.origin) + norm(wall.origin));
  const double sense = along > 0 ? 1 : -1;
  return same_axis && std::abs(sense * wall.speed - shaft.speed) <= tolerance * std::abs(shaft.speed) ? sense : 0;
}

std::vector<std::string> part_names(const WallSet& walls) {
  std::vector<std::string> names;
  for (std::string part : walls.parts()) {
    std::replace_if(
        part.begin(), part.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    std::string name = part;
    for (int n = 2; std::find(names.begin(), names.end(), name) != names.end(); ++n) name = part + "_" + std::to_string(n);
    names.push_back(name);
  }
  return names;
}

WallContactOutput::WallContactOutput(const std::filesystem::path& monitors, const RagSystem& rags, const WallSet& walls, const Shaft* shaft,
                                     bool resume, double from_time) {
  for (int part = 0; part < static_cast<int>(walls.parts().size()); ++part)
    on_shaft_.push_back(shaft ? turns_with(walls.bodies()[static_cast<std::size_t>(walls.body_of(part))].motion, *shaft) : 0);
  if (walls.empty()) return;
  on_all_ranks(rags.comm(), [&] {
    if (rank_of(rags.comm()) == 0)
      file_ = Monitor<WallContactRecord>(monitors / "wall_contacts.csv", wall_contact_columns(part_names(walls)), resume, from_time);
  });
}

void WallContactOutput::after_step(RagSystem& rags, double time) {
  if (on_shaft_.empty()) return;
  const WallContactRecord record{time, rags.contacts()->wall_loads(rags.comm())};
  shaft_torque_ = 0;
  for (std::size_t part = 0; part < on_shaft_.size(); ++part) shaft_torque_ += on_shaft_[part] * record.loads[part].torque();
  if (rank_of(rags.comm()) == 0) file_.add(record);
}

}  // namespace snag
