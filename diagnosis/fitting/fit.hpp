#pragma once
// The fit of one hypothesis (none, one effect, two) to the training points, and its Laplace evidence:
//
//   Phi = 1/2 |rho|^2 + 1/2 |nu|^2 + 1/2 |xi|^2 + 1/2 |t|^2,   rho = C^-1/2 (y - f(theta, nu, xi)),   t = (theta - mean)/sd
//   log Z = log of the integral of exp(-Phi) over nu, xi and the physical range of theta - 1/2 log |2 pi C| - 1/2 log of the other rows'
//   variance ratios
//
// xi: shares of the other forms under which the laws of the effects are written (State::shares). The spread between them is what is known
// of the form of a law, so one of them in full is one standard deviation.
// C = data + numerics (from two time steps) + scatter of the runs/N + form error of each effect; the last three at the fitted state.
#include <Eigen/Dense>
#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "diagnosis/fitting/response.hpp"
#include "diagnosis/statistics/linear_model.hpp"

namespace snag {

/// The covariances of the points with their factors.
struct Whitening {
  std::vector<Eigen::LLT<Eigen::MatrixXd>> factor;  // by training point, Gaussian rows
  std::vector<double> log_ratio;                    // by training point, of the other rows' variances over those of their data
  double log_determinant = 0;                       // of 2 pi C, over all of them, and the ratios
};

/// What is known of the model at one state: everything that the covariance and the linear model of a hypothesis need.
struct Linearization {
  State state;
  std::vector<Response> responses;                  // by training point
  std::vector<Eigen::VectorXd> numerical_error;     // f(2 dt) - f(dt) less chance, or as stated, by training point
  std::vector<std::vector<Response>> by_nuisance;   // [nuisance][training point] after half a standard uncertainty; empty: not there
  std::vector<std::vector<Response>> by_share;      // [other form][training point] with half more of it
  std::vector<Response> origin;                     // responses that these two depart from
  std::vector<double> origin_theta;                 // strengths of the effects there
  std::vector<std::vector<Eigen::VectorXd>> parts;  // [effect of the hypothesis][training point]: what it adds to f
};

/// Shares of an effect's contribution that its law may be wrong by, at one standard deviation; which of them holds is part of a
/// hypothesis. Laws of forces on particles differ by about a tenth between authors in the ranges where they are used; an operating point
/// or a scale is exact. Without it a spurious second effect absorbs the form error of the first.
inline constexpr std::array form_errors{0.0, 0.03, 0.1};
inline constexpr double widest_form_error = form_errors.back();

inline constexpr double nuisance_step = 0.5;  // standard uncertainties

struct Hypothesis {
  std::vector<int> effects;  // indices of Simulator::effects, in alphabetical order of their names
};
/// "none", "added_mass", "added_mass+lift".
std::string name_of(const Hypothesis& hypothesis, const std::vector<Effect>& effects);

struct Fit {
  Hypothesis hypothesis;
  Linearization at;  // the fitted state; its responses are those of the runs there
  Whitening whitening;
  LinearModel linear;          // around the fitted state: strengths in prior standard deviations, nuisances, shares of other forms
  LinearSolution solution;     // of it; d is what a last step would change
  std::vector<int> first_row;  // of each training point in rho, and the end
  double log_evidence = 0;     // over all errors of form
  double form_error = 0;       // the likeliest
  Eigen::VectorXd theta, theta_sd;
  Eigen::VectorXd residual;  // rho at the optimum of the linear model
};

/// Standard deviations by which what an effect of a fit adds is clear of nothing: z^2/2 is what Phi rises by where the effect is taken out
/// and all else is free. Its strength theta and the shares xi of its own forms come as theta g(xi), so that theta = 0 is no effect
/// whatever the forms, which then cost nothing:
///
///   z^2 = theta^2/var(theta | xi) - |xi|^2
///
/// Nuisances, other effects and their forms are integrated out. theta over its own standard deviation is smaller: that one says how well
/// the strength is known, and where one form is much stronger than another that is little, however clear the effect is.
double clear_of_nothing(const Fit& fit, std::size_t effect, const std::vector<Effect>& effects);

/// Step of a strength for a derivative: as wanted or back, where its range has room for that; else to the farther end of the range.
double step_within_range(const Effect& effect, double theta, double wanted);

class Fitter {
 public:
  explicit Fitter(Responses& model);

