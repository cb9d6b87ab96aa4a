#pragma once
// A set of the blind benchmark in the making: its truth, and runs of it. More than a diagnosis will know.
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "benchmark/blind/twin_points.hpp"
#include "benchmark/blind/twin_unmodelled.hpp"
#include "casework/case_run.hpp"
#include "casework/point_case.hpp"
#include "diagnosis/score/sealed_set.hpp"

namespace snag {

/// An uncertain input: key and relative standard uncertainty.
struct TwinInput {
  std::string key;
  double u = 0;
  /// A set-point of the flow is one of its own at every point; all else is the same everywhere.
  bool of_each_point() const { return key.starts_with("flow.amplitude"); }
};

struct TwinSet {
  static constexpr std::size_t n_withheld = 3;  // the last points

  std::string twin;
  std::uint64_t run_seed = 1;
  TwinExperiment experiment;
  Truth truth;
  std::vector<PointCase> cases{};                           // of the truth: with its own drag law
  std::set<std::string> random{};                           // effects of the truth that are other ones in each replicate
  std::map<std::string, std::string> forms{};               // by effect: the value of a key that chooses the other functional form
  std::vector<std::map<std::string, double>> deviations{};  // relative, of the inputs, by point
  Vec3 picture_centre{};                                    // about which the camera's scale is wrong
  UnmodelledTruth unmodelled{};

  std::size_t n_training() const { return experiment.cases.size() - n_withheld; }
  std::vector<TwinInput> inputs() const;
  /// What a subset of the observables asks of a point, in the order of the instruments; without a name that of the truth.
  std::vector<ObservableRequest> asked(const std::string& subset) const;
  std::vector<ObservableRequest> asked() const { return asked(truth.subset); }
  const TwinInstrument& instrument(const std::string& id) const;
  /// Values without noise at a point with these effects in the form of the truth, and what is not in the library if `unmodelled_acts`.
  std::vector<double> values(std::size_t point, const std::vector<ObservableRequest>& asked, const std::map<std::string, double>& theta,
                             bool unmodelled_acts, const std::map<std::string, double>& input_deviations, int replicate = 0) const;
  /// With all that is true, or without what the truth adds.
  std::vector<double> true_values(std::size_t point, const std::vector<ObservableRequest>& asked, int replicate = 0) const {
    return values(point, asked, truth.theta, true, deviations[point], replicate);
  }
  std::vector<double> base_values(std::size_t point, const std::vector<ObservableRequest>& asked,
                                  const std::map<std::string, double>& deviation) const {
    return values(point, asked, {}, false, deviation);
  }
  /// Difference of two runs in the terms in which noise is stated: of logarithms if lognormal, the short way if an axis; 0 where one has no
  /// value.
  double difference(const std::string& observable, double with, double without) const;
};

/// Effects of the library that the experiment can show: at their expected strength, by all observables and ten replicates, 3 standard
/// uncertainties clear of the inputs. What moves the samples less tells nothing of a diagnosis. To be asked while the set has no truth yet.
std::vector<Effect> showable(const TwinSet& set);
/// Fills in how clearly what acts stands out of noise and uncertain inputs, over the training points.
void measure_gap(TwinSet& set);
/// Nothing in it tells the number of the set, and with it what is in it.
std::string twin_diagnosis(const TwinSet& set, int seed);
/// The measurement: true values with noise and bias; what did not happen until the end is censored.
std::string twin_data(const TwinSet& set, NormalNumbers& random);

}  // namespace snag
