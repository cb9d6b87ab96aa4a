#include "observe/passage/passage_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace snag {

namespace {

constexpr double two_pi = 2 * std::numbers::pi, degrees = 180 / std::numbers::pi;
constexpr double stuck_after = 1, longest_gap = 0.05;  // s
constexpr double armed_beyond = std::numbers::pi / 2;  // from the tongue, rad
constexpr double passed_beyond = std::numbers::pi / 9;

}  // namespace

bool PassageTracker::Contact::add(bool touched, double time, double step, double angle) {
  if (!touched) return false;
  contact += step;
  if (last < 0 || time - step - last > longest_gap) {
    if (is_stuck) stuck += last - begin;
    begin = time - step, begin_angle = angle, is_stuck = false;
  }
  last = time;
  const bool was_stuck = is_stuck;
  is_stuck = last - begin > stuck_after;
  return is_stuck && !was_stuck;
}

void PassageTracker::Contact::recirculate(double time, double angle, double wall_speed) {
  if (last < 0 || std::abs(angle - begin_angle - wall_speed * (time - begin)) < two_pi) return;
  if (is_stuck) stuck += last - begin;
  begin = time, begin_angle = angle, is_stuck = false;
}

bool PassageTracker::Contact::is_stuck_at(double time) const { return is_stuck && time - last <= longest_gap; }

void PassageTracker::add(const RagSnapshot& seen, double time, double step) {
  if (seen.n == 0) return;
  time_ = time;
  const bool was_out = has_exited();
  const double before = is_seen_ ? angle_ : seen.angle;
  angle_ = before + std::remainder(seen.angle - before, two_pi), is_seen_ = true;
  enter(seen, time);
  if (sense_ != 0 && wholly_in_ >= 0 && !was_out) pass_tongue(seen, before, time);
  leave(seen, time, step);

  if (std::ranges::any_of(seen.touched.values, std::identity())) wall_contact_ += step;
  for (const WallRegion region : wall_regions) {
    const bool is_new = contact_[region].add(seen.touched[region], time, step, angle_);
    if (!is_new || sense_ == 0 || was_out || region == WallRegion::other) continue;
    note(region == WallRegion::tongue ? PassageEvent::stuck_on_tongue : PassageEvent::stuck_on_impeller, time);
  }
  if (seen.tension > max_tension_)
    max_tension_ = seen.tension, max_tension_time_ = time, max_tension_angle_ = seen.tension_angle, max_tension_place_ = seen.tension_place;
  if (sense_ == 0 || wholly_in_ < 0 || has_exited() || 2 * seen.n_in_discharge > seen.n) return;
  volute_.add(angle_, seen.radius, step);
}

void PassageTracker::enter(const RagSnapshot& seen, double time) {
  if (entered_ < 0 && seen.n_upstream < seen.n) {
    entered_ = time;
    if (sense_ != 0) note(PassageEvent::entered, time);
  }
  if (wholly_in_ < 0 && seen.n_upstream == 0) {
    wholly_in_ = time;
    if (sense_ != 0) note(PassageEvent::wholly_in, time);
  }
  is_upstream_ = sense_ != 0 ? wholly_in_ < 0 : 2 * seen.n_upstream > seen.n;
}

/// `before`: the unwrapped angle a step ago.
void PassageTracker::pass_tongue(const RagSnapshot& seen, double before, double time) {
  const auto turns = [&](double angle) { return std::floor(sense_ * angle / two_pi); };
  if (turns(angle_) > turns(before)) {
    is_passing_ = is_armed_ && 2 * seen.n_outside_impeller > seen.n, is_armed_ = false;
  } else if (turns(angle_) < turns(before)) {
    is_armed_ = is_passing_, is_passing_ = false;
  }
  if (std::abs(seen.angle) > armed_beyond) is_armed_ = true;
  const double past = sense_ * angle_ - two_pi * turns(angle_);
  if (2 * seen.n_in_discharge > seen.n) {
    if (!is_past_tongue_) note(PassageEvent::tongue_passed, time);
    is_past_tongue_ = true, is_passing_ = false;
  } else if (is_passing_ && past > passed_beyond && seen.n_past_inside >= seen.n_past_outside) {
    ++n_recirculations_, is_past_tongue_ = is_passing_ = false;
    note(PassageEvent::recirculated, time);
    contact_[WallRegion::impeller].recirculate(time, angle_, impeller_speed_), contact_[WallRegion::tongue].recirculate(time, angle_, 0);
  }
}

