#include "diagnosis/judgement/curves.hpp"

#include <algorithm>
#include <cmath>

#include "base/units.hpp"

namespace snag {

namespace {

/// The same observable at one point after the other tells little more.
constexpr int most_of_one_observable = 2;

/// The path of an observable at a training point; without times if it is not there.
GapCurve curve_of(const Responses& model, const Fitter& fitter, const Fit* effect, const std::string& id, std::size_t p) {
  const PointSummary& point = model.points()[model.training()[p]];
  GapCurve curve;
  curve.observable = id, curve.point = model.experiment().points[point.point].id;
  for (int i = 0; i < point.n_gaussian; ++i) {
    const Row& row = point.rows[i];
    const Observable& observable = model.experiment().observables[row.observable];
    if (observable.id != id || row.kind != Row::Kind::path) continue;
    const bool logarithm = observable.kind == Observable::Kind::lognormal;
    const double unit = parse_unit(observable.unit)->factor;
    const auto in_unit = [&](double value) { return (logarithm ? std::exp(value) : value) / unit; };
    const double u = std::sqrt(point.covariance(i, i) + observable.bias_u * observable.bias_u);
    curve.unit = observable.unit;
    curve.time.push_back(0.5 * (row.begin + row.end));
    curve.measured.push_back(in_unit(row.value));
    curve.u.push_back(logarithm ? in_unit(row.value) * u : u / unit);
    curve.base.push_back(in_unit(fitter.base().responses[p].value[i]));
    if (effect) curve.with_effect.push_back(in_unit(effect->at.responses[p].value[i]));
  }
  return curve;
}

}  // namespace

std::vector<GapCurve> gap_curves(const Responses& model, const Fitter& fitter, const Fit* effect, std::vector<GapCell> cells,
                                 std::size_t most) {
  std::stable_sort(cells.begin(), cells.end(), [](const GapCell& a, const GapCell& b) { return std::abs(a.score) > std::abs(b.score); });
  std::vector<GapCurve> curves;
  for (const GapCell& cell : cells) {
    const bool drawn = std::any_of(curves.begin(), curves.end(),
                                   [&](const GapCurve& c) { return c.observable == cell.observable && c.point == cell.point; });
    const auto alike = std::count_if(curves.begin(), curves.end(), [&](const GapCurve& c) { return c.observable == cell.observable; });
    if (drawn || alike == most_of_one_observable || curves.size() == most) continue;
    for (std::size_t p = 0; p < model.training().size(); ++p) {
      if (model.experiment().points[model.training()[p]].id != cell.point) continue;
      GapCurve curve = curve_of(model, fitter, effect, cell.observable, p);
      if (curve.time.size() > 1) curves.push_back(std::move(curve));
    }
  }
  return curves;
}

}  // namespace snag