  const Linearization& base() const { return base_; }
  /// The state's responses, numerical error and derivatives by nuisances.
  Linearization linearize(const State& state, const Hypothesis& hypothesis);
  Whitening whiten(const Linearization& at, double form_error = widest_form_error) const;
  /// Residual over all training points.
  Eigen::VectorXd residual(const std::vector<Response>& responses, const Whitening& whitening) const;
  /// Derivative of the residual by the nuisances of a linearization, and by its shares of other forms.
  Eigen::MatrixXd nuisance_columns(const Linearization& at, const Whitening& whitening) const {
    return columns(at, at.by_nuisance, whitening);
  }
  Eigen::MatrixXd share_columns(const Linearization& at, const Whitening& whitening) const { return columns(at, at.by_share, whitening); }
  std::vector<int> first_rows() const;
  /// Runs a training point that a fit of so many effects takes, about; far from linear, or with many forms, it takes a multiple.
  int runs_of_fit(int n_effects) const;
  /// Runs that [budget] still allows, those for the gap before and after at the withheld points aside.
  int runs_left() const;
  using Runs = std::function<std::vector<Response>(const std::vector<Responses::Request>&)>;
  /// Where a run with an input or a strength moved from `origin` fails, or lacks rows that the origin has, what one with it moved to the
  /// other side, as far as its range goes, says of these rows; where that lacks them too, they do not change. `run` as the responses were
  /// made.
  void mirror_failed(const State& origin, const std::vector<Response>& at_origin, std::span<const Responses::Request> requests,
                     std::span<Response> responses, const Runs& run) const;
  /// Begins with these strengths and leading forms (by effect; empty: the first form of each). If another form then has most of the share,
  /// a second fit begins with it, and the better fit is returned. If the forms of an effect exclude each other, each form has its own fit;
  /// the best one is returned, and its evidence is the mean over the forms. No further fit begins if the budget does not allow it.
  Fit fit(const Hypothesis& hypothesis, const Eigen::VectorXd& start, const std::vector<int>& forms = {});

 private:
  Fit fit_with_best_leads(const Hypothesis& hypothesis, const Eigen::VectorXd& start, const std::vector<int>& forms);
  /// Fits the other forms of an effect whose forms exclude each other; `best` comes with one of them.
  void fit_exclusive_forms(Fit& best, std::size_t effect);
  bool may_fit(const Hypothesis& hypothesis) const;
  Fit fit_with_leads(const Hypothesis& hypothesis, const Eigen::VectorXd& start, const std::vector<int>& forms);
  Eigen::MatrixXd columns(const Linearization& at, const std::vector<std::vector<Response>>& moved, const Whitening& whitening) const;
  State state_of(const Fit& fit, const Eigen::VectorXd& x) const;
  Linearization start_from_base(const State& state);
  void add_shares(Linearization& at);
  /// States near a linearization: the leading forms are run, what the shares of the others add is taken from it, in proportion to the
  /// strength. Saves a run a form.
  std::vector<Response> run_near(const Linearization& at, const std::vector<Responses::Request>& requests);
  std::vector<Response> run_near(const Linearization& at, const State& state);
  Eigen::MatrixXd effect_columns(const Hypothesis& hypothesis, const Linearization& at, const Whitening& whitening);
  void descend(Fit& fit, Eigen::VectorXd& x, int iterations);
  void linearize_at_fit(Fit& fit, const Eigen::VectorXd& x, double form_error);
  double objective(const Fit& fit, const Eigen::VectorXd& x, const std::vector<Response>& responses) const;

  Responses& model_;
  Linearization base_;
};

/// Covariance of the Gaussian rows of one point.
Eigen::MatrixXd model_covariance(const PointSummary& point, const Response& response, const Eigen::VectorXd& numerical_error,
                                 const std::vector<const Eigen::VectorXd*>& parts, double form_error = widest_form_error);

}  // namespace snag
