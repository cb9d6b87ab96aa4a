#include "dem/poses/crumpled.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <sstream>

#include "base/error.hpp"
#include "base/random_numbers.hpp"
#include "base/words.hpp"
#include "dem/bonds/bond_law.hpp"
#include "dem/contacts/contact_solver.hpp"
#include "dem/particles/tile_particles.hpp"
#include "dem/poses/pipe_wall.hpp"
#include "dem/rag_measures.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

constexpr double pi = std::numbers::pi;

// The run that crumples. Walls move at a hundredth of the speed of a wave along the bonds (55 m/s): the cloth gives way by bending.
constexpr double closing_speed = 1;            // m/s, of the pipe's wall in the first attempt
constexpr int most_attempts = 4;               // each at half the closing speed of the one before
constexpr double closing_rate = 50;            // of the air while the pipe closes, 1/s
constexpr double falling_rate = 5;             // while the sheet falls, 1/s
constexpr double rest_rate = 150;              // until it is at rest, 1/s
constexpr double start_speed = 0.15;           // rms of the motion it begins with, m/s
constexpr double fastest_impact = 1;           // that the step resolves, m/s
constexpr double gravity = 9.81;               // of the hopper, m/s2
constexpr double wall_share = 0.25;            // stiffness of the wall over that of a bond
constexpr double wall_damping_ratio = 0.2;     // of a particle on the wall's spring
constexpr double step_share = 0.7;             // of the stable step, which does not know the wall's spring
constexpr double margin_over_radius = 0.3;     // by which the wall closes further, so that particles pressed into it are within
constexpr double interval = 5e-3;              // between looks at the state, s
constexpr double rest_share = 1e-2;            // kinetic energy at rest over the largest
constexpr double longest_rest = 0.5;           // s
constexpr double longest_fall = 5;             // s
constexpr double largest_volume_share = 0.35;  // of the pipe, filled by the spheres of a crumpled sheet
constexpr double largest_strain = 0.1;         // p99 of the bonds
constexpr double largest_overlap = 0.3;        // over the radius, at rest
constexpr double crushing_overlap = 1;         // over the radius, on the way

[[noreturn]] void refuse(const PosePlan& plan, const std::string& what) {
  throw Error(ExitCode::usage, plan.where + ": pose = \"" + plan.kind.word() + "\": " + what);
}

void check_plan(const RagPiece& piece) {
  const PosePlan& plan = piece.plan;
  const Rag& rag = piece.rag;
  if (norm(plan.confine_axis) == 0) refuse(plan, "confine_axis = (0, 0, 0), a pipe has a direction; give one");
  const double r = rag.radius, spheres = static_cast<double>(count_particles(piece)) * 4.0 / 3 * pi * r * r * r;
  const double length = plan.confine_length > 0 ? plan.confine_length : 2 * r * std::hypot(rag.n_columns, rag.n_rows);
  const double smallest = std::max(3 * r, std::sqrt(spheres / (largest_volume_share * pi * length)));
  if (plan.confine_radius < smallest)
    refuse(plan, "confine_radius of " + number_text(plan.confine_radius) + " m is too small for the cloth, whose spheres fill " +
                     number_text(spheres) + " m3; over a length of " + number_text(length) + " m it must be at least " +
                     number_text(smallest) + " m");
}

/// A number in [0, 1) that depends on the seed and its own number only.
double random_number(int seed, int number) {
  const std::uint64_t z = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(seed)) << 32) + static_cast<std::uint64_t>(number);
  return static_cast<double>(mixed(z * 0x9e3779b97f4a7c15) >> 11) * 0x1p-53;  // number z of splitmix64 begun at 0
}

/// Plane waves on the lattice, at most two lengths of the sheet in each direction.
class Waves {
 public:
  Waves(const Rag& rag, int seed) {
    for (int w = 0; w < n_waves; ++w) {
      const auto draw = [&](int what) { return 2 * pi * random_number(seed, 3 * w + what); };
      waves_[w] = {2 * draw(0) / rag.n_columns, (2 * draw(1) - 2 * pi) / rag.n_rows, draw(2)};
    }
  }
  /// Velocity along the normal, m/s.
  double velocity(int column, int row) const {
    double sum = 0;
    for (const Wave& w : waves_) sum += std::sin(w.per_column * column + w.per_row * row + w.phase);
    return start_speed * std::sqrt(2.0 / n_waves) * sum;
  }

