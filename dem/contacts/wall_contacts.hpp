#pragma once
// Contacts of particles with walls.
//
// A particle sees of every triangle and plane in reach its nearest point. Which of these are contacts (sorted by distance; faces before
// edges before corners):
//   - an edge or corner acts only if no nearer triangle has it as well: so nothing is counted twice where triangles meet;
//   - of two contacts whose directions differ by less than `smooth_angle` the nearer one acts: so a faceted curved wall,
//     or two walls that are flush, is one wall; in a sharper concave corner both walls act;
//   - if the nearest of all says that the centre is beyond the wall, it pushes the centre back; other walls act only on centres in
//     front of them, so the back of a thin plate does nothing. Overlap: r - distance (up to 2 r, where the centre is r beyond).
// The slip of a contact belongs to the particle, the wall and the direction (frame of the wall): it slides over from triangle to triangle.
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dem/contacts/contact_pair.hpp"
#include "dem/contacts/contact_particles.hpp"
#include "dem/contacts/contact_solver.hpp"
#include "dem/contacts/held_particle.hpp"
#include "dem/contacts/wall_loads.hpp"
#include "dem/walls/wall_triangles.hpp"
#include "dem/walls/walls.hpp"

namespace snag {

inline constexpr double smooth_cosine = 0.866025403784;  // cos 30 degrees

/// Slip of one contact with a wall.
struct WallSlip {
  std::int64_t id = 0;  // of the particle
  int body = 0;
  Vec3 normal, slip;  // direction into the fluid and slip (m), frame of the wall
  bool operator==(const WallSlip&) const = default;
};

class WallContacts {
 public:
  WallContacts(const std::vector<Rag>& rags, const ContactSettings& settings, const WallSet& walls);
  ~WallContacts();
  WallContacts(WallContacts&&) noexcept;

  /// True if the list does not hold for this time: a moving wall has come too far, or a particle that has gone `path` (m) since then.
  bool due(double time, double path) const;
  /// List the owned particles that may touch a wall until due() says that it is out of date, and mark their rows. Positions are those of
  /// now.
  void list(ContactParticles& particles, double time);
  /// Add forces and torques to the loads; advance slips by `step` (s); count into measures.
  void add(ContactParticles& particles, double time, double step, std::vector<HeldParticle>* held);

  /// Impulses and duration are counted from now on.
  void start_loads();

  /// Bring slips and ids that were appended from outside into order.
  void sort_unpacked();

  /// Slips and ids of particles beyond walls, in the order of ids: what a restart or another rank needs.
  std::vector<WallSlip> slips;
  std::vector<std::int64_t> beyond;  // sorted

  std::int64_t n_contacts = 0;                  // now
  std::vector<double> max_overlap_over_radius;  // [n_rags] since reset
  std::vector<WallTouch> touched;               // [n_rags][n_contact_regions]
  std::optional<TongueLine> tongue;
  std::vector<WallImpulse> impulses;  // [parts of the walls] since start_loads
  double duration = 0;                // of the sub-steps since then, s

  std::vector<ContactPair> pairs;  // [n_rags]

 private:
  struct Candidate {
    int particle, body;
  };
  struct Touch {          // nearest point of one triangle or plane; small, because many are sorted
    double distance = 0;  // m, negative beyond the wall
    Vec3 direction;       // fixed frame
    int body = 0, triangle = 0;
    TriangleFeature feature = TriangleFeature::face;
    std::array<int, 2> node{-1, -1};
  };
  struct Particle {  // the one at work
    int number, rag;
    std::int64_t id;
    Vec3 x, v, w;
  };
  struct Reach {
    double near, far;
  };

  Reach reach(const WallBody& body) const;
  double fastest(const WallBody& body) const;
  bool near(std::size_t body, const Vec3& x, double radius) const;
  Particle particle(const ContactParticles& particles, int number) const;
  void find_touches(const Particle& p, int body);
  void select_touches();
  bool repeats(const Touch& touch, std::size_t before) const;
  void put(ContactParticles& particles, const Particle& p, const Touch& touch);
  void evaluate(ContactParticles& particles);
  ContactRegion region_of(const Touch& touch, const Vec3& centre) const;
  void count_touches(const Particle& p);
  Vec3 old_slip(int body, const Vec3& direction);
  void note_beyond(const Particle& p, std::size_t& next_old);
  void keep_beyond(const ContactParticles& particles, std::int64_t before, std::size_t& next_old);

  const std::vector<Rag>* rags_;
  const WallSet* walls_;
  struct Block;
  std::unique_ptr<Block> block_;
  double largest_radius_ = 0, step_ = 0;
  std::vector<HeldParticle>* held_ = nullptr;
  std::vector<TriangleSurface> surfaces_;  // [bodies]
  std::vector<WallPose> poses_;            // [bodies]
  std::vector<double> fastest_;            // [bodies] m/s, of the wall's material
  std::vector<Vec3> axes_;                 // [bodies] unit
  double listed_ = 0;                      // time of the list, s
  std::vector<Candidate> candidates_;      // sorted by particle, then body
  std::vector<Touch> touches_, acting_;
  std::vector<WallSlip> old_slips_;
  std::vector<char> used_;  // old slips of the particle at work that found their contact
  std::size_t old_begin_ = 0, old_end_ = 0;
  std::vector<std::int64_t> old_beyond_;
};

}  // namespace snag
