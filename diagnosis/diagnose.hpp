#pragma once
// Diagnosis of the sim-to-real gap: where it lies, which unmodelled effect causes it, how far it shrinks once that effect is added.
//
//   y = f(theta, nu) + e,   e ~ N(0, C),   nu ~ N(0, u^2),   theta ~ N(mean, sd^2) within its range
//
// y: means of the replicates over time bins; f: runs of the model; nu: nuisances, free in every hypothesis; theta: the strengths of the
// effects of one hypothesis (none, one, two). C holds noise, scatter, numerics and the form error of the effects. Hypotheses compete by
// their Laplace evidence, with a Gaussian process without physics ("outside") among them. docs/theory.md, "Diagnosis".
#include <functional>
#include <string>

#include "diagnosis/data/experiment.hpp"
#include "diagnosis/data/simulator.hpp"
#include "diagnosis/data/verdict.hpp"

namespace snag {

struct DiagnosisOptions {
  /// Told at the beginning of each stage: what, and the share of the work that is done (0 to 1).
  std::function<void(const std::string& stage, double done)> progress{};
};

/// Judges the experiment. Collective: every rank calls it and gets the same verdict. Throws Error(usage) where data and runs do not fit.
Verdict diagnose(const Experiment& experiment, Simulator& simulator, const DiagnosisOptions& options = {});

}  // namespace snag
