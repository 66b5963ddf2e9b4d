// SPDX-License-Identifier: MIT
#include "live_status/live_status.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "servo/safety/limiter.hpp"
#include "session/messages/silence_reason.hpp"

namespace hapticd::live_status {
namespace {

std::string textOf(const char* text, size_t size) {
  return {text, strnlen(text, size)};
}

void quantiles(const status::SharedHistogram& histogram, double* to) {
  to[0] = histogram.quantile(0.5), to[1] = histogram.quantile(0.99), to[2] = histogram.max();
}

/// Returns the line of the model in a place of the page. @param tick number of the page's last tick
ModelLine modelLine(const status::Page& page, uint32_t i, const status::Name& name, uint64_t tick) {
  constexpr uint64_t kFresh = 50;  // [ticks] a model whose last step is longer ago is far from the tip
  ModelLine line;
  line.name = textOf(name.text, sizeof name.text);
  line.plugin = textOf(name.kind, sizeof name.kind);
  line.now = page.model[i].now.read().value_or(status::ModelStatus{});
  line.feet = page.feet[i].read().value_or(status::ModelFeet{});
  const status::SharedHistogram& step = page.model[i].step_us;
  line.p50 = step.quantile(0.5), line.p99 = step.quantile(0.99), line.max = step.max();
  line.traced = line.now.tick + kFresh >= tick && std::isfinite(line.now.depth);
  if (!line.traced) line.now.force = 0;
  line.silenced = servo::silenceReason(line.name, servo::fileOfPlugin(line.plugin),
                                       static_cast<servo::ShapeFault>(line.now.trouble), line.now.failed_status);
  return line;
}

}  // namespace

std::string ModelLine::end() const {
  return status::nameOfEnd(now.at_end);
}

double ArmLine::force() const {
  return std::hypot(now.force[0], now.force[1], now.force[2]);
}

std::string ArmLine::fault() const {
  const auto fault = static_cast<servo::Fault>(now.fault);
  return fault == servo::Fault::kNone ? "" : servo::describe(fault);
}

LiveStatus readPage(const status::Page& page) {
  LiveStatus live;
  live.now = page.now.read().value_or(status::TickStatus{});
  live.rate = page.rate;
  quantiles(page.lateness_us, live.late);
  quantiles(page.compute_us, live.compute);
  for (uint32_t i = 0; i < std::min(page.arms, status::kMaxArms); ++i) {
    const auto name = page.arm[i].name.read().value_or(status::Name{});
    live.arms.push_back({textOf(name.text, sizeof name.text), textOf(name.kind, sizeof name.kind),
                         page.arm[i].now.read().value_or(status::ArmStatus{})});
  }
  for (uint32_t i = 0; i < status::kMaxModels; ++i)
    if (const auto name = page.model[i].name.read().value_or(status::Name{}); name.text[0] != '\0')
      live.models.push_back(modelLine(page, i, name, live.now.tick));
  live.clients = diagnostics::clientsOf(page);
  live.answer_time = page.answer_time;
  return live;
}

void sortModels(std::vector<ModelLine>& models, const std::string& by) {
  std::sort(models.begin(), models.end(), [&](const ModelLine& a, const ModelLine& b) {
    if (by == "force") return a.now.force > b.now.force;
    if (by == "name") return a.name < b.name;
    if (by == "depth") {
      const auto depth = [](const ModelLine& m) { return m.traced ? m.now.depth : -HUGE_VAL; };
      return depth(a) > depth(b);
    }
    return a.p99 != b.p99 ? a.p99 > b.p99 : a.name < b.name;
  });
}

}  // namespace hapticd::live_status
