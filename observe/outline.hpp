#pragma once
// Outline of a blob about a given centre, as the drape test reads it: how far the blob reaches in each direction, and its waves, the peaks
// of that curve (Jensen 2018, Fig. 2.12).
#include <vector>

#include "observe/coverage.hpp"

namespace snag {

/// A peak of the outline.
struct Wave {
  double angle = 0;   // rad, from `right`, counter-clockwise
  double radius = 0;  // m
};

struct Outline {
  double area = 0;             // m2
  std::vector<double> radius;  // [n_directions] m, smoothed; direction i is at 2 pi i/n_directions
  std::vector<Wave> waves;     // counter-clockwise

  double mean_wave_size() const;  // m; the mean radius where there is no wave
  double smallest_wave() const;   // m; 0 without waves
};

struct OutlineSettings {
  double centre_x = 0, centre_y = 0;  // m
  int n_directions = 720;
  double smoothing = 0.05;   // width of the running mean that is taken twice, rad: what a picture's pixels and single particles add
  double prominence = 2e-3;  // m: a peak counts if the outline falls by that on both sides before it rises above the peak
};

/// The farthest covered pixel in each direction.
Outline outline(const Coverage& picture, const OutlineSettings& settings);

/// The same from a curve that is smooth already, such as that of another outline.
Outline outline_from(std::vector<double> radius, double area, const OutlineSettings& settings);

}  // namespace snag
