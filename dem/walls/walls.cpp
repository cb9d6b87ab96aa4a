#include "dem/walls/walls.hpp"

#include "base/case_tables.hpp"
#include "base/error.hpp"
#include "base/words.hpp"
#include "parallel/sum.hpp"

namespace snag {

Section WallSettings::section() {
  const auto length = [](const char* key, Vec3* target, const char* meaning) {
    return Parameter{.key = key, .target = target, .unit = "m", .meaning = meaning};
  };
  Parameter kind_of_wall = setting("kind", &kind, "What the wall is.");
  kind_of_wall.required = true;
  std::vector<Parameter> parameters{
      kind_of_wall,
      setting("name", &name, "Name in outputs; by default the kind and the number of the wall. Patches have their own names."),
      length("point", &point, "plane: a point of the plane."),
      Parameter{.key = "normal", .target = &normal, .meaning = "plane: normal into the fluid, a vector of any length."},
      length("lower", &lower, "box: lowest corner; the fluid is inside."),
      length("upper", &upper, "box: highest corner."),
      setting("patches", &patches, "patches: names of patches of the mesh; those of the rotating zone turn with it."),
      renamed(setting("stationary", &stationary, "patches: they stay at rest although their zone turns, as a ring around the axis may."),
              {.key = "fixed"}),
      file_setting("file", &file, "stl: the file, relative to the case file."),
      Parameter{.key = "scale", .target = &scale, .minimum = 1e-9, .maximum = 1e9, .meaning = "stl: metres per unit of the file."},
      setting("normals_into_fluid", &normals_into_fluid,
              "stl: its normals point into the fluid, as those of a solid body that the fluid surrounds."),
      Parameter{.key = "axis", .target = &axis, .meaning = "Direction of the axis of rotation, a vector of any length."},
      length("origin", &origin, "A point on the axis of rotation at time 0."),
      renamed({.key = "rotation_speed",
               .target = &speed,
               .unit = "rad/s",
               .meaning = "Speed of rotation, right-handed about the axis; \"1200 rpm\" is understood."},
              {.key = "speed"}),
      Parameter{.key = "ramp",
                .target = &ramp,
                .unit = "s",
                .minimum = 0,
                .meaning = "Time in which the speed of rotation grows linearly from zero."},
      Parameter{.key = "velocity", .target = &velocity, .unit = "m/s", .meaning = "Velocity of translation."},
  };
  return {"wall", "What particles cannot pass: planes, boxes, patches of the mesh, surfaces from STL; at rest, turning or translating.",
          std::move(parameters), true};
}
const bool wall_table = add_case_table<WallSettings>(210);

namespace {

void check_motion(const std::string& name, const WallMotion& motion) {
  if (motion.speed != 0 && norm_squared(motion.axis) == 0)
    throw Error(ExitCode::usage, "wall \"" + name + "\": axis = (0, 0, 0), a turning wall needs a direction; give axis");
}

}  // namespace

void WallSet::add_plane(const std::string& name, const Vec3& point, const Vec3& normal, const WallMotion& motion) {
  if (!(norm_squared(normal) > 0))
    throw Error(ExitCode::usage,
                "wall \"" + name + "\": normal = (0, 0, 0), a plane needs a direction; give normal, pointing into the fluid");
  check_motion(name, motion);
  bodies_.push_back({name, motion, {{point, unit(normal), static_cast<int>(parts_.size())}}, {}});
  add_parts({name});
}

void WallSet::add_box(const std::string& name, const Vec3& lower, const Vec3& upper, const WallMotion& motion) {
  for (int d = 0; d < 3; ++d)
    if (!(lower[d] < upper[d]))
      throw Error(ExitCode::usage, "wall \"" + name + "\": lower (" + number_text(lower[d]) + " m) is not below upper (" +
                                       number_text(upper[d]) + " m) along axis " + std::to_string(d) +
                                       ", a box needs an inside; exchange or correct them");
  check_motion(name, motion);
  WallBody body{name, motion, {}, {}};
  for (int d = 0; d < 3; ++d) {
    Vec3 inward;
    inward[d] = 1;
    body.planes.push_back({lower, inward, static_cast<int>(parts_.size())});
    body.planes.push_back({upper, -inward, static_cast<int>(parts_.size())});
  }
  bodies_.push_back(std::move(body));
  add_parts({name});
}

void WallSet::add_surface(const std::string& name, const WallSurface& surface, const WallMotion& motion) {
  check_motion(name, motion);
  WallBody body{name, motion, {}, surface.triangles};
  for (std::size_t t = 0; t < body.triangles.size(); ++t) {
    WallTriangle& triangle = body.triangles[t];
    const Vec3 a = triangle.node[1] - triangle.node[0], b = triangle.node[2] - triangle.node[0];
    if (!(norm(cross(a, b)) > 1e-14 * (norm_squared(a) + norm_squared(b))))
      throw Error(ExitCode::mesh, "wall \"" + name + "\": triangle " + std::to_string(t) + " of part \"" + surface.parts[triangle.part] +
                                      "\" has no area, so no normal; repair the surface");
    triangle.part += static_cast<int>(parts_.size());
  }
  bodies_.push_back(std::move(body));
  add_parts(surface.parts);
}

/// Of the last body.
void WallSet::add_parts(const std::vector<std::string>& names) {
  parts_.insert(parts_.end(), names.begin(), names.end());
  body_of_.resize(parts_.size(), static_cast<int>(bodies_.size()) - 1);
}

namespace {

/// The normals turned round: two nodes change places.
void turn_over(WallSurface& surface) {
  for (WallTriangle& t : surface.triangles) {
    std::swap(t.node[1], t.node[2]);
    std::swap(t.node_index[1], t.node_index[2]);
    t.normal = -t.normal;
  }
}

/// Whether the faces of a patch belong to the turning zone. Collective; throws Error(usage) if some do and others do not.
bool turns(const Mesh& mesh, const std::string& patch, const std::string& wall) {
  const Patch& faces = mesh.patches[static_cast<std::size_t>(mesh.patch_index(patch))];
  std::int64_t turning = 0;
  for (int f = faces.first; f < faces.end(); ++f) turning += mesh.cell_zone[mesh.owner[f]] == mesh.turning.zone;
  turning = sum(mesh.comm, turning);
  if (turning != 0 && turning != faces.count_global)
    throw Error(ExitCode::usage, "wall \"" + wall + "\": patch \"" + patch + "\" has " + std::to_string(turning) + " of its " +
                                     std::to_string(faces.count_global) +
                                     " faces in the rotating zone, must have all or none there; split it in the mesh");
  return turning != 0;
}

/// Patches that turn and patches that stand are two bodies.
void add_patches(WallSet& walls, const WallSettings& wall, const Mesh& mesh, const WallMotion& motion, const WallMotion* rotor) {
  std::vector<std::string> turning, standing;
  for (const std::string& patch : wall.patches)
    (rotor && !wall.stationary && turns(mesh, patch, wall.name) ? turning : standing).push_back(patch);
  if (!turning.empty() && motion.moves())
    throw Error(ExitCode::usage,
                "wall \"" + wall.name + "\": a motion of its own for patch \"" + turning.front() +
                    "\", which turns with the rotating zone; remove rotation_speed and velocity, or set stationary = true");
  if (!standing.empty()) walls.add_surface(wall.name, wall_surface(mesh, standing), motion);
  if (rotor && !turning.empty()) walls.add_surface(wall.name, wall_surface(mesh, turning), *rotor);
}

void add_wall(WallSet& walls, const WallSettings& wall, const CaseFile& file, const Mesh* mesh, const WallMotion* rotor) {
  const WallMotion motion{wall.axis, wall.origin, wall.speed, wall.velocity, wall.ramp};
  switch (wall.kind) {
    case WallSettings::Kind::plane:
      return walls.add_plane(wall.name, wall.point, wall.normal, motion);
    case WallSettings::Kind::box:
      return walls.add_box(wall.name, wall.lower, wall.upper, motion);
    case WallSettings::Kind::stl: {
      WallSurface surface = read_stl(file.path(wall.file), wall.name, wall.scale);
      if (wall.normals_into_fluid) turn_over(surface);
      return walls.add_surface(wall.name, surface, motion);
    }
    case WallSettings::Kind::patches:
      if (!mesh)
        throw Error(ExitCode::usage,
                    "wall \"" + wall.name + "\": kind = \"patches\" without a mesh, patches are of a mesh; give [mesh] or another kind");
      add_patches(walls, wall, *mesh, motion, rotor);
  }
}

}  // namespace

WallSet read_walls(const CaseFile& file, const Mesh* mesh, const WallMotion* rotor) {
  WallSet walls;
  int number = 0;
  for (const Table& table : file.root().tables("wall")) {
    WallSettings wall;
    table.read(wall.section().parameters);
    using Kind = WallSettings::Kind;
    const auto demand = [&](const char* key, Kind kind) {
      if (wall.kind == kind && !table.has(key))
        throw Error(ExitCode::usage, table.where() + ": no " + key + ", a wall of kind \"" + wall.kind.word() + "\" needs it; give " + key);
    };
    demand("point", Kind::plane), demand("normal", Kind::plane), demand("lower", Kind::box), demand("upper", Kind::box);
    demand("patches", Kind::patches), demand("file", Kind::stl);
    if (wall.stationary && wall.kind != Kind::patches)
      throw Error(ExitCode::usage, table.where() + ": stationary = true for a wall of kind \"" + wall.kind.word() +
                                       "\", only patches of a mesh turn by themselves; remove it");
    if (wall.name.empty()) wall.name = wall.kind.word() + "_" + std::to_string(number);
    add_wall(walls, wall, file, mesh, rotor);
    ++number;
  }
  return walls;
}

}  // namespace snag
