// SPDX-License-Identifier: MIT
#include "record/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/regular_file.hpp"
#include "base/shell_word.hpp"
#include "record/contact_warnings.hpp"

namespace hapticd::record {

namespace {

using Json = nlohmann::ordered_json;

Json quantiles(const Histogram& h) {
  return {{"p50", h.quantile(0.5)}, {"p99", h.quantile(0.99)}, {"p999", h.quantile(0.999)}, {"max", h.max()}};
}

Json contactJson(const ContactStatistics& c) {
  constexpr double kMm = 1e3;
  return {{"contact_ticks", c.contactTicks()},
          {"unfelt_ticks", c.unfeltTicks()},
          {"penetration_mm", {{"mean", c.meanDepth() * kMm}, {"std", c.stdDepth() * kMm}, {"max", c.maxDepth() * kMm}}},
          {"force_n", {{"mean", c.meanForce()}, {"max", c.maxForce()}}},
          {"buzz_mm", c.buzz() * kMm}};
}

Json pushesJson(const Pushes& pushes) {
  return {{"ticks", pushes.ticks}, {"force_max_n", pushes.max_force}};
}

Json modelJson(const ModelReport& model) {
  constexpr double kNs = 1e3;
  const Histogram& step = model.contact.stepUs();
  Json json = {{"plugin", model.plugin},
               {"degraded",
                {{"ticks", model.degraded_ticks}, {"level", model.coarsest}, {"residual_um", model.residual_m * 1e6}}}};
  json.update(contactJson(model.contact));
  json["feet"] = {{"nearest", model.contact.nearestFeet()},
                  {"held", model.contact.heldFeet()},
                  {"degraded", model.contact.degradedFeet()}};
  json["untraced"] = pushesJson(model.contact.untraced());
  json["depthless"] = pushesJson(model.contact.depthless());
  json["outside"] = pushesJson(model.contact.outside());
  json["pulls"] = pushesJson(model.contact.pulls());
  json["energy_j"] = {{"given", model.given_j}, {"taken", model.taken_j}, {"began", model.began_j}};
  json["step_ns"] = {{"p50", step.quantile(0.5) * kNs}, {"p99", step.quantile(0.99) * kNs}, {"max", step.max() * kNs}};
  for (const ArmContact& arm : model.arms) json["arms"][arm.device] = contactJson(arm.contact);
  return json;
}

std::string timeLine(const char* name, const Histogram& h) {
  return fmt::format("  {:<9} p50 {:8.1f} us   p99 {:8.1f} us   p99.9 {:8.1f} us   max {:9.1f} us\n", name,
                     h.quantile(0.5), h.quantile(0.99), h.quantile(0.999), h.max());
}

/// Says that the arms are the reason for ticks that came late, if most of the time passed in their modules.
std::string slowArmsText(const RunReport& report) {
  constexpr double kMany = 0.01, kMost = 0.5;  // shares of the ticks, and of a tick
  const double arms = report.arms_us.quantile(0.5);
  const bool late = static_cast<double>(report.overruns) > kMany * static_cast<double>(report.ticks);
  if (report.virtual_time || !late || !(arms > kMost * report.compute_us.quantile(0.5))) return "";
  return fmt::format(
      "  slow arm  ticks come late because of the arms: "
      "read() and write() of their modules take {:.0f} us in the median tick\n"
      "  fix: hapticd device check FILE (the device file) names the call; "
      "what waits belongs in a thread of the module's own\n",
      arms);
}

std::string contactText(const ContactStatistics& c, const RunReport& report, const std::string& who) {
  const double seconds = report.rate_hz > 0 ? static_cast<double>(c.contactTicks()) / report.rate_hz : 0;
  std::string text = fmt::format("  contact   {:.2f} s ({} ticks){}\n", seconds, c.contactTicks(), who);
  if (c.unfeltTicks() > 0)
    text +=
        fmt::format("  no force  in {} further ticks{}: the model was disabled, or waited until the tip had left it\n",
                    c.unfeltTicks(), who);
  if (c.contactTicks() > 0) {
    text += fmt::format("  depth     mean {:.3f} mm   std {:.3f} mm   max {:.3f} mm   buzz {:.4f} mm\n",
                        c.meanDepth() * 1e3, c.stdDepth() * 1e3, c.maxDepth() * 1e3, c.buzz() * 1e3);
    text += fmt::format("  force     mean {:.2f} N   max {:.2f} N\n", c.meanForce(), c.maxForce());
  }
  return text;
}

/// Reports pushes from outside. They are right for a magnet, which pulls from there. A short push from outside, as by
/// friction, is not reported where there was contact.
std::string outsideText(const ModelReport& model) {
  const Pushes& outside = model.contact.outside();
  const uint64_t ticks = model.contact.contactTicks();
  if (outside.ticks == 0 || (ticks > 0 && outside.ticks <= ticks)) return "";
  return fmt::format(
      "  outside   {} pushed in {} ticks from outside (depth_m below 0), "
      "with up to {:.2f} N: only ticks inside count as contact\n",
      model.name, outside.ticks, outside.max_force);
}

/// Returns a length [m] as text in a convenient unit.
std::string lengthText(double length) {
  return length < 1e-3 ? fmt::format("{:.3g} um", length * 1e6) : fmt::format("{:.3g} mm", length * 1e3);
}

std::string modelText(const ModelReport& model, const RunReport& report) {
  const ContactStatistics& c = model.contact;
  std::string text = fmt::format("{} ({})\n", model.name, model.plugin);
  if (model.arms.empty()) text += contactText(c, report, "");
  for (const ArmContact& arm : model.arms) text += contactText(arm.contact, report, " by " + arm.device);
  for (const std::string& warning : contactWarnings(model)) text += "  warning   " + warning + "\n";
  text += outsideText(model);
  if (model.degraded_ticks > 0)
    text +=
        fmt::format("  degraded  {} ticks, down to accuracy level {} of 3, to keep the tick's budget; error up to {}\n",
                    model.degraded_ticks, model.coarsest, lengthText(model.residual_m));
  if (c.heldFeet() + c.degradedFeet() > 0)
    text += fmt::format(
        "  feet      the foot was the nearest point in {} ticks, held in contact in {}, not proved nearest in {}\n",
        c.nearestFeet(), c.heldFeet(), c.degradedFeet());
  const Histogram& step = c.stepUs();
  if (step.total() > 0)
    text += fmt::format("  step      p50 {:.0f} ns   p99 {:.0f} ns   max {:.0f} ns\n", step.quantile(0.5) * 1e3,
                        step.quantile(0.99) * 1e3, step.max() * 1e3);
  return text;
}

/// Reports models with coarser answers than asked for, even if they had no contact.
std::string degradedText(const RunReport& report) {
  uint64_t models = 0, most = 0;
  for (const ModelReport& model : report.models) {
    models += model.degraded_ticks > 0 ? 1 : 0;
    most = std::max(most, model.degraded_ticks);
  }
  if (models == 0 || report.ticks == 0) return "";
  return fmt::format(
      "  accuracy  lowered for {} of {} models, in up to {:.0f} % of the ticks, to keep the tick's budget\n", models,
      report.models.size(), 100.0 * static_cast<double>(most) / static_cast<double>(report.ticks));
}

bool felt(const ContactStatistics& contact) {
  return contact.contactTicks() + contact.unfeltTicks() + contact.untraced().ticks + contact.depthless().ticks +
             contact.outside().ticks >
         0;
}

/// Explains why nothing was felt.
std::string untouchedText(const RunReport& report) {
  const bool touched = std::any_of(report.models.begin(), report.models.end(),
                                   [](const ModelReport& model) { return felt(model.contact); });
  // If a model was silenced, its fault explains the missing contact better.
  const bool silenced = std::any_of(report.faults.begin(), report.faults.end(),
                                    [](const std::string& fault) { return fault.rfind("model ", 0) == 0; });
  if (touched || silenced || report.ticks == 0) return "";
  const bool faulted = std::any_of(report.limits.begin(), report.limits.end(), [](const LimitReport& device) {
    return device.fault_ticks + device.not_enabled_ticks > 0;
  });
  return faulted ? "  contact   none while forces were allowed\n" : "  contact   none: the tip touched no model\n";
}

/// Returns the name of a limit as a person finds it in a device file. For programs, the names stay as they are.
std::string keyOfLimit(const std::string& name) {
  if (name == "motors (torque)") return "arm.max_torque";
  return name == "motors (heat)" ? "motors, by their heat" : name;
}

std::string limitText(const LimitReport& device, uint64_t ticks) {
  if (device.any == 0 || ticks == 0) return "";
  std::string text = fmt::format("limits of {}: the force was reduced in {:.3g} % of the ticks (", device.device,
                                 100.0 * static_cast<double>(device.any) / static_cast<double>(ticks));
  for (size_t i = 0; i < device.ticks.size(); ++i)
    text += fmt::format("{}{}: {}", i > 0 ? ", " : "", keyOfLimit(device.ticks[i].first), device.ticks[i].second);
  return text + fmt::format("); the hand got {:.2f} N at most\n", device.sent_max_n);
}

/// Reports faults, because those that were cleared are not in the messages at the end, and because statistics of
/// contacts leave out their ticks.
std::string faultTimeText(const LimitReport& device, const RunReport& report) {
  if (device.faults == 0) return "";
  const double seconds = report.rate_hz > 0 ? static_cast<double>(device.fault_ticks) / report.rate_hz : 0;
  return fmt::format(
      "faults of {}: {} in this run, {:.2f} s without force, "
      "which are left out of contact, depth and force above\n",
      device.device, device.faults, seconds);
}

/// Reports that the enable switch was off, because statistics of contacts leave out its ticks as well.
std::string enableText(const LimitReport& device, const RunReport& report) {
  if (device.not_enabled_ticks == 0 || report.rate_hz <= 0) return "";
  return fmt::format(
      "enable switch of {}: off for {:.2f} s, without force, which are left out of contact, depth and force above\n",
      device.device, static_cast<double>(device.not_enabled_ticks) / report.rate_hz);
}

/// Reports a tip that swung as no hand moves it. Ridges over which a hand strokes fast may look the same.
std::string swingText(const LimitReport& device, const RunReport& report) {
  if (device.swing_hz == 0) return "";
  return fmt::format(
      "swing of {}: its tip swung {:.0f} times a second, by more than 1 mm; unless a shape did this, the arm is not "
      "stable at {:.0f} Hz: take a higher rate, or {}\n",
      device.device, device.swing_hz, report.rate_hz, device.complies ? "more admittance.damping" : "less stiffness");
}

/// Reports joints at a stop: a hand that leans on a stop feels a force that does not come from the scene.
std::string stopText(const StopReport& stop, const RunReport& report) {
  constexpr double kTold = 0.1;  // [s] shorter times at a stop are bumps
  const double seconds = report.rate_hz > 0 ? static_cast<double>(stop.ticks) / report.rate_hz : 0;
  if (seconds < kTold) return "";
  return fmt::format(
      "stop of {}: joint {} (q{}) stood at the end of its range for {:.1f} s: the arm cannot go farther\n", stop.device,
      stop.joint + 1, stop.joint, seconds);
}

Json clientJson(const ClientReport& client) {
  return {{"device", client.device},
          {"program", client.program},
          {"pid", client.pid},
          {"times", client.times},
          {"answers", client.answers},
          {"same_tick", client.sameTick()},
          {"next_tick", client.nextTick()},
          {"silences", client.silences},
          {"largest_n", client.largest_n},
          {"asked_n", client.asked_n},
          {"bounded", client.bounded},
          {"refused", client.refused},
          {"why", client.why.empty() ? Json() : Json(client.why)}};
}

std::string clientText(const ClientReport& client, double answer_time) {
  std::string text = fmt::format(
      "program {} on {}: {} answers, {:.1f} % in the same tick, {:.1f} % in the next; silent {} times; "
      "force max {:.2f} N\n",
      client.program, client.device, client.answers, 100 * client.sameTick(), 100 * client.nextTick(), client.silences,
      client.largest_n);
  if (client.bounded > 0)
    text += fmt::format("  it asked for up to {:.3g} N: {} answers were reduced to its largest allowed force\n",
                        client.asked_n, client.bounded);
  if (client.refused > 0) text += fmt::format("  {} answers were refused: {}\n", client.refused, client.why);
  if (!late(client)) return text;
  return text +
         "  one tick of delay reduces the stiffness of a stable wall to a third\n  fix: " + lateFix(answer_time) + "\n";
}

}  // namespace

std::string checkCommand(const ModelReport& model) {
  return "hapticd plugin check" + (model.library.empty() ? "" : " " + shellWord(model.library));
}

Result<void> writeJson(const RunReport& report, const std::string& file) {
  Json json = {{"ticks", report.ticks},
               {"rate_hz", report.rate_hz},
               {"overruns", report.overruns},
               {"missed_ticks", report.missed_ticks},
               {"lateness_us", quantiles(report.lateness_us)},
               {"compute_us", quantiles(report.compute_us)},
               {"arms_us", quantiles(report.arms_us)},
               {"page_faults", report.page_faults},
               {"servo_allocations", report.servo_allocations},
               {"models", Json::object()},
               {"faults", report.faults},
               {"scene", report.scene},
               {"seconds", report.seconds},
               {"wall_seconds", report.wall_seconds},
               {"virtual_time", report.virtual_time},
               {"resident_bytes", report.resident_bytes},
               {"start_ms", report.start_ms}};
  json["limits"] = Json::object();
  for (const LimitReport& device : report.limits) {
    Json& ticks = json["limits"][device.device];
    ticks = {{"clipped_ticks", device.any},       {"sent_max_n", device.sent_max_n},
             {"swing_hz", device.swing_hz},       {"faults", device.faults},
             {"fault_ticks", device.fault_ticks}, {"not_enabled_ticks", device.not_enabled_ticks}};
    for (const auto& [limit, count] : device.ticks) ticks["by_limit"][limit] = count;
  }
  json["stops"] = Json::object();
  for (const StopReport& stop : report.stops) json["stops"][stop.device]["q" + std::to_string(stop.joint)] = stop.ticks;
  json["clients"] = Json::array();
  for (const ClientReport& client : report.clients) json["clients"].push_back(clientJson(client));
  for (const ModelReport& model : report.models) json["models"][model.name] = modelJson(model);
  return writeWhole(file, json.dump(2) + "\n");
}

std::string summary(const RunReport& report) {
  std::string text = fmt::format("{} ticks in {:.2f} s{}: {:.1f} Hz held, {} overruns, {} ticks missed\n", report.ticks,
                                 report.seconds, report.virtual_time ? " of virtual time" : "", report.rate_hz,
                                 report.overruns, report.missed_ticks);
  if (report.virtual_time && report.wall_seconds > 0) {
    text += fmt::format("  computed in {:.2f} s, {:.0f} times faster than real time\n", report.wall_seconds,
                        report.seconds / report.wall_seconds);
  } else {
    text += timeLine("lateness", report.lateness_us);
  }
  text += timeLine("compute", report.compute_us);
  text += timeLine("in arms", report.arms_us);
  text += slowArmsText(report);
  text += fmt::format("  servo     {} page faults, {} allocations after warm-up\n", report.page_faults,
                      report.servo_allocations);
  text += fmt::format("  process   {:.1f} MB resident, first tick {:.0f} ms after the start\n",
                      static_cast<double>(report.resident_bytes) / 1e6, report.start_ms);
  text += degradedText(report);
  text += untouchedText(report);
  constexpr size_t kMostModels = 12;
  size_t shown = 0;
  for (const ModelReport& model : report.models)
    if ((felt(model.contact) || report.models.size() <= kMostModels) && shown++ < kMostModels)
      text += modelText(model, report);
  for (const LimitReport& device : report.limits) text += limitText(device, report.ticks);
  for (const LimitReport& device : report.limits) text += faultTimeText(device, report) + enableText(device, report);
  for (const LimitReport& device : report.limits) text += swingText(device, report);
  for (const StopReport& stop : report.stops) text += stopText(stop, report);
  for (const ClientReport& client : report.clients) text += clientText(client, report.answer_time);
  for (const std::string& fault : report.faults) text += "fault: " + fault + "\n";
  return text;
}

}  // namespace hapticd::record
