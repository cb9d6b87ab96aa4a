#pragma once
// Runs of the model, brought to the rows of the data: what a state of the model (strengths of effects, deviations of nuisances) answers at
// each operating point.
#include <Eigen/Dense>
#include <map>
#include <string>
#include <vector>

#include "diagnosis/data/mistakes.hpp"
#include "diagnosis/data/summary.hpp"

namespace snag {

/// The model with some effects and some deviations of its inputs.
struct State {
  std::vector<std::pair<int, double>> effects{};  // index into Responses::effects, theta
  Eigen::VectorXd nuisances;                      // in standard uncertainties, by index of Nuisances
  std::vector<int> forms{};                       // that leads, by effect; what is not there: the first
  Eigen::VectorXd shares{};                       // of the other forms, in standard deviations, see other_forms(); what is not there: 0
  std::optional<Restart> restart{};               // of where the pieces are, on the way
  std::optional<Gate> gate{};                     // of an effect, in place of its own; absent: a local effect has its own, another none
  int form(std::size_t effect) const { return effect < forms.size() ? forms[effect] : 0; }
};

/// Another form of an effect than the one that leads. A state answers with the mixture
///   f = f_lead + sum over the other forms of sd share (f_form - f_lead),
/// so that what lies between or beyond the forms has a place too. The law that holds is taken to be one of the forms give or take a third
/// of what they differ by, unless these exclude each other; a deviation is one standard deviation as it is.
struct OtherForm {
  std::size_t effect = 0;  // position in State::effects
  int form = 0;
  double sd = 1;
};
std::vector<OtherForm> other_forms(const State& state, const std::vector<Effect>& effects);

/// What the runs of a state say at one point.
struct Response {
  Eigen::VectorXd value;    // by row: on the scale of Row::value (spread: variance over the seeds)
  Eigen::VectorXd scatter;  // by row: variance of one run, of few seeds that of the base model
  Eigen::MatrixXd paths;    // deviations of each seed from the mean, Gaussian rows x seeds; empty for one seed
  int n_runs = 1;
  int n_answers = 1;       // runs that its events and counts count as: where all seeds give the same, more than one (response.cpp)
  std::string failure;     // why none of its runs came through; empty: one did
  Eigen::VectorXd beyond;  // by row: standard uncertainty, where a mistake of times asks for what the runs do not reach (mistakes.hpp)
  Eigen::MatrixXd data_covariance{};     // of the Gaussian rows, where a mistake of a unit makes it another one; empty: that of the point
  std::vector<double> spread_noise_u{};  // by row, there too: standard deviation of a sample that the noise alone gives, of spreads
  std::vector<bool> later;               // by row: no run came to this time before it ended; `value` is the end
};

/// One deviation that is free in every hypothesis.
struct FreeNuisance {
  std::string name;
  double u = 0;              // relative (calibration groups: 1)
  std::vector<int> points;   // that share it
  int bias_observable = -1;  // an additive bias of this observable, which needs no runs; -1: an input of the simulator
  bool of_data = false;      // an error of the measurement, not of the model
  double bias = 0;           // its standard uncertainty, SI
};

/// The state with the leading forms only.
State lead_of(State state);
/// Zero for what has no number.
Eigen::VectorXd finite(const Eigen::VectorXd& values);
/// What was run beside the lead, beside the mixture: changes of inputs and steps are taken from the leading forms, which saves a run a
/// form.
Response beside(const Response& mixture, const Response& lead, Response moved);

class Responses {
 public:
  Responses(const Experiment& experiment, Simulator& simulator);

  const Experiment& experiment() const { return experiment_; }
  /// Those of the simulator, the mistakes that inputs and data may hold, the local ones.
  const std::vector<Effect>& effects() const { return effects_; }
  const std::vector<FreeNuisance>& nuisances() const { return nuisances_; }
  const std::vector<PointSummary>& points() const { return points_; }
  const std::vector<int>& training() const { return training_; }
  const std::vector<int>& withheld() const { return withheld_; }
  /// The base model answers with another result for another seed.
  bool base_is_random() const { return base_is_random_; }
  /// Adds an effect, which is that of index `of` behind a gate: "lift@t" from a time on, "lift@z" beyond a plane across z. References
  /// to effects() end. Returns its index.
  int add_local(int of, Gate gate);
  /// Gate of a local effect, with the name of the effect that it is of; null: acts everywhere.
  const Gate* gate_of(int effect) const;
  void set_gate(int local_effect, Gate gate);
  /// Null: it is no mistake.
  const Mistake* mistake(int effect) const;
  /// False of mistakes of the measurement: they change what a run answers with, so that their derivatives are exact whatever chance does.
  bool changes_runs(int effect) const;
  /// Seeds a state is run with, and as many as fill in the distribution that a random effect makes (where the base model is random, every
  /// run is dear, and these are the same).
  int n_seeds(const State& state) const;
  int n_seeds_of_distribution(const State& state) const;
  /// Runs that were asked for, whether made now or kept from before.
  int n_used() const { return simulator_.n_used(); }
  /// Runs that [budget] still allows.
  int runs_left() const { return experiment_.max_runs - simulator_.n_used(); }
  State base() const { return {{}, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(nuisances_.size()))}; }
  bool acts_at(int nuisance, int point) const;
  /// "flow.amplitude@A"; of what all points share its name alone.
  std::string name_of_nuisance(int nuisance) const;
  /// What of the data is not compared, in sentences.
  const std::vector<std::string>& notes() const { return notes_; }
  bool restarts(int point) const { return simulator_.restarts(point); }

