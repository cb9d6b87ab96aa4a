#pragma once
// Walls that particles touch: planes, boxes and triangle surfaces, at rest, turning about an axis or translating.
//
// A wall is kept in its own frame, that of time 0. A point X of it is at time t at
//   x = o + V t + R(n, Omega t) (X - o),      its velocity is  u = V + Omega n x (x - o - V t)
// with R the rotation about the unit axis n by the angle Omega t (less in a ramp: dem/walls/wall_motion.cpp), o a point of the axis, V the
// translation velocity: evaluated from t, so no error accumulates.
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/case_file.hpp"
#include "base/parameter.hpp"
#include "base/vec3.hpp"
#include "dem/walls/wall_motion.hpp"
#include "mesh/wall_surface.hpp"

namespace snag {

/// One [[wall]] of the case file.
struct WallSettings {
  std::string name;  // default: kind and number
  enum class Kind { plane, box, patches, stl };
  Choice<Kind> kind{Kind::patches, {"plane", "box", "patches", "stl"}};
  Vec3 point, normal;                // plane: normal points INTO the fluid
  Vec3 lower, upper;                 // box: the fluid is inside
  std::vector<std::string> patches;  // patches of the mesh
  std::string file;                  // STL, relative to the case file
  double scale = 1;                  // of the STL's lengths to metres
  bool normals_into_fluid = false;   // of the STL: true where its normals point out of a solid body that the fluid surrounds
  Vec3 axis{0, 0, 1}, origin;
  double speed = 0;  // rad/s, right-handed about axis
  double ramp = 0;   // s
  Vec3 velocity;     // m/s
  bool stationary = false;

  Section section();
};

/// An oriented plane in the frame of its wall; `normal` is a unit vector into the fluid: the signed distance (x - point).normal is positive
/// in the fluid.
struct WallPlane {
  Vec3 point, normal;
  int part = 0;
};

/// One rigid wall: planes or triangles that move together.
struct WallBody {
  std::string name;
  WallMotion motion;
  std::vector<WallPlane> planes;
  std::vector<WallTriangle>
      triangles;  // normals OUT of the fluid (mesh/wall_surface.hpp); `part` counts within the set, node_index within the body
};

/// All walls of a run, the same on every rank.
class WallSet {
 public:
  /// `normal` into the fluid, of any length. Throws Error(usage) if it is zero.
  void add_plane(const std::string& name, const Vec3& point, const Vec3& normal, const WallMotion& motion = {});
  /// Fluid inside lower .. upper. Throws Error(usage) if it is empty.
  void add_box(const std::string& name, const Vec3& lower, const Vec3& upper, const WallMotion& motion = {});
  /// Triangles; each of the surface's parts becomes a part of the set. Throws Error(mesh) on a triangle without area.
  void add_surface(const std::string& name, const WallSurface& surface, const WallMotion& motion = {});

  const std::vector<WallBody>& bodies() const { return bodies_; }
  /// Names of the wall parts: patch names, or the wall's own name for a plane or box.
  const std::vector<std::string>& parts() const { return parts_; }
  /// The wall that a part belongs to, counted as in bodies().
  int body_of(int part) const { return body_of_[static_cast<std::size_t>(part)]; }
  bool empty() const { return bodies_.empty(); }

 private:
  void add_parts(const std::vector<std::string>& names);

  std::vector<WallBody> bodies_;
  std::vector<std::string> parts_;
  std::vector<int> body_of_;  // [parts]
};

/// The walls of a case, [[wall]]; `mesh` may be null where no wall names patches. Patches of the mesh's turning zone move as `rotor`, if
/// one is given. Collective; throws Error(usage, mesh, io).
WallSet read_walls(const CaseFile& file, const Mesh* mesh, const WallMotion* rotor = nullptr);

}  // namespace snag
