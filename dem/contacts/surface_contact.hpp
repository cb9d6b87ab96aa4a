#pragma once
// Contact of two pieces of cloth as surfaces, of which their particles are the nodes.
//
// A particle i carries the lattice directions a, b. Seen from it, a point at x_i + d lies at the place (d.a, d.b); on a side on which it
// has no bond the cloth ends, and the place is taken to be zero there. So the surface is a plane inside the cloth, a half round at an edge,
// along a fibre a round rod, and round a single particle a sphere:
//
//   xi = d.a or 0,  eta = d.b or 0,  g = d - xi a - eta b,  s = |g|          distance of the point from the surface of i
//   h = (1 - |xi|/2 r)+ (1 - |eta|/2 r)+                                      share of the particle i in it
//
// Over the particles of a flat lattice h sums to 1 and h (xi, eta) to 0, wherever the point lies: a point on cloth is carried by the nodes
// around it as by a bilinear finite element, and slides over them without feeling them. That is so where the cloth is flat over a bond; the
// plane of one particle says nothing of cloth that bends away. So layers touch as surfaces with the share chi, which falls from 1 to 0 as
// the angle between them grows, and otherwise as spheres. There are three views, 1 as seen from 2, 2 as seen from 1, and two spheres:
//
//   overlaps o_k = (l_1 + l_2 - s_k)+,  g_1 = chi h_1 o_1,  g_2 = chi h_2 o_2,  g_0 = 2 (1 - chi) o_0,  n_k from 1 to 2,  N = sum g_k n_k
//   n = N/|N|,  overlap = sum g_k o_k / sum g_k,  weight = |N|/(2 overlap),  contact point = sum g_k c_k / sum g_k
//
// with c_k at the share l_i/(l_1 + l_2) of s_k from the particle that is seen. For a linear spring that is the mean of the forces; it is
// continuous as any view begins. Two single particles touch as spheres, with weight 1.
#include <algorithm>
#include <cmath>

#include "base/vec3.hpp"
#include "dem/contacts/contact_pair.hpp"

namespace snag {

/// Lattice directions of a particle, and on which sides its cloth goes on.
struct alignas(64) ParticleSurface {
  Vec3 a, b;  // unit, perpendicular
  // [2] how far the surface reaches against and along each direction: 1 or 0
  float a_side[2] = {0, 0}, b_side[2] = {0, 0};
  Vec3 normal;  // a x b
  bool has_a() const { return a_side[0] + a_side[1] > 0; }
  bool has_b() const { return b_side[0] + b_side[1] > 0; }
};

/// Where particles 1 and 2 touch; weight 0: nowhere.
struct SurfaceContact {
  double weight = 0, overlap = 0;  // 1, m
  Vec3 normal;                     // unit, from 1 to 2
  Vec3 arm_1, arm_2;               // from the centres to the contact point, m
};

namespace surface_contact {

// Cosines of the angle between two surfaces at which chi begins and is 1: 37 and 18 degrees, by choice. Where the layers of a crumpled
// sheet met at more, their planes passed through each other.
inline constexpr double least_parallelism = 0.8, full_parallelism = 0.95;
inline constexpr double least_weight = 1e-9;  // above the round-off of 1 - |xi|/2 r

/// A point as seen from a particle.
struct View {
  Vec3 gap;          // from the surface to the point, m
  double share = 0;  // h
};

inline View view(const ParticleSurface& surface, const Vec3& d, double radius) {
  const double x = dot(d, surface.a), y = dot(d, surface.b);
  const double xi = surface.a_side[x > 0] * x, eta = surface.b_side[y > 0] * y, per_width = 0.5 / radius;
  return {d - xi * surface.a - eta * surface.b, std::max(1 - std::abs(xi) * per_width, 0.0) * std::max(1 - std::abs(eta) * per_width, 0.0)};
}

/// Of spheres whose centres are `d` apart.
inline SurfaceContact between_points(const Vec3& d, const ContactPair& pair) {
  const double distance = std::sqrt(norm_squared(d) + smallest_square);
  if (!(distance < pair.reach)) return {};
  return {1, pair.reach - distance, (1 / distance) * d, pair.share_1 * d, -pair.share_2 * d};
}

/// Cosine of the largest angle between the tangents of two surfaces: 1 of parallel ones, and where one of them is a single particle.
inline double parallelism(const ParticleSurface& one, const ParticleSurface& two) {
  const bool a_1 = one.has_a(), b_1 = one.has_b(), a_2 = two.has_a(), b_2 = two.has_b();
  if (a_1 && b_1 && a_2 && b_2) return std::abs(dot(one.normal, two.normal));
  if (!(a_1 || b_1) || !(a_2 || b_2)) return 1;
  const Vec3 t_1 = a_1 ? one.a : one.b, t_2 = a_2 ? two.a : two.b;
  if (a_1 && b_1) return norm(cross(t_2, one.normal));
  if (a_2 && b_2) return norm(cross(t_1, two.normal));
  return std::abs(dot(t_1, t_2));
}

/// `d`: from 1 to 2, m.
inline SurfaceContact between(const ParticleSurface& one, const ParticleSurface& two, const Vec3& d, const ContactPair& pair) {
  const View of_1 = view(two, -d, pair.radius_2), of_2 = view(one, d, pair.radius_1);  // of particle 1 from 2, of particle 2 from 1
  const double reach_squared = pair.reach * pair.reach, d_squared = norm_squared(d);
  if (!(d_squared < reach_squared) && !(of_1.share > 0 && norm_squared(of_1.gap) < reach_squared) &&
      !(of_2.share > 0 && norm_squared(of_2.gap) < reach_squared))
    return {};
  const double p = std::clamp((parallelism(one, two) - least_parallelism) / (full_parallelism - least_parallelism), 0.0, 1.0);
  const double as_surfaces = p * p * (3 - 2 * p);
  const double s_0 = std::sqrt(d_squared + smallest_square), s_1 = std::sqrt(norm_squared(of_1.gap) + smallest_square),
               s_2 = std::sqrt(norm_squared(of_2.gap) + smallest_square);
  const double overlap_0 = std::max(pair.reach - s_0, 0.0), overlap_1 = std::max(pair.reach - s_1, 0.0),
               overlap_2 = std::max(pair.reach - s_2, 0.0);
  const double g_0 = 2 * (1 - as_surfaces) * overlap_0, g_1 = as_surfaces * of_1.share * overlap_1,
               g_2 = as_surfaces * of_2.share * overlap_2, sum = g_0 + g_1 + g_2;
  if (!(sum > 0)) return {};
  const Vec3 N = (g_0 / s_0) * d - (g_1 / s_1) * of_1.gap + (g_2 / s_2) * of_2.gap;
  const double length = std::sqrt(norm_squared(N) + smallest_square);
  SurfaceContact contact;
  contact.overlap = (g_0 * overlap_0 + g_1 * overlap_1 + g_2 * overlap_2) / sum;
  contact.weight = 0.5 * length / contact.overlap;
  if (!(contact.weight > least_weight)) return {};
  contact.normal = (1 / length) * N;
  contact.arm_1 = (1 / sum) * (g_0 * pair.share_1 * d - g_1 * pair.share_1 * of_1.gap + g_2 * (d - pair.share_2 * of_2.gap));
  contact.arm_2 = contact.arm_1 - d;
  return contact;
}

}  // namespace surface_contact
}  // namespace snag
