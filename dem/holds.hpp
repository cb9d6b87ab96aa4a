#pragma once
// Held particles of rags, [[hold]] of a case file: a clamp keeps the position and the rotation of its particles.
//
// The hold exerts the reaction F_h on the cloth, and the moment M_h about the mean starting position p of its particles:
//
//   F_h = -sum (F + m g),   M_h = -sum ((x - p) x (F + m g) + T)
//
//   F, T   force and torque of bonds, contacts and fluid on a held particle in the last sub-step, N, N m; x: its position, m
//   m g    its weight, in a run without water; with water, weight and buoyancy are forces of the fluid and part of F
//
// The stable sub-step needs no change: a hold takes degrees of freedom from the linear system, and none of its eigenvalues is then above
// the largest one of the free system (interlacing of eigenvalues).
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/case_file.hpp"
#include "base/parameter.hpp"
#include "dem/rag_system.hpp"

namespace snag {

struct HoldSettings {
  std::string rag;                     // name of pieces; empty: all
  std::string edge;                    // empty: by columns and rows
  std::vector<double> columns, rows;   // first and last place; empty: all
  std::optional<double> release_time;  // s; none: held to the end
  Section section();
};

/// Reaction of one hold on one rag; sign: on the cloth.
struct HoldReaction {
  double time = 0;  // s
  int hold = 0, rag = 0;
  std::int64_t n_particles = 0;  // held now
  Vec3 point, force, moment;     // m, N, N m about `point`
};

class Holds {
 public:
  /// Reads [[hold]] and chooses particles of `rags`. `gravity`: of RagSystem::set_gravity, m/s2. Throws Error(usage).
  Holds(const Table& root, const RagSystem& rags, const Vec3& gravity);
  bool empty() const { return settings_.empty(); }
  /// Stops the particles that are held at a time, s, and frees the others; of rags put in since the last call too.
  void apply(RagSystem& rags, double time) const;
  /// Of each hold and each of its rags that is in the run, after RagSystem::advance and before the next migrate. Collective.
  std::vector<HoldReaction> reactions(const RagSystem& rags, double time) const;
  /// A line for each hold and rag: particles, place, time of release.
  std::vector<std::string> lines() const;

 private:
  struct Place {
    int hold, rag;
    std::string rag_name;
    std::int64_t n_particles = 0;
    Vec3 point;  // mean of the starting positions, m
  };
  void select(int hold, const std::string& where, const RagSystem& rags, int rag, const std::vector<std::string>& all_where);

  std::vector<HoldSettings> settings_;
  std::vector<Place> places_;
  std::vector<int> hold_of_;  // [ids of all particles] hold, or -1
  Vec3 gravity_;
};

}  // namespace snag
