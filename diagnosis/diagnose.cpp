#include "diagnosis/diagnose.hpp"

#include "diagnosis/attribution.hpp"
#include "diagnosis/judgement.hpp"

namespace snag {

Verdict diagnose(const Experiment& experiment, Simulator& simulator, const DiagnosisOptions& options) {
  Verdict verdict;
  verdict.name = experiment.name;
  verdict.data_sha256 = experiment.data_sha256, verdict.withheld_sha256 = experiment.withheld_sha256;
  Responses model(experiment, simulator);
  Fitter fitter(model);
  Attribution attribution = attribute(model, fitter, options.progress);
  judge(model, attribution, verdict);
  verdict.identifiability = attribution.identifiability;
  verdict.runs = simulator.n_runs();
  return verdict;
}

}  // namespace snag
