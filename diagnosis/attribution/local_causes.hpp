#pragma once
// Effects that act from a time on, or beyond a plane, only,
//
//   strength(t, x) = theta where the gate g is open, else 0,   log Z(k) = log of the mean of Z(k, g) over the places of the gate
//
// The places are scanned on a grid with the linear model of a screening. At the best of them the effect is fitted, and around the fit the
// evidence is a function of the place (profile): the linear model of the fit with the runs of each place.
#include "diagnosis/attribution/gates.hpp"
#include "diagnosis/data/verdict.hpp"
#include "diagnosis/fitting/fit.hpp"

namespace snag {

/// An effect of the library behind the gate that looks best in the scan.
struct ScannedLocal {
  int effect = 0;
  GateFamily family;
  double place = 0, theta = 0, log_evidence = 0;
};

struct LocalScan {
  double best_everywhere = 0;         // log evidence of the best effect that acts everywhere, by the same linear model
  std::vector<ScannedLocal> found{};  // of each effect in each family the best, the best first
};

/// Runs of a scan, a training point.
int runs_of_scan(const Responses& model, const std::vector<int>& candidates, const std::vector<GateFamily>& families);
/// Around the base model.
LocalScan scan_local_causes(Responses& model, const Fitter& fitter, const std::vector<int>& candidates,
                            const std::vector<GateFamily>& families);

/// Where the gate of a local effect was fitted without other effects.
struct LocalPlace {
  GateFamily family;
  double place = 0, step = 0;  // step: that of a profile which shows the evidence beside the place
  double log_share = 0;        // log evidence of all places less that of the gate's own
};

struct LocalFit {
  Fit fit;  // its evidence is that of all places
  LocalCause cause;
  LocalPlace place;
};

/// `effect`: a local one (Responses::add_local), whose gate is moved to where the evidence is largest. Refits while `affordable` says yes.
LocalFit fit_local_cause(Responses& model, Fitter& fitter, int effect, const ScannedLocal& scanned,
                         const std::function<bool(int runs_per_point)>& affordable);

/// LocalPlace::log_share of a fit of the local effect and others, which may move the place that is best. Takes runs_of_places() runs a
/// training point.
double log_share_beside_others(Responses& model, const Fitter& fitter, const Fit& fit, int effect, const LocalPlace& alone);
int runs_of_places();

}  // namespace snag
