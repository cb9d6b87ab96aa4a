#pragma once
// Passage of one rag through a pump, from its state at the end of each step: events, times, outcome. No particles, no ranks.
//
//   entered            the first particle is past the plane of the inlet flange
//   wholly in the casing   no particle is upstream any more; what is out already counts as inside
//   tongue passed      more than half of its particles are in the discharge: reported again only after it recirculated
//   recirculated       its centroid passes the tongue's angle in the sense of rotation while more than half of its particles are outside
//                      the impeller, and gets 20 degrees further on the shaft's side of the tongue (of the particles within a quarter
//                      turn past that angle most are not in the discharge): back into the volute. So one that hangs on the tongue and
//                      then goes out did not recirculate. A pass counts once the centroid was more than a quarter turn away from the
//                      tongue since the last one, and not if it went back in between: nor is swinging at the tongue a recirculation, or
//                      turning in the eye of the impeller
//   stuck on ...       it touches the tongue, or the impeller, for more than 1 s without a gap longer than 50 ms; reported once each time.
//   Who
//                      recirculates and has gone round past the wall since the contact began, a full turn or more, is not stuck on it:
//                      the contact begins anew
//   reached the outlet the first particle is out;      exited   all of them are
//
// A case without a pump defines only the last two. Each event has the time of the end of its step; an exit through a plane has the time
// interpolated within the step. A contact with a wall counts for the whole step.
//
// Runs in a folder show it the particles (simulation/setup/passage.hpp), pictures their pixels (observe/passage/volute_watch.hpp), runs in
// memory the centre of mass (casework/exit_watch.hpp).
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/vec3.hpp"
#include "observe/passage_result.hpp"

namespace snag {

/// What a rag touches: walls that turn, walls at rest near the tongue, other walls at rest.
enum class WallRegion { impeller, tongue, other };
inline constexpr std::array wall_regions{WallRegion::impeller, WallRegion::tongue, WallRegion::other};

/// A value for each region.
template <class T>
struct ByRegion {
  std::array<T, wall_regions.size()> values{};
  T& operator[](WallRegion region) { return values[static_cast<std::size_t>(region)]; }
  const T& operator[](WallRegion region) const { return values[static_cast<std::size_t>(region)]; }
};

/// What says where a rag is: flanges and tongue of a pump; a plane that it leaves by, where it is wholly in from the start; openings of a
/// mesh, which define no retention time.
enum class Passageway { pump, plane, openings };

/// One rag at the end of a step, the same on every rank. Particles are counted; without a pump only n, n_upstream, n_out, contact and
/// tension are known.
struct RagSnapshot {
  std::int64_t n = 0;  // that exist; none: it is not in the run yet
  std::int64_t n_upstream = 0, n_out = 0;
  double out_after = 1;  // share of the step after which all were out; 1: its end, also where it is not resolved
  std::int64_t n_in_discharge = 0, n_outside_impeller = 0;
  std::int64_t n_past_inside = 0, n_past_outside = 0;  // within a quarter turn past the tongue's angle: not in the discharge, in it
  ByRegion<std::int64_t> touching;                     // at the end of the step
  ByRegion<bool> touched;                              // in the step
  double angle = 0, radius = 0, height = 0;            // of the centroid; rad in (-pi, pi], m, m
  double tension = 0, tension_angle = 0;               // largest of a bond, N; rad
  Vec3 tension_place;                                  // m

  std::int64_t n_in_casing() const { return n - n_upstream - n_out; }
};

class PassageTracker {
 public:
  /// `sense` of the impeller: +1 towards larger angles, -1 towards smaller; 0: no pump. `impeller_speed` with that sign, rad/s.
  explicit PassageTracker(Passageway passageway, int sense = 0, double impeller_speed = 0)
      : passageway_(passageway), sense_(sense), impeller_speed_(impeller_speed), is_upstream_(sense != 0) {}

  /// The step of length `step` (s) that ended at `time`.
  void add(const RagSnapshot& seen, double time, double step);
  /// s; absent: it has not.
  std::optional<double> exited_at() const { return has_exited() ? std::optional(exited_) : std::nullopt; }
  /// Of the centroid, unwrapped from where it was first seen, rad.
  double angle() const { return angle_; }
  PassageResult verdict() const;

  /// All that the next step needs: of any length.
  std::vector<double> state() const;
  void restore(const std::vector<double>& state);

 private:
  struct Entry {
    double time = 0, angle = 0;
    PassageEvent what = PassageEvent::entered;
  };
  /// Contact with walls of one place, in episodes.
  struct Contact {
    double begin = -1, last = -1;   // of the episode, s; -1: none yet
    double begin_angle = 0;         // of the centroid, rad
    bool is_stuck = false;          // it has lasted for more than 1 s
    double stuck = 0, contact = 0;  // s: ended episodes of more than 1 s; all steps with contact
    /// True if the episode has just become one of being stuck.
    bool add(bool touched, double time, double step, double angle);
    /// It recirculated, past a wall that turns with this speed (rad/s): the episode begins anew if it has gone round past it.
    void recirculate(double time, double angle, double wall_speed);
    double stuck_time() const { return stuck + (is_stuck ? last - begin : 0); }
    bool is_stuck_at(double time) const;
  };

  bool has_exited() const { return exited_ >= 0; }
  void note(PassageEvent what, double time) { log_.push_back({time, angle_, what}); }
  void enter(const RagSnapshot& seen, double time);
  void pass_tongue(const RagSnapshot& seen, double before, double time);
  void leave(const RagSnapshot& seen, double time, double step);
  Outcome outcome() const;
  template <class Self, class Visit>
  static void for_each_state_value(Self& self, const Visit& visit);

  Passageway passageway_;
  int sense_;
  double impeller_speed_;  // rad/s
  std::vector<Entry> log_;
  double time_ = 0;
  double angle_ = 0;  // unwrapped, rad
  bool is_seen_ = false, is_armed_ = false, is_passing_ = false, is_past_tongue_ = false, is_upstream_;
  std::int64_t n_recirculations_ = 0;
  double entered_ = -1, wholly_in_ = -1, reached_outlet_ = -1, exited_ = -1;  // s, -1: not yet
  ByRegion<Contact> contact_;
  double wall_contact_ = 0;  // s
  VoluteStay volute_;
  double max_tension_ = 0, max_tension_time_ = -1, max_tension_angle_ = 0;
  Vec3 max_tension_place_;
};

}  // namespace snag
