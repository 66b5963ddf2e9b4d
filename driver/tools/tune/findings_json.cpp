// SPDX-License-Identifier: MIT
#include <cmath>
#include <nlohmann/json.hpp>

#include "tune/page.hpp"

namespace hapticd::tune {
namespace {

using Json = nlohmann::ordered_json;

Json candidateJson(const Findings& findings, const Candidate& c) {
  Json settings = Json::object();
  for (size_t i = 0; i < findings.knobs.size(); ++i)
    settings[findings.knobs[i].name()] = findings.knobs[i].values[c.choice[i]];
  return {{"settings", settings},
          {"p50_ns", c.cost.p50_ns},
          {"p99_ns", c.cost.p99_ns},
          {"bytes", c.cost.bytes},
          {"foot_um", c.error.foot_m * 1e6},
          {"depth_um", c.error.depth_m * 1e6},
          {"normal_deg", c.error.normal_deg},
          {"force_n", c.error.force_n},
          {"untraced", c.error.untraced},
          {"ambiguous", c.error.ambiguous},
          {"on_front", c.on_front},
          {"p50_interval_ns", {c.cost.p50_low_ns, c.cost.p50_high_ns}},
          {"point", c.point > 0 ? Json(c.point) : Json()}};
}

Json servoJson(const Findings& findings) {
  Json rates = Json::array(), radii = Json::array(), estimators = Json::array();
  for (const RateRow& row : findings.rates)
    rates.push_back({{"rate_hz", row.rate}, {"load", row.load}, {"hold_error_n", row.hold_error_n}});
  for (const RadiusRow& row : findings.radii)
    radii.push_back({{"radius_m", row.radius},
                     {"tick_ns", row.tick_ns},
                     {"foot_um", row.error.foot_m * 1e6},
                     {"untraced", row.error.untraced}});
  for (const EstimatorRow& row : findings.estimators)
    estimators.push_back({{"estimator", row.estimator},
                          {"tick_ns", row.tick_ns},
                          {"force_p99_n", row.force_p99_n},
                          {"force_max_n", row.force_max_n}});
  return {{"rates", rates}, {"radii", radii}, {"estimators", estimators}};
}

Json touchesJson(const Findings& findings) {
  Json all = Json::array();
  for (const Touches& of : findings.tuning.touches)
    all.push_back({{"model", of.model},
                   {"ticks", of.ticks},
                   {"nearest_m", std::isfinite(of.nearest_m) ? Json(of.nearest_m) : Json()}});
  return all;
}

}  // namespace

std::string json(const Findings& findings) {
  Json all = Json::array();
  for (const Candidate& c : findings.tuning.candidates) all.push_back(candidateJson(findings, c));
  const std::string stopped = stoppedWhy(findings);
  Json json{{"scene", findings.scene},
            {"chosen", findings.tuning.chosen},
            {"reached", findings.tuning.reached},
            {"complete", findings.tuning.complete},
            {"reason", reason(findings)},
            {"candidates", all}};
  json.update(servoJson(findings));
  json["noise"] = {{"foot_um", kErrorNoise * 1e6}, {"force_n", kForceNoise}, {"p50_relative", kCostNoise}};
  json["touches"] = touchesJson(findings);
  json["stopped"] = stopped.empty() ? Json() : Json(stopped);
  return json.dump(2) + "\n";
}

}  // namespace hapticd::tune
