#pragma once
// Distance and direction of the nearest wall of each particle: planes and boxes at any distance, triangles within 10 diameters.
#include <limits>
#include <unordered_map>

#include "coupling/fluid_force.hpp"
#include "coupling/near_triangles.hpp"
#include "dem/walls/walls.hpp"

namespace snag {

class NearestWall {
 public:
  /// `walls` must outlive this.
  NearestWall(const WallSet& walls, const std::vector<Rag>& rags);
  /// For the places of the particles at this time: distance of the centre, m (1e9: none near; negative beyond the wall), and unit normal
  /// from the wall to the particle.
  void find(const Particles& particles, double time, double* distance, const VectorSum& normal) const;

 private:
  void find_plane(const Particles& particles, const WallPlane& plane, const WallPose& pose, double* distance,
                  const VectorSum& normal) const;
  void find_triangle(const Particles& particles, std::size_t body, const WallPose& pose, double* distance, const VectorSum& normal) const;

  /// Candidates that were found for a place in the frame of the wall, and hold for all places within the skin of it, whosever they are.
  struct Known {
    Vec3 place{std::numeric_limits<double>::infinity(), 0, 0};
    std::vector<int> triangles;
  };
  struct Surface {
    NearTriangles triangles;
    std::unordered_map<const Tile*, std::vector<Known>> known;  // by place of the tile
  };

  const WallSet& walls_;
  double reach_ = 0;                                           // m
  mutable std::unordered_map<std::size_t, Surface> surfaces_;  // of the bodies with triangles
};

}  // namespace snag
