#include "coupling/pipe_flow.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/case_tables.hpp"
#include "base/error.hpp"
#include "parallel/sum.hpp"
#include "solver/fields/flow.hpp"

namespace snag {

namespace {

Vec3 unit_of(const Vec3& v, const char* key) {
  if (norm(v) > 0) return unit(v);
  throw Error(ExitCode::usage, std::string("[pipe_flow] ") + key + " is the zero vector; give a direction");
}

// The power law over its mean speed is (1 + m)(2 + m)/2 (1 - r/R)^m, m = 1/7.
constexpr double power = 1.0 / 7, axis_excess = (1 + power) * (2 + power) / 2 - 1;

/// Its mode over U, 1 on the axis; `share`: r/R, beyond the wall as at it.
double power_law_mode(double share) { return ((1 + axis_excess) * std::pow(std::max(0.0, 1 - share), power) - 1) / axis_excess; }

}  // namespace

double PipeFlow::largest_share() const {
  return std::abs(swirl) + std::abs(profile) + std::abs(profile_power_law * power_law_mode(1)) + std::abs(vortices);
}

Section PipeFlow::section() {
  const auto strength = [](const char* key, double* target, const char* meaning) {
    return Parameter{key, target, "1", -10, 10, Basis::assumed, meaning};
  };
  Parameter pipe_radius{"radius", &radius, "m", 1e-6, 100, Basis::assumed, "Inner radius of the pipe."};
  pipe_radius.required = true;
  return {
      "pipe_flow",
      "A pipe, and what its water does beyond the flow of the case: of a prescribed flow, or of one that stands frozen. A diagnosis may "
      "find each missing.",
      {{"point", &point, "m", -1e3, 1e3, Basis::assumed, "Point of the axis; behind it the pipe is straight."},
       {"axis", &axis, "1", -1e3, 1e3, Basis::assumed, "Direction of the flow there, a vector of any length."},
       pipe_radius,
       {"bend_radius", &bend_radius, "m", 0, 1e3, Basis::assumed, "Radius of the axis of a bend that ends at the point; 0: no bend."},
       {"bend_angle", &bend_angle, "rad", 0, std::numbers::pi, Basis::assumed, "Angle of the bend; before it the pipe is straight."},
       {"bend_inside", &bend_inside, "1", -1e3, 1e3, Basis::assumed,
        "Direction from the point to the centre of the bend, across the axis."},
       strength("swirl", &swirl,
                "Speed about the axis at the wall over the mean speed, right-handed about the flow: a solid rotation in addition to the "
                "flow. 0.1 is a swirl angle of 5.7 degrees."),
       strength("profile", &profile,
                "Share of the parabola that is added to the profile at the same flow rate: 1 makes Poiseuille's flow of a flat "
                "profile, and twice the mean speed on its axis; below 0 the flow is flatter."),
       strength("profile_power_law", &profile_power_law,
                "Speed on the axis over the mean speed, less 1, of what is added of the power law of 1/7 at the same flow rate: 0.2245 "
                "makes that profile, of developed turbulent flow, of a flat one."),
       strength("vortices", &vortices,
                "Speed of the pair of vortices of the bend on the axis, towards the outside of the bend, over the mean speed.")}};
}
const bool pipe_flow_table = add_case_table<PipeFlow>(122);

void PipeFlow::prepare() {
  const auto refuse = [](const std::string& what) { throw Error(ExitCode::usage, "[pipe_flow] " + what); };
  if (!is_there()) refuse("needs the radius of the pipe");
  axis = unit_of(axis, "axis");
  if ((bend_angle > 0) != (bend_radius > 0)) refuse("has one of bend_radius and bend_angle; give both, or neither for a straight pipe");
  if (has_bend() && bend_radius <= radius) refuse("bend_radius is not larger than radius: the bend would meet itself");
  if (!has_bend() && vortices != 0) refuse("vortices without a bend; give bend_radius_mm and bend_angle_deg");
  bend_inside = unit_of(bend_inside - dot(bend_inside, axis) * axis, "bend_inside across the axis");
}

PipeFlow::Place PipeFlow::place(const Vec3& x) const {
  const Vec3 from_point = x - point;
  const double behind = dot(from_point, axis);
  const Vec3 offset = from_point - behind * axis;
  // Beside a pipe that turns back lies the part of it before the bend.
  if (!has_bend() || (behind >= 0 && norm(offset) < bend_radius))
    return {.tangent = axis, .inside = bend_inside, .offset = offset, .grown = has_bend() ? 1.0 : 0.0};
  const Vec3 centre = point + bend_radius * bend_inside, from_centre = x - centre;
  const double out = -dot(from_centre, bend_inside), back = -dot(from_centre, axis);
  const double angle = std::atan2(back, out), turned = angle < 0 ? angle + 2 * std::numbers::pi : angle;  // against the flow from the point
  const double here = std::min(turned, bend_angle), c = std::cos(here), s = std::sin(here);
  Place at{.tangent = c * axis - s * bend_inside, .inside = c * bend_inside + s * axis, .offset = {}};
  const Vec3 from_section = x - (centre - bend_radius * at.inside);
  at.offset = from_section - dot(from_section, at.tangent) * at.tangent;
  if (turned < bend_angle) {
    at.stretch = 1 - dot(at.offset, at.inside) / bend_radius;
    at.grown = 1 - turned / bend_angle, at.is_straight = false;
  }
  return at;
}

Vec3 PipeFlow::modes(const Place& at, double speed) const {
  const Vec3 &t = at.tangent, &o = at.offset, b = cross(t, at.inside);
  const double R2 = radius * radius, rest = 1 - norm_squared(o) / R2, along_b = dot(o, b), along_c = dot(o, at.inside);
  // psi by o.c and o.b; rot(psi t) = (dpsi/db) c - (dpsi/dc) b, for b = t x c.
  const double A = -vortices * at.grown * speed;
  const double by_b = A * (rest * rest - 4 * along_b * along_b * rest / R2), by_c = -4 * A * along_b * along_c * rest / R2;
  const Vec3 in_section = (swirl * speed / radius) * cross(t, o) + by_b * at.inside - by_c * b;
  const double of_power_law = profile_power_law == 0 ? 0 : profile_power_law * power_law_mode(norm(o) / radius);
  const double along = profile * (2 * rest - 1) + of_power_law;
  return (1 / at.stretch) * in_section + speed * along * t;
}

Vec3 PipeFlow::velocity(const Vec3& x, double speed) const {
  const Place at = place(x);
  return norm_squared(at.offset) > radius * radius ? Vec3{} : modes(at, speed);
}

Mat3 PipeFlow::gradient(const Vec3& x, double speed) const {
  const Place at = place(x);
  Mat3 G{};
  if (norm_squared(at.offset) > radius * radius) return G;
  const double step = 1e-4 * radius;
  for (int j = 0; j < 3; ++j) {
    Vec3 before = x, after = x;
    before[j] -= step, after[j] += step;
    const Vec3 change = modes(place(after), speed) - modes(place(before), speed);
    for (int i = 0; i < 3; ++i) G[i][j] = change[i] / (2 * step);
  }
  return G;
}

std::optional<Vec3> PipeFlow::straight_direction(const Vec3& x) const {
  const Place at = place(x);
  if (!at.is_straight || norm_squared(at.offset) > radius * radius) return {};
  return at.tangent;
}

void add_pipe_flow(Flow& flow, const PipeFlow& pipe) {
  if (!pipe.changes_water()) return;
  const Mesh& mesh = flow.mesh;
  std::vector<double> fluxes, volumes;  // m4/s, m3
  for (int c = 0; c < mesh.n_cells; ++c) {
    const auto along = pipe.straight_direction(mesh.cell_centre[c]);
    if (!along) continue;
    fluxes.push_back(mesh.cell_volume[c] * dot(*along, flow.velocity[c])), volumes.push_back(mesh.cell_volume[c]);
  }
  const double volume = sum(mesh.comm, std::span<const double>(volumes));
  if (volume <= 0) throw Error(ExitCode::usage, "[pipe_flow]: no cell of the mesh is in its straight parts; check point, axis and radius");
  const double speed = sum(mesh.comm, std::span<const double>(fluxes)) / volume;
  for (int c = 0; c < mesh.n_all_cells(); ++c) {
    const Vec3 u = flow.velocity[c], more = pipe.velocity(mesh.cell_centre[c], speed);
    const Mat3 G = flow.velocity_gradient[c], more_G = pipe.gradient(mesh.cell_centre[c], speed);
    flow.velocity[c] = u + more;
    flow.pressure_gradient[c] -= flow.density * (G * more + more_G * (u + more));
    for (int i = 0; i < 3; ++i) flow.velocity_gradient[c][i] += more_G[i];
  }
  for (int f = 0; f < mesh.n_faces; ++f) flow.flux[f] += dot(pipe.velocity(mesh.face_centre[f], speed), mesh.face_vector[f]);
}

}  // namespace snag