 private:
  static constexpr int n_waves = 8;
  struct Wave {
    double per_column, per_row, phase;
  } waves_[n_waves];
};

/// f(place) for every particle of the flat sheet.
template <class F>
void for_places(const RagPiece& piece, const F& f) {
  for (int row = 0; row < piece.rag.n_rows; ++row)
    for (int column = 0; column < piece.rag.n_columns; ++column)
      if (piece.exists(column, row)) f(piece.pose(column, row).position);
}

/// The flat sheet at rest about the origin, or so high above it that it just does not touch the hopper; bonds hold whatever happens here.
RagPiece flat_piece(const RagPiece& given) {
  RagPiece piece = given;
  piece.insert_time = 0, piece.match_flow_velocity = false;
  piece.centre = piece.velocity = piece.spin = {};
  piece.poses.clear();
  piece.rag.breakage = false;
  if (piece.plan.kind != PosePlan::Kind::hopper) return piece;
  const Vec3 axis = unit(piece.plan.confine_axis);
  const double angle = piece.plan.hopper_angle;
  double height = -infinity;
  for_places(piece, [&](const Vec3& x) {
    const double depth = dot(x, axis), rho = norm(x - depth * axis);
    height = std::max(height, (rho + piece.rag.radius / std::cos(angle) - piece.plan.confine_radius) / std::tan(angle) + depth);
  });
  piece.centre = -height * axis;
  return piece;
}

PipeWall::Law wall_law(const Rag& rag) {
  const auto bonds = bonds_of(rag);
  const double stiffness = wall_share * std::max(bonds->coefficients(0).normal, bonds->coefficients(1).normal);
  return {stiffness, 2 * wall_damping_ratio * std::sqrt(stiffness * rag.mass), closing_rate};
}

ContactSettings contacts_of_run(const ContactSettings& given) {
  ContactSettings contacts = given;
  contacts.self_contact = true;
  contacts.impact_speed = fastest_impact;
  contacts.skin_over_radius = 0.5;  // never a result, only speed
  return contacts;
}

class Crumpling {
 public:
  /// `speed` with which the pipe closes, m/s.
  Crumpling(const RagPiece& given, const ContactSettings& contacts, double speed)
      : piece_(flat_piece(given)),
        speed_(speed),
        rags_(MPI_COMM_SELF, DemSettings{{}, step_share}, {piece_}),
        wall_(pipe(), piece_.rag, wall_law(piece_.rag)) {
    rags_.set_contacts(std::make_unique<ContactSolver>(contacts_of_run(contacts), rags_.rags(), nullptr));
    rags_.set_damping_rate(rest_rate + wall_law(piece_.rag).damping / piece_.rag.mass);
    begin();
  }
  CrumpledPose run() {
    piece_.plan.kind == PosePlan::Kind::hopper ? fall() : close();
    return result();
  }

 private:
  PipeShape pipe() const;
  void begin();
  void close();
  void fall();
  void rest();
  void advance(double dt);
  CrumpledPose result();
  [[noreturn]] void refuse_crushed(const std::string& how) const {
    refuse(piece_.plan, "the cloth is crushed: " + how +
                            "; give a larger confine_radius or confine_length, or turn the sheet's lengthwise along confine_axis");
  }
  template <class F>
  void for_all(const F& f) const {
    for (const Tile& tile : rags_.tiles()) for_particles(tile, [&](int k, int i, int j) { f(tile, k, i, j); });
  }

  RagPiece piece_;
  double speed_;  // m/s
  RagSystem rags_;
  PipeWall wall_;
  double largest_energy_ = 0, energy_ = 0;  // kinetic, J
};

