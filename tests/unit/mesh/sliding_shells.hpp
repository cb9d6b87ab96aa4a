#pragma once
// Two rings of hexahedra or tetrahedra with a sliding interface between them.
#include <array>
#include <cmath>
#include <numbers>

#include "mesh/sliding/sliding_interface.hpp"
#include "sample.hpp"

namespace snag::test {

/// Rotor in inner < r < radius, 0 < z < height; stator around it and above it. The interface is the cylinder r = radius and, with a lid,
/// the disc z = height, whose both rims it covers.
struct Shells {
  double inner = 0.03, radius = 0.05, outer = 0.08, height = 0.04, top = 0.06;  // m
  std::array<int, 3> rotor{14, 3, 4}, stator{17, 4, 5};                         // cells around, along r, along z
  double stator_start = 0.1;                                                    // angle of the stator's first nodes, rad
  bool tetrahedra = true, has_lid = true, is_periodic = false;                  // without a lid it may be periodic along its axis
  double stator_radius = radius;                                                // m
  Vec3 origin{}, axis{0, 0, 1};

  SlidingDescription description() const { return {.origin = origin, .axis = axis}; }
};

struct Ring {
  int zone;  // tag: 1 rotor, 2 stator
  double r0, r1, z0, z1, start;
  std::array<int, 3> n;
  std::array<int, 4> patch;  // tags of r0, r1, z0, z1
};

inline void add_quad(Sample& sample, int tag, const std::array<int, 4>& q, bool tetrahedra) {
  if (!tetrahedra) return sample.element.push_back({3, tag, {q.begin(), q.end()}});
  sample.element.push_back({2, tag, {q[0], q[1], q[2]}});  // the diagonal leads from the first corner to the third
  sample.element.push_back({2, tag, {q[0], q[2], q[3]}});
}

inline void add_ring(Sample& sample, const Ring& ring, const Shells& shells) {
  const int first = static_cast<int>(sample.node.size());
  const int n = ring.n[0], n_r = ring.n[1], n_z = ring.n[2];
  const Vec3 e3 = unit(shells.axis), e1 = unit(cross(std::abs(e3.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, e3)), e2 = cross(e3, e1);
  for (int k = 0; k <= n_z; ++k)
    for (int j = 0; j <= n_r; ++j)
      for (int i = 0; i < n; ++i) {
        const double theta = ring.start + 2 * std::numbers::pi * i / n;
        const double r = ring.r0 + (ring.r1 - ring.r0) * j / n_r, z = ring.z0 + (ring.z1 - ring.z0) * k / n_z;
        sample.node.push_back(shells.origin + r * std::cos(theta) * e1 + r * std::sin(theta) * e2 + z * e3);
      }
  const auto node = [&](int i, int j, int k) { return first + i % n + n * (j + (n_r + 1) * k); };
  for (int k = 0; k < n_z; ++k)
    for (int j = 0; j < n_r; ++j)
      for (int i = 0; i < n; ++i) {
        const std::array<int, 8> c{node(i, j, k),     node(i, j + 1, k),     node(i + 1, j + 1, k),     node(i + 1, j, k),
                                   node(i, j, k + 1), node(i, j + 1, k + 1), node(i + 1, j + 1, k + 1), node(i + 1, j, k + 1)};
        if (!shells.tetrahedra) sample.element.push_back({5, ring.zone, {c.begin(), c.end()}});
        constexpr std::array<std::array<int, 4>, 6> kuhn{
            {{0, 1, 2, 6}, {0, 3, 7, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}, {0, 7, 4, 6}, {0, 2, 3, 6}}};
        for (const auto& t : kuhn)
          if (shells.tetrahedra) sample.element.push_back({4, ring.zone, {c[t[0]], c[t[1]], c[t[2]], c[t[3]]}});
        const auto side = [&](bool is_side, int which, std::array<int, 4> corner) {
          if (is_side) add_quad(sample, ring.patch[which], {c[corner[0]], c[corner[1]], c[corner[2]], c[corner[3]]}, shells.tetrahedra);
        };
        side(j == 0, 0, {0, 3, 7, 4}), side(j == n_r - 1, 1, {1, 2, 6, 5});
        side(k == 0, 2, {0, 1, 2, 3}), side(k == n_z - 1, 3, {4, 5, 6, 7});
      }
}

inline Sample sample_of(const Shells& s) {
  Sample sample;
  sample.volumes = {{1, "rotor"}, {2, "stator"}};
  sample.surfaces = {{1, "interface_rotor"}, {2, "interface_stator"}, {3, "wall"}};
  if (s.is_periodic) sample.surfaces.insert(sample.surfaces.end(), {{4, "bottom"}, {5, "top"}});
  const int bottom = s.is_periodic ? 4 : 3, top = s.is_periodic ? 5 : 3;
  add_ring(sample, {1, s.inner, s.radius, 0, s.height, 0, s.rotor, {3, 1, bottom, s.has_lid ? 1 : top}}, s);
  add_ring(sample, {2, s.stator_radius, s.outer, 0, s.height, s.stator_start, s.stator, {2, 3, bottom, top}}, s);
  if (s.has_lid) add_ring(sample, {2, s.inner, s.radius, s.height, s.top, s.stator_start, {s.stator[0], s.stator[1], 2}, {3, 3, 2, 3}}, s);
  return sample;
}

}  // namespace snag::test
