// SPDX-License-Identifier: MIT
#include "cli/run/outcome.hpp"

#include <cmath>
#include <cstdio>
#include <utility>

#include "cli/support/command.hpp"
#include "log/log.hpp"
#include "record/allocation_text.hpp"
#include "record/pace_report.hpp"
#include "record/picture.hpp"
#include "record/report.hpp"
#include "tune/stability.hpp"

namespace hapticd::cli {

namespace {

std::vector<record::Sample> samplesOf(const servo::Telemetry& telemetry) {
  std::vector<record::Sample> samples;
  for (const servo::BlackBoxRow& row : telemetry.blackBox()) {
    record::Sample sample;
    sample.t = row.t;
    const bool traced = row.model != UINT32_MAX;
    sample.depth_m = traced ? static_cast<double>(row.depth_m) : std::nan("");
    sample.model = traced ? static_cast<int>(row.model) : -1;
    sample.force_n = std::hypot(row.force[0], row.force[1], row.force[2]);
    sample.asked_n = std::nan("");  // unknown: the black box has only the force that was sent
    sample.fault = row.fault;
    sample.lateness_us = static_cast<double>(row.lateness_us);
    sample.compute_us = static_cast<double>(row.compute_us);
    samples.push_back(sample);
  }
  return samples;
}

record::RunNotes notesOf(const servo::Runner& runner) {
  constexpr size_t kMostEvents = 100'000;
  record::RunNotes notes;
  for (const scene::Model& model : runner.scene().models) notes.models.push_back(model.name);
  if (!runner.scene().devices.empty()) notes.force_limit_n = runner.scene().devices[0].limits.force;
  uint64_t next = 0;
  for (const hapticd_event& event : runner.telemetry().flight()->events(next, kMostEvents))
    if (event.kind == HAPTICD_SILENCED)
      notes.moments.emplace_back(event.t, (static_cast<size_t>(event.model) < notes.models.size()
                                               ? notes.models[static_cast<size_t>(event.model)]
                                               : std::string("a model")) +
                                              " is silenced");
  return notes;
}

record::LimitReport limitsOf(const servo::Runner& runner, size_t arm) {
  const servo::Limiter& limiter = runner.arms()[arm]->limiter();
  const servo::SentForce& sent = runner.telemetry().sent(arm);
  record::LimitReport report{.device = runner.scene().devices[arm].name,
                             .sent_max_n = sent.largest,
                             .faults = limiter.faults(),
                             .fault_ticks = sent.fault_ticks,
                             .not_enabled_ticks = sent.not_enabled,
                             .swing_hz = runner.telemetry().swing(arm).fastest(),
                             .complies = runner.scene().devices[arm].admittance.has_value(),
                             .any = limiter.clips().any,
                             .ticks = {}};
  for (size_t i = 0; i < servo::kLimitCount; ++i)
    if (const uint64_t ticks = limiter.clips().ticks[i]; ticks > 0)
      report.ticks.emplace_back(servo::nameOf(static_cast<servo::Limit>(i)), ticks);
  return report;
}

/// Returns the program whose force the first arm gave, if no model of these rows was touched; else "". Of several
/// programs, it is the one that pushed hardest.
std::string onlyPusher(const std::vector<servo::BlackBoxRow>& rows, const record::RunReport& report) {
  for (const servo::BlackBoxRow& row : rows)
    if (row.model != UINT32_MAX && row.depth_m > 0) return "";
  const record::ClientReport* hardest = nullptr;
  for (const record::ClientReport& client : report.clients)
    if (client.device == report.limits[0].device && client.largest_n > (hardest == nullptr ? 0 : hardest->largest_n))
      hardest = &client;
  return hardest == nullptr ? "" : "process " + std::to_string(hardest->pid) + " (" + hardest->program + ")";
}

/// Warns if the first arm gave more force over the last seconds than it sustains. The black box keeps the forces of the
/// first arm.
void warnOfHeat(const servo::Runner& runner, const record::RunReport& report) {
  constexpr double kHeatSeconds = 5;  // a shorter time does not heat a winding
  std::vector<double> forces;
  const std::vector<servo::BlackBoxRow> rows = runner.telemetry().blackBox();
  for (const servo::BlackBoxRow& row : rows) forces.push_back(std::hypot(row.force[0], row.force[1], row.force[2]));
  if (runner.arms().empty() || static_cast<double>(forces.size()) < kHeatSeconds * report.rate_hz) return;
  const hdv_info& info = runner.arms()[0]->info();
  const double sustained = (info.capabilities & HDV_C_FORCE_ASSUMED) != 0 ? 0 : info.continuous_force;
  const std::string text =
      tune::overheating(runner.scene().devices[0].name, sustained, forces, report.rate_hz, onlyPusher(rows, report));
  if (!text.empty()) log::write(HSP_LOG_WARNING, "", text);
}

/// Returns the report of a run. @param faults messages that it contains beside those of faults that ended by themselves
record::RunReport reportOf(const RunOutcome& outcome, servo::Runner& runner, std::vector<std::string> faults) {
  for (std::string& text : runner.recovered()) faults.push_back(std::move(text));
  record::RunReport report = runner.telemetry().report(faults);
  report.scene = outcome.scene;
  report.virtual_time = outcome.virtual_time;
  report.wall_seconds = static_cast<double>(runner.wallTime()) * kSecondsPerNanosecond;
  report.start_ms = static_cast<double>(runner.loop().firstTick() - outcome.program_start) * 1e-6;
  for (record::ModelReport& model : report.models)
    for (const servo::ModelState& state : runner.world().core().models())
      if (state.shape != nullptr && state.shape->name() == model.name) {
        model.moves = state.moves;
        model.size_m = state.shape->report().size_m;
        model.degraded_ticks = state.degraded_ticks;
        model.coarsest = state.coarsest;
        model.residual_m = state.degraded_residual;
      }
  report.resident_bytes = runner.residentBytes();
  report.answer_time = runner.scene().clients.answer_time;
  for (size_t i = 0; i < runner.arms().size(); ++i) report.limits.push_back(limitsOf(runner, i));
  return report;
}

}  // namespace

int conclude(const RunOutcome& outcome, servo::Runner& runner) {
  std::vector<std::string> faults = runner.faults();
  faults.insert(faults.end(), outcome.left_out.begin(), outcome.left_out.end());
  const record::RunReport report = reportOf(outcome, runner, faults);
  std::fputs((record::summary(report) + record::allocationText(report, mostAllocations()) +
              record::paceText(report, outcome.rate))
                 .c_str(),
             stdout);
  std::fflush(stdout);  // the summary is printed even if a plugin crashes while it is deactivated
  warnOfHeat(runner, report);
  if (const record::Recorder* recorder = runner.recorder())
    std::printf("  recorded  %s: %llu ticks, %llu rows lost\n", outcome.record.c_str(),
                static_cast<unsigned long long>(recorder->rows(servo::kTicks)),
                static_cast<unsigned long long>(recorder->lost()));
  if (!outcome.report.empty())
    if (auto written = record::writeJson(report, outcome.report); !written) return fail(kFailed, written.error());
  if (!outcome.picture.empty())
    if (auto drawn = record::drawRun(report, samplesOf(runner.telemetry()), notesOf(runner), outcome.picture); !drawn)
      return fail(kFailed, drawn.error());
  for (const auto& [what, file] : {std::pair("report", &outcome.report), std::pair("picture", &outcome.picture)})
    if (!file->empty()) std::printf("  %-8s  %s\n", what, file->c_str());
  if (!runner.recorded()) return fail(kFailed, runner.recorded().error());
  return faults.empty() ? kWorked : kFailed;
}

}  // namespace hapticd::cli
