// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "live_status/live_status.hpp"

namespace hapticd::live_status {

using Json = nlohmann::ordered_json;

namespace {

Json jsonOfClients(const LiveStatus& live) {
  Json clients = Json::array();
  for (const diagnostics::ClientStatus& client : live.clients)
    clients.push_back({{"device", client.report.device},
                       {"program", client.report.program},
                       {"pid", client.report.pid},
                       {"answers", client.report.answers},
                       {"same_tick", client.report.sameTick()},
                       {"next_tick", client.report.nextTick()},
                       {"silences", client.report.silences},
                       {"force_n", client.force},
                       {"largest_n", client.report.largest_n}});
  return clients;
}

}  // namespace

Json toJson(const LiveStatus& live) {
  const auto three = [](const double* q) { return Json{{"p50", q[0]}, {"p99", q[1]}, {"max", q[2]}}; };
  Json devices = Json::array(), models = Json::array();
  for (const ArmLine& arm : live.arms)
    devices.push_back({{"name", arm.name},
                       {"module", arm.module},
                       {"force_n", arm.force()},
                       {"tip_m", arm.now.position},
                       {"samples", arm.now.sequence},
                       {"valid", arm.now.valid != 0},
                       {"fault", arm.now.fault == 0 ? Json() : Json(arm.fault())}});
  for (const ModelLine& m : live.models)
    models.push_back({{"name", m.name},
                      {"plugin", m.plugin},
                      {"step_us", {{"p50", m.p50}, {"p99", m.p99}, {"max", m.max}}},
                      {"force_n", m.now.force},
                      {"depth_mm", m.traced ? Json(m.now.depth * 1e3) : Json()},
                      {"iterations", m.now.iterations},
                      {"gain", m.now.gain},
                      {"feet", {{"nearest", m.feet.nearest}, {"held", m.feet.held}, {"degraded", m.feet.degraded}}},
                      {"status", m.now.status},
                      {"silenced", m.silenced.empty() ? Json() : Json(m.silenced)},
                      {"waits", m.now.waits != 0},
                      {"end", m.end().empty() ? Json() : Json(m.end())}});
  return {{"seconds", live.now.t},
          {"ticks", live.now.tick},
          {"rate_hz", live.rate},
          {"held_hz", live.held},
          {"overruns", live.now.overruns},
          {"missed_ticks", live.now.missed},
          {"lateness_us", three(live.late)},
          {"compute_us", three(live.compute)},
          {"devices", devices},
          {"models", models},
          {"clients", jsonOfClients(live)}};
}

}  // namespace hapticd::live_status