  /// The run of a state at a point, with the leading forms and the first seed.
  RunRequest leading_run(const State& state, int point) const { return requests_of({lead_of(state), point}).front(); }

  struct Request {
    State state;
    int point = 0;
    double step_factor = 1;
    int n_seeds = 0;  // 0: as many as the state needs
  };
  /// One batch of runs.
  std::vector<Response> run(const std::vector<Request>& requests);
  /// The same state at several points.
  std::vector<Response> run(const State& state, const std::vector<int>& points, double step_factor = 1);

  /// Adds a share of the difference between two responses of a point, within what a row can be.
  void add_share(Response& sum, const Response& lead, const Response& other, double share, int point) const;

 private:
  bool acts_at_random(const State& state) const;
  int seeds_of(const Request& request) const { return request.n_seeds > 0 ? request.n_seeds : n_seeds(request.state); }
  std::vector<RunRequest> requests_of(const Request& request) const;
  struct Part {
    Request request;
    double share = 0;
  };
  std::vector<Part> parts_of(const Request& request) const;
  Response response(const Request& request, std::span<const RunResult> results, const std::vector<double>& u) const;
  void find_randomness();
  /// Scatter of the base model from more seeds, where a state has too few to know its own: two runs may be alike by chance, and a row that
  /// no hypothesis explains would decide between them by how alike they are. All states without a random effect then have it.
  void find_scatter();
  void note_rows_left_out(std::size_t point, const Response& answer);
  void leave_out_rows_without_answer(const std::vector<Response>& answers);
  void find_mistakes(const std::vector<Response>& answers);
  /// Under these mistakes, from the numbers in their right units.
  void find_noise_in_right_units();
  /// Data covariance of a state at a point; empty: as stated. And what a bias of an observable is to be multiplied by.
  Eigen::MatrixXd covariance_in_right_units(const State& state, int point) const;
  double factor_of_unit(const State& state, int observable) const;
  std::vector<double> spread_noise_in_right_units(const State& state, int point) const;
  /// Returns the largest uncertainty of the values, by slot; empty: there is none.
  std::vector<double> mismeasure(const State& state, int point, std::span<RunResult> results) const;

  /// Noise under a mistake of a unit, as numbers of the data: the covariance of the Gaussian rows, and by row what a spread has from it.
  struct InRightUnits {
    Eigen::MatrixXd covariance;
    std::vector<double> spread_noise_u;
  };

  const Experiment& experiment_;
  Simulator& simulator_;
  std::vector<Effect> effects_;
  std::vector<Mistake> mistakes_;                            // after the effects of the simulator
  std::vector<Gate> gates_;                                  // of the last of the effects
  std::map<int, std::vector<InRightUnits>> in_right_units_;  // by effect, of wrong units; by point
  std::vector<FreeNuisance> nuisances_;
  bool has_spread_;  // rows of the spread between replicates, for random effects
  std::vector<PointSummary> points_;
  std::vector<int> training_, withheld_;
  std::vector<std::string> notes_;
  std::vector<Eigen::VectorXd> scatter_of_base_;  // by point and row: variance of one run; empty: each state has its own
  bool base_is_random_ = false;
  int seeds_of_random_ = 8;
};

/// Residual of a response against the data: Gaussian rows whitened with the Cholesky factor of their covariance, then the others.
/// Of a time that no run came to, the model says that it is later than the end of the run, no more.
Eigen::VectorXd residual(const PointSummary& point, const Response& response, const Eigen::LLT<Eigen::MatrixXd>& covariance);
/// Sum over the rows that are not Gaussian of the logarithm of their variance ratio.
double log_variance_ratio(const PointSummary& point, const Response& response);

}  // namespace snag
