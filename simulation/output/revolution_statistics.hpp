#pragma once
// Statistics of what a turning shaft does to a signal: samples over the angle, revolution by revolution. Arithmetic only.
//
//   between samples a signal f is linear in the angle theta; the steps need not divide a revolution
//   mean over a revolution       exact integral of the linear pieces over 2 pi
//   harmonics                    f ~ m + sum_n A_n cos(n theta - phi_n), n = 1 .. 20, least squares over the samples of the revolution,
//                                each weighted with its share of the angle: exact for such signals at any step that resolves them
//   noise                        rms of what these leave of f
//
// theta is the angle of the rotor in the frame of the casing: A_n cos(n theta - phi_n) has a crest where theta = phi_n/n.
#include <array>
#include <cstdint>
#include <vector>

namespace snag {

/// A complete revolution, or the part of one that is done. Its first point, and its last one unless a sample falls there, are interpolated.
struct Revolution {
  std::int64_t number = 1;                  // 1 for the first
  double start_angle = 0, direction = 1;    // angle at its begin, rad; -1 for a rotor that turns left-handed about its axis
  std::vector<double> turned;               // [points] since its begin, 0 .. 1 revolutions, rising
  std::vector<std::vector<double>> values;  // [points][quantities]
  bool ends_with_sample = true;

  /// rad, in the frame of the casing.
  double angle(std::size_t point) const;
};

/// Mean over the angle; of the samples where the shaft has not turned.
double revolution_mean(const Revolution& revolution, std::size_t quantity);
/// Of the first n quantities.
std::vector<double> revolution_means(const Revolution& revolution, std::size_t n);
/// Of one instant: value(now) of each entry of a table of quantities.
template <class Table, class Instant>
std::vector<double> values_of(const Table& quantities, const Instant& now) {
  std::vector<double> values;
  for (const auto& quantity : quantities) values.push_back(quantity.value(now));
  return values;
}

/// Lowest and highest sample.
struct Extremes {
  double lowest = 0, highest = 0;
};
Extremes revolution_extremes(const Revolution& revolution, std::size_t quantity);

struct Harmonic {
  double amplitude = 0, phase = 0;  // A, in the unit of the signal; phi, rad, -pi .. pi
};
struct Spectrum {
  std::vector<Harmonic> harmonics;  // n = 1, 2 ... as far as there are four samples for each, at most max_harmonics
  double noise = 0;                 // rms of the rest
};
constexpr std::size_t max_harmonics = 20;
Spectrum revolution_spectrum(const Revolution& revolution, std::size_t quantity);

/// Cuts a stream of samples into revolutions. A revolution begins and ends where the shaft has turned by whole revolutions since its start.
class RevolutionSampler {
 public:
  /// `start_angle`: of the rotor when nothing has turned yet, rad.
  explicit RevolutionSampler(double start_angle = 0) { current_.start_angle = start_angle; }
  /// One sample; `turned`: rad since the start, positive or negative, never back. Returns the revolutions that it completes. What lies
  /// before the first sample is taken to be like it.
  std::vector<Revolution> add(double turned, const std::vector<double>& values);
  /// What is done of the one that is going on.
  const Revolution& current() const { return current_; }

  /// The same after a resume.
  std::vector<double> state() const;
  void restore(const std::vector<double>& state);

 private:
  Revolution current_;
};

/// Mean and scatter of signals at each angle over revolutions: what repeats, and what does not.
class PhaseAverage {
 public:
  PhaseAverage(std::size_t n_bins, std::size_t n_quantities);
  /// A complete revolution; `quantities` of it are taken.
  void add(const Revolution& revolution, const std::vector<std::size_t>& quantities);
  std::int64_t n_revolutions() const { return static_cast<std::int64_t>(n_revolutions_); }
  std::size_t n_bins() const { return n_bins_; }
  /// Middle of a bin, rad in 0 .. 2 pi.
  double angle(std::size_t bin) const;
  /// Mean over a bin and all revolutions.
  double mean(std::size_t bin, std::size_t quantity) const;
  /// Standard deviation of a bin's mean from revolution to revolution (n - 1); zero for a single one.
  double deviation(std::size_t bin, std::size_t quantity) const;

  std::vector<double> state() const;
  void restore(const std::vector<double>& state);

 private:
  std::size_t n_bins_, n_quantities_;
  double n_revolutions_ = 0;
  std::vector<double> mean_, squares_;  // [n_bins][n_quantities]: mean, and sum of squared differences from it
};

}  // namespace snag
