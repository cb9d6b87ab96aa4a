#pragma once
// Calibration of a cloth at one particle radius, in the order of Jensen (2018), section 3.4.1: normal stiffness and strength from the
// elongation test, bending stiffness from the cantilever, tangential stiffness from the drape.
//
// S_t also bends a strip a little (the shear of its bonds), so for each S_t that the drape tries, S_nb is found anew: the cantilever holds
// exactly whatever S_t is chosen.
#include <mpi.h>

#include <functional>
#include <string>
#include <vector>

#include "textile/cantilever.hpp"
#include "textile/drape_samples.hpp"
#include "textile/elongation.hpp"
#include "textile/textile_tests.hpp"

namespace snag {

struct CalibrationSettings {
  double radius = 1.5e-3;     // r_p, m
  bool as_published = false;  // clamps of the elongation test counted twice
  int n_seeds = 4;            // of the drape at the S_t that is chosen; two at the others
  std::function<void(const std::string&)> report_progress = [](const std::string&) {};  // progress, in words
};

/// What the drape says of one tangential stiffness.
struct DrapePoint {
  std::array<BondProperties, 2> bond{};  // S_t in both, S_nb that fits the cantilever with it
  std::vector<DrapeSample> samples;
  double area = 0, wave_size = 0, wave_count = 0;  // means
  double area_spread = 0, wave_size_spread = 0;    // standard deviations of the seeds
  double misfit = 0;                               // sum of squares of deviation over tolerance
  double tangential_stiffness() const { return bond[0].tangential_stiffness; }
};

/// The bending test of one direction, as simulated with the bonds that were chosen.
struct BendingFit {
  StripShape shape;
  double height = 0;        // of the tip above the plane, m
  MeasuredRange stiffness;  // S_nb at the smallest and the largest overhang that were measured, N/m3; if given
};

struct Calibration {
  CalibrationSettings settings;
  std::array<BondProperties, 2> bond{};
  ContactRadiusBounds contact_radius;
  std::array<GrabTest, 2> grab;
  std::array<BendingFit, 2> bending;
  std::vector<DrapePoint> drapes;  // rising in S_t
  std::size_t chosen = 0;
  MeasuredRange tangential_range;  // S_t whose drapes are within the tolerances, N/m3
  RagSheet sheet;                  // the first seed of the chosen drape; rank 0 only
};

/// Deviations of a drape that a fit accepts (those of the published one), from the measured mean.
inline constexpr double area_tolerance = 0.07, wave_size_tolerance = 0.03, wave_count_tolerance = 1;

/// Bonds at this tangential stiffness: S_n of the elongation test, S_nb of the cantilever.
std::array<BondProperties, 2> bonds_at(const TextileTests& tests, const CalibrationSettings& settings, double tangential_stiffness);

/// Runs of the drape are shared out over the ranks; the result is the same on all of them and on any number. Collective. Throws
/// Error(usage) on tests that no cloth gives, Error(diverged).
Calibration calibrate(MPI_Comm comm, const TextileTests& tests, const CalibrationSettings& settings);

}  // namespace snag
