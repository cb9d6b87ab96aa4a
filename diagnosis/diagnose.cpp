#include "diagnosis/diagnose.hpp"

#include "diagnosis/attribution.hpp"
#include "diagnosis/how_far.hpp"
#include "diagnosis/judgement.hpp"
#include "diagnosis/next_experiment.hpp"
#include "diagnosis/where.hpp"

namespace snag {

Verdict diagnose(const Experiment& experiment, Simulator& simulator, const DiagnosisOptions& options) {
  Verdict verdict;
  verdict.name = experiment.name;
  verdict.data_sha256 = experiment.data_sha256, verdict.withheld_sha256 = experiment.withheld_sha256;
  Responses model(experiment, simulator);
  Fitter fitter(model);
  Attribution attribution = attribute(model, fitter, options.progress);
  const int chosen = judge(model, attribution, verdict);
  verdict.identifiability = attribution.identifiability;
  verdict.identifiability.next_experiment = next_experiment(model, attribution);
  verdict.where = gap_cells(model, fitter);
  if (options.progress) options.progress("withheld points", 0.9);
  measure_shrinkage(model, attribution, chosen, verdict);
  verdict.runs = simulator.n_runs();
  return verdict;
}

}  // namespace snag
