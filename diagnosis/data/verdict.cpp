#include "diagnosis/data/verdict.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

namespace snag {

namespace {

using Json = nlohmann::ordered_json;

// JSON has no NaN: what could not be computed is null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json numbers(const std::map<std::string, double>& values) {
  Json json = Json::object();
  for (const auto& [name, value] : values) json[name] = number(value);
  return json;
}

Json cell(const GapCell& c) {
  Json json{{"observable", c.observable}, {"region", c.region}};
  json["window_s"] = std::isnan(c.window[0]) ? Json(nullptr) : Json{c.window[0], c.window[1]};
  json["point"] = c.point;
  json["z"] = number(c.z);
  json["significant"] = c.significant;
  json["onset"] = c.onset;
  json["blind"] = c.blind;
  json["p"] = number(c.p);
  json["test"] = word(c.test);
  json["score"] = number(c.score);
  json["score_after"] = number(c.score_after);
  json["withheld"] = c.withheld;
  json["measured"] = number(c.measured);
  json["simulated"] = number(c.simulated);
  json["u_val"] = number(c.u_val);
  json["u_num"] = number(c.u_num);
  json["u_input"] = number(c.u_input);
  json["u_D"] = number(c.u_D);
  json["u_S"] = number(c.u_S);
  json["restart_z"] = number(c.restart_z);
  json["origin"] = word(c.origin);
  return json;
}

Json missing_force(const MissingForce& f) {
  const auto vector = [](const std::array<double, 3>& v) { return Json{number(v[0]), number(v[1]), number(v[2])}; };
  return {{"point", f.point},           {"t_s", f.time},    {"place_m", vector(f.place)}, {"speed_m_s", number(f.speed)},
          {"before", vector(f.before)}, {"u", vector(f.u)}, {"after", vector(f.after)}};
}

Json curve(const GapCurve& c) {
  Json json{{"observable", c.observable}, {"unit", c.unit}, {"point", c.point}};
  const auto add = [&](const char* name, const std::vector<double>& values) {
    for (const double value : values) json[name].push_back(number(value));
  };
  add("t_s", c.time), add("measured", c.measured), add("u", c.u), add("base", c.base), add("with_effect", c.with_effect);
  return json;
}

Json parameter(const EffectEstimate& e) {
  return {{"mean", number(e.mean)},           {"sd", number(e.sd)},      {"unit", e.unit}, {"per_point", numbers(e.per_point)},
          {"cochran_p", number(e.cochran_p)}, {"absorbing", e.absorbing}};
}

Json shrinkage(const Shrinkage& s) { return {{"mean", number(s.mean)}, {"low", number(s.low)}, {"high", number(s.high)}}; }

Json identifiability(const Identifiability& i) {
  Json json{{"detectability", numbers(i.detectability)}, {"ties", i.ties}, {"next_experiment", i.next_experiment}, {"blind", i.blind}};
  json["new_conditions"] = Json::array();
  for (const NewCondition& c : i.new_conditions)
    json["new_conditions"].push_back({{"point", c.point},
                                      {"input", c.input},
                                      {"factor", c.factor},
                                      {"observable", c.observable},
                                      {"nats", number(c.nats)},
                                      {"nats_of_repeat", number(c.nats_of_repeat)},
                                      {"cost", number(c.cost)}});
  for (const auto& [name, row] : i.cosines) json["cosines"][name] = numbers(row);
  return json;
}

Json how_far(const Verdict& v) {
  if (!v.gap.computable) return "not computable";
  Json json = Json::object();
  for (const auto& [name, s] : v.shrinkage) json[name] = shrinkage(s);
  json["rejected"] = Json::object();
  for (const auto& [name, s] : v.shrinkage_rejected) json["rejected"][name] = shrinkage(s);
  json["regression"] = shrinkage(v.shrinkage_regression);
  return json;
}

}  // namespace

std::string verdict_json(const Verdict& v) {
  Json json{{"name", v.name}, {"verdict", word(v.verdict)},    {"effects", v.effects}, {"wording", word(v.wording)},
            {"tie", v.tie},   {"alternatives", v.alternatives}};
  json["same_as"] = v.same_as.empty() ? Json::object() : Json(v.same_as);
  json["probability"] = numbers(v.probability);
  json["acts"] = numbers(v.acts);
  json["causes"] = Json::array();
  for (const Cause& cause : v.causes)
    json["causes"].push_back({{"effect", cause.effect}, {"share", number(cause.share)}, {"nats", number(cause.nats)}});
  json["unexplained"] = number(v.unexplained);
  json["local"] = Json::object();
  for (const auto& [name, l] : v.local)
    json["local"][name] = {{"effect", l.effect},     {"coordinate", l.coordinate},
                           {"unit", l.unit},         {"acts", l.is_upwards ? "above" : "below"},
                           {"mean", number(l.mean)}, {"sd", number(l.sd)}};
  json["parameters"] = Json::object();
  for (const auto& [name, e] : v.parameters) json["parameters"][name] = parameter(e);
  json["where"] = Json::array();
  for (const GapCell& c : v.where) json["where"].push_back(cell(c));
  json["missing_force"] = Json::array();
  for (const MissingForce& f : v.missing_force) json["missing_force"].push_back(missing_force(f));
  json["curves"] = Json::array();
  for (const GapCurve& c : v.curves) json["curves"].push_back(curve(c));
  json["shrinkage"] = how_far(v);
  json["gap"] = v.gap.computable ? Json{{"before", number(v.gap.before)},
                                        {"after", number(v.gap.after)},
                                        {"floor", number(v.gap.floor)},
                                        {"remainder", number(v.gap.remainder)}}
                                 : Json("not computable");
  json["identifiability"] = identifiability(v.identifiability);
  json["evidence"] = {
      {"log_evidence", numbers(v.log_evidence)}, {"remainder", numbers(v.remainder)}, {"leave_one_point_out", numbers(v.leave_one_out)},
      {"screening", numbers(v.screening)},       {"weak_form", numbers(v.weak_form)}, {"sham_rate", v.placebo_rate}};
  json["nuisances"] = numbers(v.nuisances);
  json["noise"] = Json::object();
  for (const auto& [observable, noise] : v.noise)
    json["noise"][observable] = {
        {"factor", number(noise.factor)}, {"correlation_time_s", number(noise.correlation_time)}, {"nats", number(noise.nats)}};
  json["outliers"] = Json::object();
  for (const auto& [observable, found] : v.outliers) {
    Json rows = Json::array();
    for (const OutlierRow& row : found.rows)
      rows.push_back({{"line", row.line}, {"point", row.point}, {"replicate", row.replicate}, {"t_s", row.time}});
    json["outliers"][observable] = {{"share", number(found.share)}, {"nats", number(found.nats)}, {"rows", rows}};
  }
  json["checks"] = Json::object();
  for (const PredictiveCheck& check : v.checks) json["checks"][check.name] = {{"value", number(check.value)}, {"p", number(check.p)}};
  json["case_with_effects"] = {{"files", v.improved.files}, {"off_by_forms_u", number(v.improved.off_by_forms)}};
  if (!v.improved.why_none.empty()) json["case_with_effects"]["why_none"] = v.improved.why_none;
  json["notes"] = v.notes;
  json["runs"] = v.runs;
  json["data_sha256"] = v.data_sha256;
  json["withheld_sha256"] = v.withheld_sha256;
  return json.dump(1) + "\n";
}

}  // namespace snag
