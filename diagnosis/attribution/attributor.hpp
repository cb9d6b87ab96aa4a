#pragma once
// The steps of an attribution. For .cpp files of this folder only: attribution.cpp has their order, single_effects.cpp those up to the fits
// of single effects, further_effects.cpp pairs, rounds and rivals of the leader.
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "diagnosis/attribution/attribution.hpp"
#include "diagnosis/attribution/emulated_fit.hpp"
#include "diagnosis/attribution/local_causes.hpp"

namespace snag {

/// Shares of the prior: how many effects of the library a model lacks is a Poisson number of mean one, each effect as likely as the others;
/// a tenth is for what nobody listed, another for the mistakes that inputs and data may hold. To be named, an effect beyond the first has
/// to bring 6 nats (a surplus effect takes up what the others leave): a rule of the verdict, of which the probabilities know nothing.
inline constexpr double prior_none = 0.36, prior_effects = 0.36, prior_mistakes = 0.1;
/// A hypothesis is simulated again if the screening puts it at most max(screening_width, share_not_linear G) nats below the best. G: nats
/// of the best over those of the base model. The screening is linear, and its error grows with G. At least min_candidates are simulated.
/// Of second effects, which are screened around the fit of a first, G counts from that fit, and the share is larger: the linear model holds
/// the first effect where it stood alone. Of the nats that a pair brings, the screening shows the square of the cosine of the angle between
/// what the pair changes and what its linear model changes: one half at 45 degrees. Without this limit 31 pairs of 26 sets of development
/// (spheres of tests/other_programs) brought more than 20 nats over the first effect; 29 of them showed half of these or more, the median
/// all. The verdicts are the same with 0.5, 0.7 and 1; with 0.3 one of three effects that act is lost.
inline constexpr double screening_width = 10, share_not_linear = 0.05, share_of_second = 0.5, weak_form_threshold = 3;
inline constexpr int min_candidates = 3, max_candidates = 8, max_mistakes = 3, most_pairs = 5, most_pairs_around_base = 2,
                     n_screened_again = 3, most_effects = 5, most_a_round = 2;
/// Standard uncertainties of an effect at its expected strength. Below the first, these data are blind to it. Below the second, it changes
/// the evidence by half the square, 0.045 nats at most: a hypothesis with it is the same as the one without it.
inline constexpr double blind_detectability = 3, least_shown = 0.3;
/// Of the prior of an effect, for that it acts from a time on only, or beyond a plane only, each; and hypotheses of these that are fitted.
inline constexpr double share_local = 0.05;
inline constexpr int most_local = 3;
/// A member of a set that is z clear of nothing (clear_of_nothing) brings z^2/2 nats at most, less what its strength costs. Below this z it
/// cannot bring those of the rule, and the set is fitted without it.
inline const double weak = std::sqrt(2 * nats_of_rule);
/// Nats that an effect beyond the first has to promise in a screening to be fitted: the linear model may be off by some. And standard
/// uncertainties that it is expected to show beside the others.
inline constexpr double gain_wanted = nats_of_rule - 3, least_of_further = 1;

class Attributor {
 public:
  Attributor(Responses& model, Fitter& fitter, const std::function<void(const std::string&, double)>& progress)
      : model_(model), fitter_(fitter), progress_(progress) {}
  Attribution attribute();