void PassageTracker::leave(const RagSnapshot& seen, double time, double step) {
  if (reached_outlet_ < 0 && seen.n_out > 0) reached_outlet_ = time, note(PassageEvent::reached_outlet, time);
  if (exited_ < 0 && seen.n_out == seen.n) exited_ = time - (1 - seen.out_after) * step, note(PassageEvent::exited, exited_);
}

Outcome PassageTracker::outcome() const {
  if (has_exited()) return Outcome::exited;
  if (sense_ != 0) {
    if (contact_[WallRegion::tongue].is_stuck_at(time_)) return Outcome::stuck_on_tongue;
    if (contact_[WallRegion::impeller].is_stuck_at(time_)) return Outcome::stuck_on_impeller;
  }
  if (is_upstream_) return Outcome::upstream;
  return n_recirculations_ > 0 ? Outcome::recirculating : Outcome::in_domain;
}

PassageResult PassageTracker::verdict() const {
  PassageResult v;
  v.outcome = outcome();
  v.wall_contact = wall_contact_, v.impeller_contact = contact_[WallRegion::impeller].contact,
  v.other_contact = contact_[WallRegion::other].contact;
  v.max_tension = max_tension_, v.max_tension_place = max_tension_place_;
  if (max_tension_time_ >= 0) v.max_tension_time = max_tension_time_;
  for (const Entry& entry : log_) {
    v.events.push_back({entry.time, {}, entry.what});
    if (sense_ != 0) v.events.back().angle = degrees * entry.angle;
  }
  v.exited = exited_at();
  if (passageway_ != Passageway::openings && wholly_in_ >= 0 && exited_ >= 0) v.retention_time = exited_ - wholly_in_;
  if (sense_ == 0) return v;
  if (entered_ >= 0) v.entered = entered_;
  if (wholly_in_ >= 0) v.time_to_enter = wholly_in_ - entered_;
  v.recirculations = n_recirculations_;
  v.stuck_on_tongue = contact_[WallRegion::tongue].stuck_time(), v.stuck_on_impeller = contact_[WallRegion::impeller].stuck_time();
  v.tongue_contact = contact_[WallRegion::tongue].contact;
  if (max_tension_time_ >= 0) v.max_tension_angle = degrees * max_tension_angle_;
  v.volute = volute_;
  return v;
}

/// Visits all numbers of the state but the log: one list for both ways.
template <class Self, class Visit>
void PassageTracker::for_each_state_value(Self& self, const Visit& visit) {
  visit(self.time_), visit(self.angle_), visit(self.is_seen_), visit(self.is_armed_), visit(self.is_passing_), visit(self.is_past_tongue_),
      visit(self.is_upstream_);
  visit(self.n_recirculations_), visit(self.entered_), visit(self.wholly_in_), visit(self.reached_outlet_), visit(self.exited_);
  for (auto& c : self.contact_.values)
    visit(c.begin), visit(c.last), visit(c.begin_angle), visit(c.is_stuck), visit(c.stuck), visit(c.contact);
  visit(self.wall_contact_);
  for (auto& time : self.volute_.time) visit(time);
  for (auto& radius_time : self.volute_.radius_time) visit(radius_time);
  visit(self.max_tension_), visit(self.max_tension_time_), visit(self.max_tension_angle_);
  for (int c = 0; c < 3; ++c) visit(self.max_tension_place_[c]);
}

std::vector<double> PassageTracker::state() const {
  std::vector<double> state;
  for_each_state_value(*this, [&](const auto& number) { state.push_back(static_cast<double>(number)); });
  for (const Entry& entry : log_) state.insert(state.end(), {entry.time, entry.angle, static_cast<double>(entry.what)});
  return state;
}

void PassageTracker::restore(const std::vector<double>& state) {
  auto next = state.begin();
  for_each_state_value(*this, [&](auto& number) { number = static_cast<std::remove_reference_t<decltype(number)>>(*next++); });
  log_.clear();
  for (; next != state.end(); next += 3) log_.push_back({next[0], next[1], static_cast<PassageEvent>(next[2])});
}

}  // namespace snag