/// The pipe that is asked for under a hopper, or one that just holds the flat sheet.
PipeShape Crumpling::pipe() const {
  const PosePlan& plan = piece_.plan;
  PipeShape shape{.axis = unit(plan.confine_axis), .radius = plan.confine_radius, .half_length = infinity};
  if (plan.kind == PosePlan::Kind::hopper) {
    shape.hopper_slope = std::tan(plan.hopper_angle);
    return shape;
  }
  shape.half_length = 0.5 * plan.confine_length;
  for_places(piece_, [&](const Vec3& x) {
    const double along = dot(x, shape.axis);
    shape.radius = std::max(shape.radius, norm(x - along * shape.axis) + piece_.rag.radius);
    shape.half_length = std::max(shape.half_length, std::abs(along) + piece_.rag.radius);
  });
  if (plan.confine_length <= 0) shape.half_length = infinity;
  return shape;
}

void Crumpling::begin() {
  const Waves waves(piece_.rag, piece_.plan.seed);
  const Vec3 normal = rotate(piece_.orientation, {0, 0, 1});
  for (Tile& tile : rags_.tiles())
    for_particles(tile, [&](int k, int i, int j) { tile.set_vector(Tile::vx, k, waves.velocity(tile.column + i, tile.row + j) * normal); });
}

void Crumpling::advance(double dt) {
  rags_.advance(dt, &wall_);
  energy_ = rag_states(rags_)[0].kinetic_energy;
  largest_energy_ = std::max(largest_energy_, energy_);
  const double overlap = std::max(rags_.contacts()->measures().max_overlap_over_radius, wall_.max_overlap() / piece_.rag.radius);
  if (overlap > crushing_overlap) refuse_crushed("overlap over radius of " + number_text(overlap));
  rags_.contacts()->reset_measures(), wall_.reset_overlap();
}

void Crumpling::close() {
  const double margin = margin_over_radius * piece_.rag.radius;
  PipeShape shape = wall_.shape();
  const double radius = piece_.plan.confine_radius - margin, half_length = 0.5 * piece_.plan.confine_length - margin;
  const bool has_ends = piece_.plan.confine_length > 0;
  const double way = shape.radius - radius, way_of_ends = has_ends ? std::max(0.0, shape.half_length - half_length) : 0;
  const double duration = std::max(way, way_of_ends) / speed_;
  shape.closing_speed = way / duration, shape.end_speed = way_of_ends / duration;
  wall_.set_shape(shape);
  const int n = static_cast<int>(std::ceil(duration / interval));
  for (int i = 0; i < n; ++i) advance(duration / n);
  shape.radius = radius, shape.closing_speed = shape.end_speed = 0;
  if (has_ends) shape.half_length = std::min(shape.half_length, half_length);
  wall_.set_shape(shape);
  rest();
}

void Crumpling::rest() {
  wall_.set_rate(rest_rate);
  for (double waited = 0; energy_ > rest_share * largest_energy_; waited += interval) {
    if (waited > longest_rest)
      refuse(piece_.plan, "the sheet does not come to rest in the pipe, kinetic energy " + number_text(energy_ / largest_energy_) +
                              " of the largest after " + number_text(longest_rest) + " s; give a larger confine_radius or another seed");
    advance(interval);
  }
}

void Crumpling::fall() {
  wall_.set_rate(falling_rate);
  rags_.set_gravity(gravity * wall_.shape().axis);
  for (double depth = -infinity; depth < piece_.rag.radius;) {
    if (rags_.time() > longest_fall)
      refuse(piece_.plan, "the sheet is stuck in the hopper, its last particle " + number_text(-depth) + " m above the pipe after " +
                              number_text(longest_fall) + " s; give a larger confine_radius, a smaller hopper_angle or another seed");
    advance(interval);
    depth = infinity;
    for_all([&](const Tile& tile, int k, int, int) { depth = std::min(depth, dot(tile.vector(Tile::x, k), wall_.shape().axis)); });
  }
}

