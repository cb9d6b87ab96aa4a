#pragma once
// Fit of an effect where chance has a part: the effect itself is random, so that it shows in the mean and in the spread over replicates and
// seeds, or runs of the base model differ from seed to seed. Derivatives by differences of runs would be noise there, and a random effect
// changes the covariance. So the strengths are run on a grid, an emulator stands between them, and the evidence is an integral over the
// strength,
//
//   log Z = log of the integral of p(theta) Z(theta) over theta,   Z(theta): nuisances linear around the base model, integrated out.
#include "diagnosis/fitting/fit.hpp"

namespace snag {

/// Strengths at which an effect is run beside the base model: over what is expected of it, and few for a first look.
std::vector<double> emulated_strengths(const Effect& effect);
std::vector<double> first_strengths(const Effect& effect);

/// Where an emulated fit is run again: with how many seeds at which strength.
struct Refinement {
  double strength = 0;
  int n_seeds = 0;
};

/// Fit of one effect alone, in its leading form.
Fit fit_by_emulator(Responses& model, Fitter& fitter, int effect, const std::vector<double>& strengths, const Refinement& refinement = {});

}  // namespace snag
