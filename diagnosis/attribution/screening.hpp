#pragma once
// Screening by signatures: what each effect adds to the base model at its probe strength, with the same seeds. Linear in the strength, so
// used to choose what is worth re-simulating and to estimate before any data what is detectable; never for the verdict.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/fitting/fit.hpp"
#include "diagnosis/localisation/weak_form.hpp"

namespace snag {

struct Screened {
  Hypothesis hypothesis;
  double log_evidence = 0;
  Eigen::VectorXd theta;     // where the linear model puts the strengths
  std::vector<int> forms{};  // that lead, by effect
};

class Screening {
 public:
  /// Runs every candidate at its probe strength at the state of `fit` (no effect, or those of a fit already made).
  Screening(Responses& model, Fitter& fitter, const std::vector<int>& candidates, const Linearization& around);

  /// Evidence of a hypothesis: the effects around which was screened are free too.
  Screened screen(const Hypothesis& hypothesis) const;
  /// The same from another state: the input of this name is as stated, and `added` does what the deviation of the input did, by least
  /// squares. `added` is an effect of the hypothesis that is new beside the state around which was screened. A linear model alone does not
  /// reach as far as the deviation of an input that is far off. Minus infinity where the range of the effect does not allow it.
  Screened screen_in_place_of(const std::string& input, int added, const Hypothesis& hypothesis) const;
  /// Gain of one effect alone over none by the accelerations of the paths only (weak_form.hpp), nats; 0 where no path is long enough.
  double weak_gain(int candidate) const;
  /// d_k = sqrt(s (1 + J J^T)^-1 s): the signature s of a candidate over its uncertainty, nuisances projected out, without an error of
  /// form of the effects around which was screened: such an error takes up what is still missing.
  double detectability(int candidate) const;
  /// What one standard deviation of its prior changes, in standard deviations of the data.
  double change_of_one_sd(int candidate) const;
  /// Whether any run with a candidate, in any of its forms, differs from that without it.
  bool changes_runs(int candidate) const;
  /// Why no run with a candidate in its leading form came through; empty: one did.
  std::string failure(int candidate) const;
  /// Cosine between two signatures in that metric.
  double cosine(int a, int b) const;
  /// Share of placebo effects (signatures that run backwards in time with random signs by point) that beat every candidate alone.
  double placebo_rate(std::uint64_t seed) const;
  const std::vector<int>& candidates() const { return candidates_; }
  /// Signatures by row of a training point, not whitened.
  const Eigen::VectorXd& signature(int candidate, int training_point) const {
    return signatures_.at(candidate).front()[static_cast<std::size_t>(training_point)];
  }

 private:
  /// Whitened rows with one error of form of the effects around which was screened.
  struct Metric {
    Whitening whitening;
    Eigen::VectorXd rho;
    Eigen::MatrixXd nuisances, nuisance_covariance;
    /// Of two columns, nuisances projected out.
    double product(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const;
  };
  /// Where the linear model begins; its derivatives are those of the state around which was screened.
  struct Start {
    Eigen::VectorXd strengths;  // of the effects of the hypothesis
    Eigen::VectorXd nuisances;
    std::vector<Response> responses;
  };
  Screened screen_from(const Start& start, const Hypothesis& hypothesis) const;
  Metric metric(double form_error) const;
  Eigen::VectorXd column(int effect, int form, const Whitening& whitening, const Eigen::VectorXd& rho) const;
  bool present(int effect) const;
  Eigen::VectorXd strengths_there(const Hypothesis& hypothesis) const;
  LinearModel linear_model(const Hypothesis& hypothesis, const Start& start) const;
  void screen_leads(const Start& start, LinearModel& linear, Screened& result) const;
  void screen_shares(const Start& start, LinearModel& linear, Screened& result) const;
  Eigen::MatrixXd share_columns(const Screened& screened, const Whitening& whitening, const Eigen::VectorXd& rho) const;

  Responses& model_;
  Fitter& fitter_;
  std::vector<int> candidates_;
  Linearization around_;
  Metric metric_, exact_;  // with the widest error of form, and with none
  std::optional<WeakForm> weak_form_;
  // By candidate and form; an effect around which was screened has the form that leads there only.
  std::map<int, std::vector<std::vector<Response>>> probed_;
  std::map<int, std::vector<std::vector<Eigen::VectorXd>>> signatures_;
  std::map<int, std::vector<Eigen::VectorXd>> columns_;  // per prior standard deviation of theta, whitened
};

/// Strength at which an effect is probed: its prior mean, or one standard deviation where the mean is near zero.
double probe_strength(const Effect& effect);

}  // namespace snag