CrumpledPose Crumpling::result() {
  const Vec3 axis = wall_.shape().axis;
  // Along a pipe without ends the mean comes to the centre.
  const Vec3 shift = piece_.plan.confine_length > 0 ? Vec3{} : dot(rag_states(rags_)[0].centre, axis) * axis;
  CrumpledPose pose;
  pose.poses.resize(static_cast<std::size_t>(piece_.rag.n_columns) * piece_.rag.n_rows);
  double outside = -infinity;
  for_all([&](const Tile& tile, int k, int i, int j) {
    const Vec3 x = tile.vector(Tile::x, k) - shift;
    const Vec3 q = tile.vector(Tile::qx, k);
    pose.poses[particle_id(piece_.rag, tile, i, j)] = {x, {tile.field(Tile::qw)[k], q.x, q.y, q.z}};
    outside = std::max(outside, norm(x - dot(x, axis) * axis) + piece_.rag.radius - piece_.plan.confine_radius);
    if (piece_.plan.confine_length > 0)
      outside = std::max(outside, std::abs(dot(x, axis)) + piece_.rag.radius - 0.5 * piece_.plan.confine_length);
  });
  rags_.contacts()->reset_measures();
  rags_.evaluate_contacts();
  pose.overlap_over_radius = rags_.contacts()->measures().max_overlap_over_radius;
  pose.strain_p99 = std::max(bond_strain_quantile(rags_, 0, 0.99), -bond_strain_quantile(rags_, 0, 0.01));
  pose.duration = rags_.time();
  if (piece_.plan.kind == PosePlan::Kind::confined && outside > 0)
    refuse_crushed("particles are left " + number_text(outside) + " m outside");
  if (pose.strain_p99 > largest_strain || pose.overlap_over_radius > largest_overlap)
    refuse_crushed("strain of the bonds (p99) " + number_text(pose.strain_p99) + ", must be below " + number_text(largest_strain) +
                   ", overlap over radius " + number_text(pose.overlap_over_radius) + ", must be below " + number_text(largest_overlap));
  return pose;
}

}  // namespace

CrumpledPose crumple(const RagPiece& piece, const ContactSettings& contacts) {
  check_plan(piece);
  if (piece.plan.kind == PosePlan::Kind::hopper) return Crumpling(piece, contacts, 0).run();
  double speed = closing_speed;
  for (int attempt = 1;; ++attempt, speed /= 2) try {
      CrumpledPose pose = Crumpling(piece, contacts, speed).run();
      pose.attempts = attempt, pose.closing_speed = speed;
      return pose;
    } catch (const Error& failure) {
      if (failure.code != ExitCode::usage) throw;
      if (attempt == most_attempts)
        throw Error(failure.code, std::string(failure.what()) + " (in the last of " + std::to_string(attempt) +
                                      " attempts, with walls that close at " + number_text(speed) + " m/s)");
    }
}

std::vector<std::string> make_poses(MPI_Comm comm, std::vector<RagPiece>& pieces, const ContactSettings& contacts) {
  static_assert(sizeof(ParticlePose) == 7 * sizeof(double), "poses are sent as arrays of doubles");
  std::vector<std::string> lines;
  for (RagPiece& piece : pieces) {
    if (!piece.plan.crumpled() || !piece.poses.empty()) continue;
    const double begun = MPI_Wtime();
    CrumpledPose made;
    on_all_ranks(comm, [&] {
      if (rank_of(comm) == 0) made = crumple(piece, contacts);
    });
    made.poses.resize(static_cast<std::size_t>(piece.rag.n_columns) * piece.rag.n_rows);
    MPI_Bcast(made.poses.data(), static_cast<int>(7 * made.poses.size()), MPI_DOUBLE, 0, comm);
    piece.poses = std::move(made.poses);
    std::ostringstream line;
    line.precision(3);
    line << "pose of " << piece.rag.name << ": " << piece.plan.kind.word() << ", seed " << piece.plan.seed << ", by a run of "
         << made.duration << " s of the particles alone in " << MPI_Wtime() - begun << " s; strain of the bonds (p99) " << made.strain_p99
         << ", overlap of particles over radius " << made.overlap_over_radius;
    if (made.attempts > 1)
      line << "; attempt " << made.attempts << ", with walls that close at " << made.closing_speed << " m/s: faster ones crushed the sheet";
    lines.push_back(line.str());
  }
  return lines;
}

}  // namespace snag
