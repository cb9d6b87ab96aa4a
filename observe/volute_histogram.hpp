#pragma once
// Where in the volute rags stay, how far from the shaft, and what happens to them there, by 20-degree bins of the angle of the centroid.
//
//   angle    about the shaft, zero at the tongue, counter-clockwise positive seen from the inlet (Jensen 2018, Fig. B.2); whole turns are
//            taken off
//   share    time in the bin over the time in all bins, of all rags
//   radius   sum r dt/sum dt of all rags in the bin; its sigma is that of the rags' own means (Fig. B.8: mean distance to the impeller's
//            centre over the angle)
//   events   counted in the bin in which the centroid was when they were reported
#include <array>
#include <string>
#include <vector>

#include "observe/outcome.hpp"

namespace snag {

inline constexpr int n_volute_bins = 18;
/// Of an angle in rad, any number of turns; 0 begins at the tongue.
int volute_bin(double angle);

/// Of one rag.
struct VoluteStay {
  std::array<double, n_volute_bins> time{}, radius_time{};  // s; integral of the radius over time, m s

  /// rad, m, s
  void add(double angle, double radius, double duration);
};

class VoluteHistogram {
 public:
  void add(const VoluteStay& rag) { rags_.push_back(rag); }
  void add(const VoluteHistogram& other);
  /// At an angle in rad; others than those of `events` are not counted.
  void count(PassageEvent event, double angle);

  static constexpr std::array events{PassageEvent::recirculated, PassageEvent::stuck_on_tongue, PassageEvent::stuck_on_impeller,
                                     PassageEvent::tongue_passed, PassageEvent::exited};
  int n_rags() const { return static_cast<int>(rags_.size()); }
  int n_events(PassageEvent event, int bin) const;
  /// s, of a bin and of all.
  double time(int bin) const;
  double time() const;
  /// Not a number as long as there is no time.
  double share(int bin) const { return time(bin) / time(); }
  /// m; not a number in a bin without time.
  double radius(int bin) const;
  /// m; not a number with fewer than two rags in the bin.
  double radius_deviation(int bin) const;

  /// A row a bin, header with units.
  std::string csv() const;
  /// Time, rags and events in a line.
  std::string words() const;

 private:
  std::vector<double> radii(int bin) const;  // of the rags that were there

  std::vector<VoluteStay> rags_;
  std::array<std::array<int, n_volute_bins>, events.size()> n_events_{};
};

}  // namespace snag
