#include "dem/walls.hpp"

#include "base/error.hpp"
#include "base/words.hpp"

namespace snag {

std::vector<Parameter> WallSettings::parameters() {
  const auto length = [](const char* key, Vec3* target, const char* meaning) {
    return Parameter{.key = key, .target = target, .unit = "m", .meaning = meaning};
  };
  Parameter kind_of_wall = setting("kind", &kind, "What the wall is.", {"plane", "box", "patches", "stl"});
  kind_of_wall.required = true;
  return {
      kind_of_wall,
      setting("name", &name, "Name in outputs; by default the kind and the number of the wall. Patches keep their own names."),
      length("point", &point, "plane: a point of it."),
      Parameter{.key = "normal", .target = &normal, .meaning = "plane: normal into the fluid, of any length."},
      length("lower", &lower, "box: lowest corner; the fluid is inside."),
      length("upper", &upper, "box: highest corner."),
      setting("patches", &patches, "patches: names of patches of the mesh."),
      file_setting("file", &file, "stl: the file, beside the case file."),
      Parameter{.key = "scale", .target = &scale, .minimum = 1e-9, .maximum = 1e9, .meaning = "stl: metres per unit of the file."},
      setting("normals_into_fluid", &normals_into_fluid,
              "stl: its normals point into the fluid, as those of a solid body that the fluid surrounds."),
      Parameter{.key = "axis", .target = &axis, .meaning = "Axis of turning, of any length."},
      length("origin", &origin, "A point of the axis at time 0."),
      Parameter{.key = "speed", .target = &speed, .unit = "rad/s", .meaning = "Angular speed, right-handed about the axis."},
      Parameter{.key = "velocity", .target = &velocity, .unit = "m/s", .meaning = "Velocity of translation."},
  };
}

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
  parts_.push_back(name);
}

void WallSet::add_box(const std::string& name, const Vec3& lower, const Vec3& upper, const WallMotion& motion) {
  for (int d = 0; d < 3; ++d)
    if (!(lower[d] < upper[d]))
      throw Error(ExitCode::usage, "wall \"" + name + "\": lower (" + words(lower[d]) + " m) is not below upper (" + words(upper[d]) +
                                       " m) along axis " + std::to_string(d) + ", a box needs an inside; exchange or correct them");
  check_motion(name, motion);
  WallBody body{name, motion, {}, {}};
  for (int d = 0; d < 3; ++d) {
    Vec3 inward;
    inward[d] = 1;
    body.planes.push_back({lower, inward, static_cast<int>(parts_.size())});
    body.planes.push_back({upper, -inward, static_cast<int>(parts_.size())});
  }
  bodies_.push_back(std::move(body));
  parts_.push_back(name);
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
  parts_.insert(parts_.end(), surface.parts.begin(), surface.parts.end());
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

void add_wall(WallSet& walls, const WallSettings& wall, const CaseFile& file, const Mesh* mesh) {
  const WallMotion motion{wall.axis, wall.origin, wall.speed, wall.velocity};
  if (wall.kind == "plane") {
    walls.add_plane(wall.name, wall.point, wall.normal, motion);
  } else if (wall.kind == "box") {
    walls.add_box(wall.name, wall.lower, wall.upper, motion);
  } else if (wall.kind == "stl") {
    WallSurface surface = read_stl(file.path(wall.file), wall.name, wall.scale);
    if (wall.normals_into_fluid) turn_over(surface);
    walls.add_surface(wall.name, surface, motion);
  } else {
    if (!mesh)
      throw Error(ExitCode::usage,
                  "wall \"" + wall.name + "\": kind = \"patches\" without a mesh, patches are of a mesh; give [mesh] or another kind");
    walls.add_surface(wall.name, wall_surface(*mesh, wall.patches), motion);
  }
}

}  // namespace

WallSet read_walls(const CaseFile& file, const Mesh* mesh) {
  WallSet walls;
  int number = 0;
  for (const Table& table : file.root().tables("wall")) {
    WallSettings wall;
    table.read(wall.parameters());
    const auto demand = [&](const char* key, const char* kind) {
      if (wall.kind == kind && !table.has(key))
        throw Error(ExitCode::usage, table.where() + ": no " + key + ", a wall of kind \"" + kind + "\" needs it; give " + key);
    };
    demand("point", "plane"), demand("normal", "plane"), demand("lower", "box"), demand("upper", "box");
    demand("patches", "patches"), demand("file", "stl");
    if (wall.name.empty()) wall.name = wall.kind + "_" + std::to_string(number);
    add_wall(walls, wall, file, mesh);
    ++number;
  }
  return walls;
}

}  // namespace snag