 private:
  void report(const std::string& stage, double done) const;
  /// Whether this many runs a training point are still in the budget.
  bool affordable(int runs_per_point);
  int runs_of_emulator(int effect) const;
  /// Differences of runs that chance has a part in are no derivatives.
  bool by_emulator(const Hypothesis& hypothesis) const;
  int runs_of(const Screened& screened) const;
  Fit fit_of(const Screened& screened);
  Fit emulated(int effect, const Refinement& refinement = {});
  /// Few strengths first: what is far behind there need not be known better.
  void fit_random_effects();
  double prior_of(int k) const;
  /// Each effect is there or not whatever the others are.
  double log_prior(const Hypothesis& hypothesis) const;
  /// Effects beyond the first, and mistakes, have to bring the nats of the rule.
  double log_prior_of_verdict(const Hypothesis& hypothesis) const;
  void add(Fit fit);
  /// What all places of the gate of its local effect take from the evidence of a set that was screened or fitted at one place: by
  /// screening as much as from that effect alone, whose evidence is that of all places already.
  double screened_share_of_places(const Hypothesis& hypothesis) const;
  double fitted_share_of_places(const Fit& fit);
  /// A mistake that does the same as an effect (the flow of all points as operating_point, the viscosity of slow flow as drag_magnitude) is
  /// that effect.
  bool is_effect_by_another_name(const Screening& screening, int k) const;
  /// Of these other names, the inputs whose difference from an effect the data cannot show.
  void find_same_inputs(const Screening& screening, const std::vector<int>& other_names);
  void forget(const std::string& name);
  void identify(const Screening& screening);
  std::vector<Screened> screened_singles(const Screening& screening);
  /// What the paths keep, and what their accelerations speak for most: an offset or a drift may hide it from the paths.
  std::vector<Screened> kept(const std::vector<Screened>& singles) const;
  void fit_singles(const std::vector<Screened>& screened);
  /// Of effects whose fit brings less than half of what the screening promised, where runs are random.
  void note_screening(const std::vector<Screened>& screened);
  /// A strength at the edge of its range says little of where to begin: a tenth of the probe strength inside.
  Eigen::VectorXd start(const Screened& screened) const;
  /// The hypothesis that holds effect k too.
  Hypothesis with(Hypothesis hypothesis, int k) const;
  Hypothesis pair_of(int a, int b) const;
  /// The fits of single effects that are not random, the best first.
  std::vector<int> best_singles() const;
  /// Pairs: the best single effects with every other one, screened again around their fits. Where two effects act, the first screening is
  /// far from linear, and either of them, or a third that stands for both, may lead among the single ones.
  void fit_pairs(const Screening& first_screening);
  /// Further effects, one a round: around the leading fit, which holds what was found, the others are screened again, and what promises
  /// most is fitted with all that was found; then each effect that was there before is left out in its turn: it may have stood for what was
  /// missing. The rounds end where none brings a better hypothesis. They go by what the effects explain: a remainder beside a wrong effect
  /// could stand for those that are still missing. Where another set leads with its remainder at the end, there is a round around it, too:
  /// a remainder that brings evidence says that something is missing beside that set.
  void fit_in_rounds();
  /// Among the sets that do not hold effect `without` (-1: all). A mistake may stand for several effects: where one is part of the best
  /// set, the rounds go on without it, too.
  void fit_in_rounds(int without);
  /// One round around this fit.
  void fit_round(int found_so_far, int without);
  /// Rounds add one effect at a time, so that one that stands for two may stay. Each effect of the leader is exchanged for each other one,
  /// screened around the fit without it; what comes nearest to the leader, within the nats of the rule, is fitted. Its index; -1: none.
  int fit_exchange(int leader);
  bool is_fitted(const Hypothesis& hypothesis) const;
  /// Whether effect k acts in a part only in this hypothesis.
  bool is_in_part(const Hypothesis& hypothesis, int k) const;
  /// A fit without effect e of a fit, from where its other effects stand, where there is none yet; false where the budget ends.
  bool fit_without(const Fit& all, std::size_t e);
  /// Drop test: whatever the rounds came by, each member of the leading set that is less than `weak` clear of nothing is left out in its
  /// turn, and so on with what leads then. Sets less than the rule behind the leader are tested, too: a guard may let them lead.
  void fit_without_weak_members();
  /// A fit without each of the effects that were there before, where there is none yet.
  void fit_without_each(int larger, const Hypothesis& before);
  /// An effect that was screened only is behind the best fit by what it was behind in the screening; a random one, until it is fitted,
  /// brings nothing.
  void credit_other_singles(const std::vector<int>& live);
  /// Pairs that nobody looked at bring what the better of their effects brings, less what the other costs alone.
  void credit_other_pairs(const std::vector<int>& live);
  /// What looks like an effect of the leading hypothesis in this experiment may stand in its place: it is fitted, too, or the leader would
  /// seem surer than it can be.
  void fit_rivals_of_leader();
  /// The runs of an emulator do not fill in a distribution; the likeliest hypothesis must not be refused for what they lack.
  void refine_random_leader();
  bool look_alike(int a, int b) const;
  /// Effects that act in a part of the time or of the domain only, where one promises more than any that acts everywhere; with a round
  /// around it where it leads.
  void fit_local_causes();
  /// A hypothesis with effect k at place e, as strong by its own measure as what was there.
  Screened with_instead(const Hypothesis& hypothesis, const Eigen::VectorXd& theta, std::size_t e, int k) const;
  /// The input that a fit puts furthest from what is stated, and by how many of its standard uncertainties.
  std::pair<std::string, double> furthest_input(const Fit& fit) const;
  /// One more effect beside those of the fit around which was screened. Where an input is far off, the effect is screened in its place,
  /// too.
  Screened screened_beside(const Screening& screening, const Fit& found, int k) const;
  /// What the furthest input costs beyond chance, nats. A second effect that saves it lies further from the fit than a linear model
  /// reaches: its screened evidence is too low.
  double price_of_inputs(const Fit& fit) const;
  static std::vector<Screened> best_first(std::map<std::string, Screened>&& by_name);
  /// Pairs that look better than every single effect from the base model already.
  std::vector<Screened> pairs_around_base(const Screening& screening) const;

  Responses& model_;
  Fitter& fitter_;
  const std::function<void(const std::string&, double)>& progress_;
  Attribution result_;
  std::vector<int> candidates_, random_;
  std::map<int, LocalPlace> places_;    // of each local effect
  int n_singles_ = 1, n_mistakes_ = 0;  // live effects, mistakes
  double none_screened_ = 0;            // log evidence of the base model in the screening
};

}  // namespace snag
