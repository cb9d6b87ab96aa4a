// Stay of rags over the angle of the volute, on paths whose shares are known.
#include "observe/volute_histogram.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace snag;

namespace {

constexpr double degree = std::numbers::pi / 180;

/// Round the volute in steps of 5 degrees, `turns` times from the tongue on; a step takes 1/72 s, on the far half twice as long.
VoluteStay orbit(double radius, int turns, int sense = 1) {
  VoluteStay stay;
  for (int k = 0; k < 72 * turns; ++k) {
    const double angle = 2.5 + 5 * k;
    stay.add(sense * angle * degree, radius, std::fmod(angle, 360) > 180 ? 2.0 / 72 : 1.0 / 72);
  }
  return stay;
}

}  // namespace

TEST(VoluteHistogram, BinsBeginAtTheTongue) {
  EXPECT_EQ(volute_bin(0), 0);
  EXPECT_EQ(volute_bin(19.9 * degree), 0);
  EXPECT_EQ(volute_bin(20.1 * degree), 1);
  EXPECT_EQ(volute_bin(-0.1 * degree), 17);
  EXPECT_EQ(volute_bin((720 + 359.9) * degree), 17);
  EXPECT_EQ(volute_bin((-720 - 90) * degree), 13);
  EXPECT_EQ(volute_bin(-1e-300), 17) << "not past the last bin by round-off";
}

TEST(VoluteHistogram, OrbitOfKnownShares) {
  // Requirement: each bin of the near half holds 1/27 of the time, of the far half 2/27, whatever the number of turns and their sense.
  for (const int turns : {1, 3})
    for (const int sense : {1, -1}) {
      VoluteHistogram histogram;
      histogram.add(orbit(0.12, turns, sense));
      EXPECT_NEAR(histogram.time(), 1.5 * turns, 1e-12);
      for (int bin = 0; bin < n_volute_bins; ++bin) {
        const bool far = sense > 0 ? bin >= 9 : bin < 9;
        EXPECT_NEAR(histogram.share(bin), (far ? 2.0 : 1.0) / 27, 1e-12) << bin;
        EXPECT_NEAR(histogram.radius(bin), 0.12, 1e-12);
        EXPECT_TRUE(std::isnan(histogram.radius_deviation(bin)));
      }
    }
}

TEST(VoluteHistogram, RagsAreWeightedByTheirTime) {
  // Requirement: two turns at 0.12 m and one at 0.09 m have their mean at 0.11 m and, between the rags, a deviation of 0.03/sqrt 2 m; a rag
  // that stays at 350 degrees for 3 s adds there alone.
  VoluteHistogram all, one;
  all.add(orbit(0.12, 2)), one.add(orbit(0.09, 1));
  VoluteStay stuck;
  stuck.add(350 * degree, 0.11, 3);
  one.add(stuck), all.add(one);
  EXPECT_EQ(all.n_rags(), 3);
  EXPECT_NEAR(all.radius(4), 0.11, 1e-12);
  EXPECT_NEAR(all.radius_deviation(4), 0.03 / std::numbers::sqrt2, 1e-12);
  EXPECT_NEAR(all.share(4), (3.0 / 18) / 7.5, 1e-12);
  EXPECT_NEAR(all.time(17), 3 + 6.0 / 18, 1e-12);
}

TEST(VoluteHistogram, EventsAreCountedWhereTheyWereTold) {
  VoluteHistogram histogram, other;
  histogram.count(PassageEvent::recirculated, (360 + 21) * degree), histogram.count(PassageEvent::stuck_on_tongue, 359 * degree);
  other.count(PassageEvent::recirculated, 30 * degree), other.count(PassageEvent::exited, -100 * degree),
      other.count(PassageEvent::entered, 0);
  histogram.add(other);
  EXPECT_EQ(histogram.n_events(PassageEvent::recirculated, 1), 2);
  EXPECT_EQ(histogram.n_events(PassageEvent::stuck_on_tongue, 17), 1);
  EXPECT_EQ(histogram.n_events(PassageEvent::exited, 13), 1);
  EXPECT_NE(histogram.words().find("0 rags, 0 s, recirculated 2, stuck on tongue 1"), std::string::npos) << histogram.words();
  const std::string csv = histogram.csv();
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + n_volute_bins);
  EXPECT_NE(csv.find("\n20,40,0,"), std::string::npos);
  EXPECT_NE(csv.find("recirculated [1],stuck_on_tongue [1],stuck_on_impeller [1],tongue_passed [1],exited [1]\n"), std::string::npos);
}
