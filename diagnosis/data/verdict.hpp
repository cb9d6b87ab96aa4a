#pragma once
// What a diagnosis says: where the gap lies, which effect causes it, how far it shrinks; and verdict.json.
#include <array>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "diagnosis/data/posterior_draws.hpp"
#include "diagnosis/data/simulator.hpp"
#include "diagnosis/data/verdict_kinds.hpp"

namespace snag {

/// A cell of "where" that no single point shows is of all of them.
inline constexpr const char* all_points = "all points";

/// One cell of "where": an observable in a window of time at an operating point.
struct GapCell {
  std::string observable, region = "all", point;
  std::array<double, 2> window{};          // s; both NaN for scalars of a replicate
  double measured = 0, simulated = 0;      // means over the window, SI (events: fractions)
  double u_num = 0, u_input = 0, u_D = 0;  // standard uncertainties: numerics, inputs (flow field included), data (bias and scatter/n)
  double u_S = 0;                          // scatter of the simulation over the number of runs, as a standard uncertainty
  double u_val = 0;                        // of the difference
  double z = 0;                            // (simulated - measured)/u_val; of exact tests the normal score of their p
  double p = 1;                            // two-sided, of the best test, times the number of tests
  double score = 0;                        // normal score of p, with the sign of the difference
  double score_after = std::numeric_limits<double>::quiet_NaN();  // the same of what the fit that the verdict rests on leaves
  CellTest test = CellTest::z;
  bool withheld = false, significant = false, onset = false, blind = false;
  double restart_z =
      std::numeric_limits<double>::quiet_NaN();  // z of a run that goes on from the measured state at the begin of the window
  GapOrigin origin = GapOrigin::not_judged;
};

/// The mean missing acceleration about a time of a path: force over mass, N/kg, along x, y, z; NaN along an axis that was not measured.
struct MissingForce {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  std::string point;
  double time = 0;                                         // s
  double speed = 0;                                        // m/s, of the measured path there
  std::array<double, 3> place{unknown, unknown, unknown};  // m, measured
  std::array<double, 3> before{unknown, unknown, unknown},
      u{unknown, unknown, unknown};                        // with the inputs fitted; its standard uncertainty
  std::array<double, 3> after{unknown, unknown, unknown};  // with the fit that the verdict rests on
};

/// Simulation and data of one observable at one operating point over time, in the unit of the data, each value a mean over a bin of time
/// (lognormal: a geometric mean).
struct GapCurve {
  std::string observable, unit, point;
  std::vector<double> time{};         // s
  std::vector<double> measured{};     // mean of the replicates
  std::vector<double> u{};            // its standard uncertainty: noise, scatter and bias
  std::vector<double> base{};         // base model, inputs as they are expected
  std::vector<double> with_effect{};  // what the verdict rests on, strengths and inputs fitted; empty: it names no effect
};

/// Posterior of the strength of an effect.
struct EffectEstimate {
  double mean = 0, sd = 0;
  std::map<std::string, double> per_point{};  // fitted to one operating point alone
  double cochran_p = 1;                       // that the operating points agree
  bool absorbing = false;                     // more than 3 prior standard deviations off: it takes up something else
  std::string unit = "1";
};

/// 1 - excess gap after / before, on withheld operating points, with the 95 % interval.
struct Shrinkage {
  double mean = 0, low = 0, high = 0;
};

/// Mean squares over the cells of the withheld points, in units of u_D^2.
struct GapBars {
  bool computable = false;  // three withheld points or more have rows that base model and chosen hypothesis answer, and no run failed
  double before = 0, after = 0, floor = 0, remainder = 0;
};

/// A condition that was not measured: an input of a point times a factor.
struct NewCondition {
  std::string point, input;
  double factor = 1;
  std::string observable;               // that tells most there
  double nats = 0, nats_of_repeat = 0;  // of one test there; of one more repeat where that tells most
  double cost = 1;                      // of the test, in repeats
};

/// What the experiment can detect, before any data are used.
struct Identifiability {
  std::map<std::string, double> detectability{};                   // d_k: prior-mean signature over its uncertainty; below 3 it is blind
  std::map<std::string, std::map<std::string, double>> cosines{};  // between nuisance-projected signatures
  std::vector<std::vector<std::string>> ties{};
  std::map<std::string, std::string> blind{};  // effect -> why this base case or these data cannot show it
  std::string next_experiment;
  std::vector<NewCondition> new_conditions{};  // of a tie: those that tell twice as much per cost as a repeat or more, the best first
};

/// A posterior predictive check of the first hypothesis.
struct PredictiveCheck {
  std::string name;  // chi2 | lag1_autocorrelation | max_abs_z | energy_distance
  double value = 0, p = 1;
};

/// A named effect and what it does to the gap at the training points.
struct Cause {
  std::string effect;
  double share = std::numeric_limits<double>::quiet_NaN();  // of the square of the gap; all causes and what stays unexplained sum to 1
  double nats = std::numeric_limits<double>::quiet_NaN();   // of evidence that are lost without it; NaN: the rest was not fitted
};

/// Where an effect begins to act: from a time on, or beyond a plane.
struct LocalCause {
  std::string effect;       // of the library
  std::string coordinate;   // t, x, y or z
  std::string unit;         // s or m
  bool is_upwards = true;   // it acts above the place
  double mean = 0, sd = 0;  // of the place
};

/// Noise of an observable that its repeats show, where it is not as stated (noise.hpp).
struct NoiseFound {
  double factor = 1, correlation_time = 0;  // over noise_u; s
  double nats = 0;                          // by which the repeats speak for it
};

/// A sample of a path that no noise makes, and that was left out (outliers.hpp).
struct OutlierRow {
  int line = 0;  // of the data file
  std::string point;
  int replicate = 0;
  double time = 0;  // s
};
struct OutlierRows {
  double share = 0, nats = 0;  // of the samples of the observable; by which the data speak for outliers
  std::vector<OutlierRow> rows{};
};

/// The model as the verdict improves it: with the named effects at their fitted strengths, inputs as fitted.
struct ImprovedModel {
  std::vector<RunRequest> runs{};  // by operating point; empty: the verdict names no effect
  double off_by_forms = 0;         // largest difference of these runs, each law in its leading form, from the fitted mixture of forms, in u
  std::vector<std::string> files{};  // the cases of the points that were written
  std::string why_none{};            // in a sentence; empty: there are files
};

struct Verdict {
  std::string name;  // of the experiment
  VerdictKind verdict = VerdictKind::none;
  std::vector<std::string> effects{};  // of the first hypothesis that names effects; for outside: the best effect, partial and no cause
  std::map<std::string, std::vector<std::string>> same_as{};  // named effect -> other names of the same cause: nothing tells them apart
  double p_effects = 0;                                       // that all of them act, under one of these names, alone or with others
  Wording wording = Wording::no_gap;
  std::vector<std::string> alternatives{};        // other causes that the data do not tell from the named ones by the nats of the rule
  std::vector<std::string> tie{};                 // hypotheses that share the verdict of a tie
  std::map<std::string, double> probability{};    // of each hypothesis
  std::map<std::string, double> acts{};           // of each effect: that it acts, alone or with another
  std::map<std::string, double> log_evidence{};   // re-simulated hypotheses, with the choice of a remainder, nats, relative to none
  std::map<std::string, double> remainder{};      // of them: nats that a small unexplained remainder brings
  std::map<std::string, double> screening{};      // the same by signatures only
  std::map<std::string, double> weak_form{};      // of single effects by the accelerations of the paths only, relative to none
  std::map<std::string, double> leave_one_out{};  // log predictive density, one operating point left out at a time, relative to none
  std::vector<Cause> causes{};                    // of a verdict that names effects, in their order
  std::map<std::string, LocalCause> local{};      // of the effects of the hypotheses that act in a part only, by name: "lift@t"
  double unexplained = std::numeric_limits<double>::quiet_NaN();  // share of the gap that stays beside them; NaN: no effect is named
  std::map<std::string, EffectEstimate> parameters{};
  std::map<std::string, double> nuisances{};      // fitted deviations under the first hypothesis, in standard uncertainties; name@points
  std::map<std::string, NoiseFound> noise{};      // by observable; absent: as stated
  std::map<std::string, OutlierRows> outliers{};  // by observable; absent: none
  PosteriorDraws posterior{};                     // of the hypothesis that the parameters are of
  ImprovedModel improved{};
  std::vector<PredictiveCheck> checks{};
  std::vector<std::string> notes{};  // guards that spoke, in sentences
  double placebo_rate = 0;           // of placebo effects that a screening would have chosen
  std::vector<GapCell> where{};
  std::vector<MissingForce> missing_force{};              // of the training points; empty: no path of a position is long enough
  std::vector<GapCurve> curves{};                         // of the largest differences
  std::map<std::string, Shrinkage> shrinkage{};           // of the chosen effect, by hypothesis
  std::map<std::string, Shrinkage> shrinkage_rejected{};  // of the others that were fitted
  Shrinkage shrinkage_regression;                         // of a correction without physics
  GapBars gap;
  Identifiability identifiability;
  int runs = 0;
  std::string data_sha256, withheld_sha256;
};

/// The content of verdict.json.
std::string verdict_json(const Verdict& verdict);

}  // namespace snag
