#pragma once
// Contacts of particles that are not bonded to each other, and of particles with walls: Hertz-Mindlin with tangential history, Coulomb
// limit and rolling friction (laws: laws/, rolling_friction.hpp; where two pieces touch: surface_contact.hpp; search: contact_list.hpp,
// wall_contacts.hpp).
//
// Two particles may touch when they belong to different rags, or to one rag without a whole bond between them: so neighbours on the lattice
// touch once their bond broke, and diagonal neighbours (2 sqrt2 r apart at rest) when the cloth is sheared enough.
//
// Results do not depend on the ranks: a pair is evaluated from the same numbers in the same order (lower particle id first) wherever one of
// the two is owned, forces are summed in the order of the partner's id and then walls, and the lists (of near pairs, rebuilt when a
// particle moved half the skin) hold more pairs than touch but never decide a force.
#include <mpi.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/vec3.hpp"
#include "dem/contacts/contact_settings.hpp"
#include "dem/particles/integrator.hpp"
#include "dem/particles/rag.hpp"
#include "dem/particles/step_rates.hpp"
#include "dem/particles/tile.hpp"

namespace snag {

class WallSet;
struct WallLoad;

/// Where a particle touches walls: a wall that moves, one at rest near the tongue of a volute, any other at rest.
enum class ContactRegion { moving, tongue, other };
inline constexpr int n_contact_regions = 3;

/// The edge of the tongue of a volute as a line; contacts within `reach` of it are contacts with the tongue.
struct TongueLine {
  Vec3 point, direction;  // m; unit
  double reach = 0;       // m, from the line to the contact point
};

/// Particles of one rag that touch walls of one region, on this rank; a particle counts once in each region where it touches.
struct WallTouch {
  std::int64_t now = 0;          // at the last add_forces
  std::int64_t since_reset = 0;  // summed over all add_forces since the last reset
};

/// Counts and maxima of this rank. "Now" is the last call of add_forces; maxima are since the last reset.
struct ContactMeasures {
  std::int64_t n_contacts = 0;         // pairs that touch now, counted where the lower id is owned: the sum over ranks counts each once
  std::int64_t n_wall_contacts = 0;    // now
  double max_overlap_over_radius = 0;  // between particles, of the smaller radius
  std::vector<double> max_wall_overlap_over_radius;  // [n_rags]
  std::vector<std::int64_t> beyond_walls;            // [n_rags] particles whose centre is beyond a wall now
  std::int64_t n_not_finite = 0;                     // particles without a finite position, left out of all contacts, at the last list
  std::int64_t n_lists = 0;                          // times the lists were built
};

class ContactSolver {
 public:
  /// `rags` and `walls` (may be null) must outlive the solver; walls are complete when it is made. Throws Error(usage) on values out of
  /// range.
  ContactSolver(const ContactSettings& settings, const std::vector<Rag>& rags, const WallSet* walls);
  ~ContactSolver();
  ContactSolver(ContactSolver&&) noexcept;
  ContactSolver& operator=(ContactSolver&&) noexcept;

  /// Time of the walls at the next add_forces, s (default 0). Each add_forces then moves it on by its step: set it once a fluid step, or
  /// before each call.
  void set_time(double time);
  /// Add forces (N) and torques (N m) to fx .. tz of the owned tiles' particles; call it when positions and velocities of owned and ghost
  /// tiles are those of this sub-step. `step` (s) is what the tangential history advances by; 0 evaluates without advancing it. Rings are
  /// not read; of ghosts the 13 state fields and `exists` are. Any tile that has a particle within 2 r_max of an owned one must be among
  /// owned or ghosts. Not collective; does not throw.
  void add_forces(std::span<Tile* const> owned, std::span<const Tile* const> ghosts, double step);
  /// The same in two parts, for a caller that takes the tiles one by one while they are in the cache: evaluate all, then add what the
  /// particles of the owned tile number i feel. `moved`: bounds of how far the particles of the owned tiles have moved since the last call,
  /// m, if the caller knows.
  void evaluate(std::span<Tile* const> owned, std::span<const Tile* const> ghosts, double step, const Box* moved = nullptr);
  /// The same, and the largest stable step, s, of the owned particles under all their contacts at once, besides the rates `of_rag` [n_rags]
  /// that they have already (bonds, drag); `largest` where that is no limit.
  double evaluate_with_limit(std::span<Tile* const> owned, std::span<const Tile* const> ghosts, double step, const Box* moved,
                             std::span<const StepRates> of_rag, double largest);
  void add_to_tile(std::size_t i) const;

  /// Other rows of the ghosts exist now: the lists are made anew at the next add_forces.
  void renew_lists();

  /// Distance between particle centres within which tiles must be present as ghosts: 2 r_max + skin, m. Ghosts chosen so stay good until a
  /// particle moved skin()/2.
  double cutoff() const;
  double skin() const;
  /// Largest sub-step for contacts, s: a third of the Rayleigh time and an eighth of the Hertz impact time at the setting `impact_speed`,
  /// over all pairs and walls.
  double stable_step() const;
  /// Which contact sets it, in words.
  std::string stable_step_reason() const;

  /// Tangential history of all contacts of a tile's particles (with particles and walls), for the tile's new rank or a checkpoint. Owner
  /// only.
  std::vector<double> pack(const Tile& tile) const;
  /// Put back what pack gave; before the first add_forces that sees the tile as owned here. The same contact from two tiles is one contact.
  void unpack(const Tile& tile, std::span<const double> values);

  const ContactMeasures& measures() const;
  /// From now on contacts with walls at rest near the tongue are counted separately.
  void set_tongue(const TongueLine& tongue);
  /// [n_rags][n_contact_regions], row by row; empty without walls.
  const std::vector<WallTouch>& wall_touches() const;
  /// What rags exert on each part of the walls, mean over the sub-steps since start_wall_loads; empty without walls. Collective.
  std::vector<WallLoad> wall_loads(MPI_Comm comm) const;
  void start_wall_loads();
  /// Sum of its contacts' forces on each particle of these owned tiles at the last add_forces, N; tile by tile in the order of
  /// for_particles. Zero for tiles that were not there then.
  std::vector<Vec3> forces(std::span<const Tile> tiles) const;
  /// Start maxima and counts anew.
  void reset_measures();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace snag
