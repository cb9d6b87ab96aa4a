#pragma once
// All cloth of a run: tiles owned by this rank, their halo, bonds, contacts and walls, advanced in stable sub-steps.
//
// Every tile has one owner. Before the forces of a sub-step owned tiles get their rings filled from their lattice neighbours, and tiles of
// other ranks that are near are present as ghosts, in rows: what the rings are copied from always; with contacts also rows whose bounding
// boxes come within the contact cutoff. Other rows of a ghost do not exist. Forces on a particle are computed by its owner only, from the
// same numbers in the same order on any number of ranks.
#include <mpi.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dem/bonds/bond_law.hpp"
#include "dem/bonds/stable_step.hpp"
#include "dem/particles/integrator.hpp"
#include "dem/particles/rag.hpp"
#include "dem/particles/tile.hpp"
#include "dem/templates/lattice.hpp"
#include "dem/templates/rag_settings.hpp"
#include "dem/tile_halo.hpp"

namespace snag {

class CheckpointReader;
class CheckpointWriter;
class ContactSolver;

/// A force from outside (the fluid) on the particles of an owned tile, added once a sub-step to fx .. tz of all its particles. It acts over
/// the whole sub-step: the impulse on a particle is force times `step`, to round-off.
class TileForce {
 public:
  virtual ~TileForce() = default;
  /// `index`: place of the tile in RagSystem::tiles(); `step`: length of the sub-step, s. Positions are those in the middle of the
  /// sub-step, velocities those at its start.
  virtual void add(std::size_t index, Tile& tile, double step) = 0;
};

/// Motion that holds prescribe to particles that are not free. Its calls see every owned tile in every sub-step.
class PrescribedMotion {
 public:
  virtual ~PrescribedMotion() = default;
  /// At the start of an advance at `time`, s: velocities for the first drift, which takes `drift` s.
  virtual void begin(std::span<Tile> tiles, double time, double drift) = 0;
  /// Before forces from outside are added to an owned tile at `time`, s: Tile::held_change for the kick that follows; `drift` as there.
  virtual void announce(std::size_t index, Tile& tile, double time, double drift) = 0;
  /// When all forces on the particles of an owned tile are there, at `time`, s, before they act for `step` s: velocities for the drift
  /// after that, which takes `drift` s from `time` on.
  virtual void kick(std::size_t index, Tile& tile, double time, double step, double drift) = 0;
};

/// Decides which rank owns each tile, from the centres of this rank's tiles; collective.
using OwnerOf = std::function<std::vector<int>(const std::vector<Vec3>& tile_centres)>;

/// What is left of the bonds of one rag.
struct BondCount {
  std::int64_t whole = 0, broken = 0;
};

/// What is there of each rag.
struct RagCounts {
  std::vector<std::int64_t> particles;
  std::vector<BondCount> bonds;
};

class RagSystem {
 public:
  /// Places the pieces, but those that have an insert_time or begin with the water wait for insert(). Tiles are spread in equal blocks over
  /// the ranks until the first migrate(). Collective; throws Error(usage).
  RagSystem(MPI_Comm comm, const DemSettings& settings, std::vector<RagPiece> pieces);
  ~RagSystem();
  RagSystem(const RagSystem&) = delete;
  RagSystem& operator=(const RagSystem&) = delete;

  /// From now on with contacts of particles and walls (dem/contacts/contact_solver.hpp), made for rags() of this system. Before the first
  /// advance; collective. Throws Error(usage) if a given step is above the contacts' limit.
  void set_contacts(std::unique_ptr<ContactSolver> contacts);
  ContactSolver* contacts() { return contacts_.get(); }
  /// Contacts of the particles where they are now, for the measures of contacts(); moves nothing. Collective.
  void evaluate_contacts();
  /// Uniform acceleration of all free particles, m/s2 (default 0: weight and buoyancy come with the forces of the fluid).
  void set_gravity(const Vec3& gravity) { gravity_ = gravity; }
  /// Rate at which outside forces damp the motion of a particle, largest slope/m, 1/s: part of the stable step. Throws Error(usage) if a
  /// given step is above the limit that follows.
  void set_damping_rate(double rate);

  MPI_Comm comm() const { return comm_; }
  const std::vector<Rag>& rags() const { return rags_; }
  const PieceBonds& bonds(int rag) const { return *bonds_[rag]; }
  /// Owned tiles in order of their number; the reference stays, its content changes with migrate() and load().
  std::vector<Tile>& tiles() { return tiles_; }
  const std::vector<Tile>& tiles() const { return tiles_; }
  const std::vector<RagPiece>& pieces() const { return pieces_; }
  /// Whether a rag is in the run, not yet, or no more.
  enum class Presence : char { waiting, present, removed };
  Presence presence(int rag) const { return presence_[rag]; }
  /// Puts a waiting rag where its piece says. Collective.
  void insert(int rag);
  /// Takes a rag out of the run as a whole; it stays counted as complete. Forces of the last sub-step are not to be asked for after it,
  /// before the next one. Collective.
  void remove(int rag);
  /// Adds a velocity to all particles of a rag, m/s.
  void add_velocity(int rag, const Vec3& velocity);
  double time() const { return time_; }
  std::int64_t n_sub_steps() const { return n_sub_steps_; }
  /// Of the last advance.
  int n_last_sub_steps() const { return n_last_sub_steps_; }
  /// Particle-steps done by this rank, for performance figures.
  std::int64_t n_particle_steps() const { return n_particle_steps_; }
  /// Of all rags, all ranks.
  std::int64_t n_particles() const;

