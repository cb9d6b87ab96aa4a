#pragma once
// Held particles of rags, [[hold]] of a case file. All kinds keep a particle where the hold is, at rest or in a prescribed motion
// (dem/hold_motion.hpp): a clamp its rotation too; a pin leaves the rotation free; a hinge leaves that about one axis a free.
//
// The hold exerts the reaction F_h on the cloth, and the moment M_h about the point p, the mean place of its particles at the start, which
// moves with the hold; means over a step of duration T, from the impulses of its sub-steps:
//
//   F_h = sum (m dv - (F + m g) dt) / T
//   M_h = sum ((x - p) x (m dv - (F + m g) dt) + P (i dw - M dt)) / T
//
//   F, M   force and torque of bonds, contacts and fluid on a held particle in a sub-step of dt, N, N m; x: its position, m
//   dv, dw change of its velocity and rotation by the motion of the hold in that sub-step; m, i: its mass and moment of inertia
//   P      projection on what is held of the rotation: all of a clamp, nothing of a pin, what is across a of a hinge
//   m g    its weight, in a run without water; with water, weight and buoyancy are forces of the fluid and part of F
//
// The fluid's part of F has the water that the particle carries with itself (added mass m_a): - m_a dv of the motion of the hold.
//
// The stable sub-step needs no change: a hold takes degrees of freedom from the linear system, and none of its eigenvalues is then above
// the largest one of the free system (interlacing of eigenvalues).
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/case_file.hpp"
#include "base/parameter.hpp"
#include "dem/hold_motion.hpp"
#include "dem/rag_system.hpp"
#include "parallel/running_sum.hpp"

namespace snag {

struct HoldSettings {
  std::string rag;  // name of pieces; empty: all
  enum class Edge { none, first_column, last_column, first_row, last_row };
  Choice<Edge> edge{Edge::none, {"", "first_column", "last_column", "first_row", "last_row"}};  // none: by the other keys
  std::vector<double> columns, rows;                                                            // first and last place; empty: all
  std::vector<double> particles;             // row * n_columns + column; empty: by the other keys
  std::vector<double> box_lower, box_upper;  // m; empty: by the other keys
  enum class Kind { clamp, pin, hinge };
  Choice<Kind> kind{Kind::clamp, {"clamp", "pin", "hinge"}};
  Vec3 hinge_axis;
  HoldMotion motion;
  std::optional<double> release_time;  // s; none: held to the end
  Section section();
};

/// Reaction of one hold on one rag, mean over the last step; sign: on the cloth.
struct HoldReaction {
  double time = 0;  // s
  int hold = 0, rag = 0;
  std::int64_t n_particles = 0;  // held in that step
  Vec3 point, force, moment;     // m, N, N m about `point`
};

class Holds : public PrescribedMotion {
 public:
  /// Reads [[hold]] and chooses particles of `rags`. `gravity`: of RagSystem::set_gravity, m/s2. Throws Error(usage).
  Holds(const Table& root, const RagSystem& rags, const Vec3& gravity);
  bool empty() const { return settings_.empty(); }
  /// Holds the particles that are held at a time, s, and frees the others; of rags put in since the last call too. A particle that was free
  /// takes the velocity of the hold.
  void apply(RagSystem& rags, double time) const;
  void begin(std::span<Tile> tiles, double time, double drift) override;
  void announce(std::size_t index, Tile& tile, double time, double drift) override;
  void kick(std::size_t index, Tile& tile, double time, double step, double drift) override;
  /// Of each hold and each of its rags that is in the run, after RagSystem::advance. Collective.
  std::vector<HoldReaction> reactions(const RagSystem& rags, double time) const;
  /// A line for each hold and rag: particles, kind, place, motion, time of release.
  std::vector<std::string> lines() const;
  /// Bound of the speed of all held particles, m/s.
  double largest_speed() const;

 private:
  struct Place {
    int hold, rag;
    std::string rag_name;
    std::int64_t n_particles = 0;
    Vec3 point;             // mean of the starting positions, m
    double start_time = 0;  // when the rag is put in, s
    double reach = 0;       // of its particles from the axis' origin at the start, m
  };
  struct Held {  // a held particle of this rank
    int k, place;
    Vec3 change;    // of its velocity at the last begin, which belongs to the next kick, m/s
    Vec3 velocity;  // of the coming drift, m/s
  };
  struct Reaction {                     // of one place, on this rank, since the last begin
    std::array<RunningSum, 6> impulse;  // N s, N m s
    std::int64_t n_particles = 0;
  };
  const HoldMotion& motion_of(int place) const {
    return settings_[static_cast<std::size_t>(places_[static_cast<std::size_t>(place)].hold)].motion;
  }
  void select(int hold, const std::string& where, const RagSystem& rags, int rag, const std::vector<std::string>& all_where);
  void move(Tile& tile, const Held& held, double time, double drift, const Vec3& force_impulse, double step);

  const RagSystem& rags_;
  std::vector<HoldSettings> settings_;
  std::vector<Place> places_;
  std::vector<int> place_of_;  // [ids of all particles] place of its hold, or -1
  Vec3 gravity_;
  std::vector<std::vector<Held>> held_;  // [owned tiles]
  std::vector<Reaction> reactions_;      // [places]
  double duration_ = 0;                  // since the last begin, s
};

}  // namespace snag
