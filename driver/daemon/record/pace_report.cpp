// SPDX-License-Identifier: MIT
#include "record/pace_report.hpp"

#include <fmt/format.h>

namespace hapticd::record {
namespace {

constexpr uint64_t kFew = 10;  ///< fewer slow ticks are not reported, because any machine is late in some ticks

/// Returns how many values are above a bound. Values in the same bucket as the bound do not count.
uint64_t above(const Histogram& h, double bound) {
  uint64_t count = 0;
  for (int i = Histogram::bucketOf(bound) + 1; i < Histogram::kBuckets; ++i) count += h.count(i);
  return count;
}

/// Names a model whose steps compute for longer than a period. After a slow step, the steps are measured by processor
/// time only, so a shape that sleeps shows only in its longest step.
std::string slowText(const ModelReport& model, double period_us, uint64_t least_part) {
  const Histogram& step = model.contact.stepUs();
  const uint64_t slow = above(step, period_us);
  if (slow < kFew || slow * least_part < step.total()) return "";
  const double typical = step.quantile(1 - 0.5 * static_cast<double>(slow) / static_cast<double>(step.total()));
  return fmt::format("slow: {} took {:.2g} ms in {} ticks; the period is {:.2g} ms: find the cause with {}\n",
                     model.name, typical * 1e-3, slow, period_us * 1e-3, checkCommand(model));
}

/// Names the model whose longest step alone delayed the loop, even if it happened only once.
std::string heldUpText(const RunReport& report, double period_us) {
  constexpr double kVirtual = 50;  // [periods] shorter steps are not reported in virtual time, because there the wall
                                   // clock measures them, which includes the time of other programs
  if (!report.virtual_time && report.missed_ticks == 0) return "";
  const ModelReport* slowest = nullptr;
  for (const ModelReport& model : report.models)
    if (slowest == nullptr || model.contact.stepUs().max() > slowest->contact.stepUs().max()) slowest = &model;
  const double most = slowest != nullptr ? slowest->contact.stepUs().max() : 0;
  if (most <= period_us * (report.virtual_time ? kVirtual : 1)) return "";
  const std::string missed = fmt::format("{} ticks were missed, and ", report.missed_ticks);
  return fmt::format(
      "slow: {}{} took {:.2g} ms in its longest step; the period is {:.2g} ms: {} shows whether it "
      "waits, or whether the machine was busy with something else\n",
      report.virtual_time ? "" : missed, slowest->name, most * 1e-3, period_us * 1e-3, checkCommand(*slowest));
}

}  // namespace

std::string paceText(const RunReport& report, double asked_hz) {
  if (!(asked_hz > 0)) return "";
  const double period_us = 1e6 / asked_hz;
  const uint64_t late = above(report.compute_us, period_us), all = report.compute_us.total();
  std::string text;
  // In virtual time only the wall clock is known. It includes the time of other programs on a busy machine.
  for (const ModelReport& model : report.models) text += slowText(model, period_us, report.virtual_time ? 20 : 1000);
  if (report.virtual_time && late >= kFew && late * 20 >= all)
    text += fmt::format(
        "slow: {} of {} ticks took longer than their period of {:.2g} ms: "
        "at this cost {:.0f} Hz would not be held on a real clock\n",
        late, all, period_us * 1e-3, asked_hz);
  if (text.empty() && late >= kFew && late * 20 >= all)
    for (const ModelReport& model : report.models)
      if (const double most = model.contact.stepUs().max(); most > period_us)
        text += fmt::format(
            "slow: {} of {} ticks took longer than the period of {:.2g} ms, and {} up to {:.2g} ms, although it "
            "computes little: {} shows whether it waits\n",
            late, all, period_us * 1e-3, model.name, most * 1e-3, checkCommand(model));
  return text.empty() ? heldUpText(report, period_us) : text;
}

}  // namespace hapticd::record