  /// Largest sub-step by bonds, damping, and single contacts at the impact speed, without safety factor, s; and what sets it.
  const StepLimit& step_limit() const { return limit_; }
  /// The sub-step that advance aims at where few particles touch: the given one, or safety times the limit, s.
  double stable_step() const;
  /// The same where particles are pressed by several contacts at once, in addition to bonds and damping, as they were last seen, s.
  double pressed_step() const;

  /// Advance by dt in equal sub-steps of at most stable_step() and pressed_step(), which is renewed every few of them. Collective; throws
  /// Error(invariant) if a particle or bond was lost, Error(diverged) if a position is no number.
  void advance(double dt, TileForce* force = nullptr);
  /// Give tiles to the ranks that `owner_of` names (default: equal blocks), with all their state and contact history. Collective.
  void migrate(const OwnerOf& owner_of = {});
  /// Particles with ids for which `held` is true keep their present velocity from now on (a clamp), the others are free.
  void clamp(const std::function<bool(std::int64_t id)>& held);
  /// Holds that move particles from now on, or null; must outlive the system.
  void set_motion(PrescribedMotion* motion) { motion_ = motion; }
  /// Velocity of all clamped particles of this rank, from now on, m/s.
  void set_clamp_velocity(const std::function<Vec3(std::int64_t id)>& velocity);

  /// Bonds of each rag, all ranks; throws Error(invariant) naming ids if particles, tiles or bonds were lost. Collective.
  std::vector<BondCount> check() const;
  /// The same numbers whatever they are. Collective.
  RagCounts count() const;

  /// All state, contact history and counters, bit for bit. Collective; throws Error(io).
  void save(CheckpointWriter& writer) const;
  void load(CheckpointReader& reader);

 private:
  void set_limit();
  void exchange_ghosts(const Box* moved = nullptr);
  void evaluate_contacts(double step, const Box* moved, bool with_limit);
  void kick_and_drift_tiles(double time, double step, double drift_step, TileForce* force);
  struct TileLists {
    std::vector<TileRows> send, receive;  // by ascending number of the tile
    bool operator==(const TileLists&) const = default;
  };
  std::map<int, TileLists> exchange_lists();
  void find_ghosts();
  void renew_ghosts();
  void set_ghosts(std::map<int, TileLists> lists);
  bool ghosts_outdated(const Box* moved);
  class NeededRows;
  void add_ring_sources(NeededRows& needed) const;
  void add_near_rows(NeededRows& needed);
  std::vector<double> all_row_boxes();
  int n_rows_of(int number) const;
  int neighbour_number(int number, int column_step, int row_step) const;
  void set_pointers();
  void move_tiles(const std::vector<int>& owner);
  std::vector<double> pack(const Tile& tile) const;
  Tile unpack(int number, std::span<const double> values);
  Tile tile_at_birth(int number) const;
  void add_tiles(int rag);
  int rag_of_tile(int number) const;
  int n_all_tiles() const { return static_cast<int>(owner_.size()); }

  MPI_Comm comm_;
  DemSettings settings_;
  std::vector<RagPiece> pieces_;
  std::vector<Rag> rags_;
  std::vector<TileGrid> grids_;
  std::vector<std::unique_ptr<PieceBonds>> bonds_;  // [n_rags]
  Vec3 gravity_;
  double damping_rate_ = 0;
  StepLimit limit_;
  std::vector<StepRates> rates_;                                    // [n_rags] of bonds and damping
  double pressed_limit_ = std::numeric_limits<double>::infinity();  // s, when it was seen last
  double time_ = 0;
  bool warned_of_step_ = false;
  std::int64_t n_sub_steps_ = 0, n_particle_steps_ = 0;
  int n_last_sub_steps_ = 0;
  std::vector<Presence> presence_;    // [n_rags]
  std::vector<std::int64_t> broken_;  // [n_rags] bonds that broke on this rank

  std::vector<int> owner_;    // [n_tiles] rank of each tile; -1: its rag is not in the run
  std::vector<int> numbers_;  // of the owned tiles, ascending
  std::vector<Tile> tiles_;
  std::map<int, TileLists> lists_;  // by the other rank
  std::vector<int> ghost_numbers_;
  std::vector<Tile> ghosts_;
  std::vector<Tile*> owned_pointers_;
  std::vector<const Tile*> ghost_pointers_;
  std::vector<Box> boxes_;  // of the rows of the owned tiles when ghosts were chosen
  Box grown_;               // bounds of how far the corners of all of these have moved since, m
  Box moved_;               // bounds of the last drift, m
  std::int64_t n_owned_particles_ = 0;
  std::unique_ptr<TileHalo> halo_;
  std::unique_ptr<ContactSolver> contacts_;
  PrescribedMotion* motion_ = nullptr;
};

}  // namespace snag
