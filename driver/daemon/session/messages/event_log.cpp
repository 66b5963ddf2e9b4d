// SPDX-License-Identifier: MIT
#include "session/messages/event_log.hpp"

#include <fmt/format.h>

#include <chrono>

#include "base/shell_word.hpp"
#include "hapticd/abi.h"
#include "log/log.hpp"
#include "servo/safety/fault.hpp"
#include "session/messages/program_name.hpp"
#include "session/messages/silence_reason.hpp"
#include "session/telemetry/event_finder.hpp"

namespace hapticd::servo {

namespace {

constexpr size_t kAtOnce = 256;    ///< events that are read in one go
constexpr double kBegins = 0.005;  ///< [s] a touch this early means that the tip was inside at the start

}  // namespace

void EventLog::logNewEvents(const Flight& flight) {
  logSwitches();
  logPushers();
  for (;;) {
    const std::vector<hapticd_event> events = flight.events(next_, kAtOnce);
    for (const hapticd_event& event : events) {
      Message message = messageOf(event);
      if (MarkRow mark; event.kind == HAPTICD_MARK && flight.mark(event.code, mark))
        message = {HSP_LOG_INFO, "", fmt::format("mark at {:.4f} s: {}", event.t, mark.text)};
      note(event);
      if (!message.text.empty()) log::write(message.level, message.who, message.text);
    }
    next_ += events.size();
    if (events.size() < kAtOnce) return;
  }
}

void EventLog::logSwitches() {
  told_of_switch_.resize(arms_.size());
  for (size_t i = 0; i < arms_.size(); ++i) {
    if (told_of_switch_[i] || !arms_[i]->foundPressed()) continue;
    told_of_switch_[i] = true;
    const Message message = messageOfSwitch(i);
    log::write(message.level, message.who, message.text);
  }
}

void EventLog::logPushers() {
  const std::chrono::duration<double> now = std::chrono::steady_clock::now().time_since_epoch();
  for (uint32_t i = 0; i < arms_.size(); ++i)
    for (const PusherLog::Message& message : pushers_.update(i, arms_[i]->clients(), now.count())) write(i, message);
}

void EventLog::write(uint32_t arm, const PusherLog::Message& message) const {
  log::write(message.level, arm < devices_.size() ? devices_[arm].name : "", message.text);
}

void EventLog::pushes(uint32_t arm, uint32_t place, pid_t pid, const std::string& program) {
  write(arm, pushers_.begins(arm, place, pid, program));
}

void EventLog::pushesNoMore(uint32_t arm, uint32_t place, PusherLog::End how) {
  write(arm, pushers_.ends(arm, place, how, arms_[arm]->clients().clients()[place]));
}

void EventLog::leads(pid_t pid, const std::string& program) {
  const std::lock_guard lock(mutex_);
  if (programs_.size() >= kMostPrograms) programs_.clear();
  programs_[pid] = program;
}

std::string EventLog::leaderOf(const hapticd_event& event) const {
  const std::lock_guard lock(mutex_);
  const auto found = programs_.find(static_cast<pid_t>(event.value));
  return fmt::format("process {:.0f}", event.value) +
         (found != programs_.end() ? " (" + found->second + ")" : std::string());
}

void EventLog::note(const hapticd_event& event) {
  if (event.kind != HAPTICD_FAULT && event.kind != HAPTICD_CLEARED) return;
  held_.resize(devices_.size());
  const auto arm = static_cast<size_t>(event.probe);
  if (event.probe < 0 || arm >= held_.size()) return;
  held_[arm] = event.kind == HAPTICD_FAULT && static_cast<Fault>(event.code) == Fault::kStopped;
}

EventLog::Message EventLog::messageOfSwitch(size_t arm) const {
  return {HSP_LOG_WARNING, arm < devices_.size() ? devices_[arm].name : "",
          "the button of limits.enable was down when the run began, so it does not enable forces; "
          "release it, then press it"};
}

EventLog::Named EventLog::device(const hapticd_event& event) const {
  const auto arm = static_cast<size_t>(event.probe);
  return event.probe >= 0 && arm < devices_.size() ? devices_[arm] : Named();
}

EventLog::Message EventLog::messageOf(const hapticd_event& event) const {
  switch (event.kind) {
    case HAPTICD_JOINED:
    case HAPTICD_LOST:
    case HAPTICD_REFUSED:
      return messageOfLeader(event);
    case HAPTICD_FAULT:
    case HAPTICD_CLEARED:
      return messageOfArm(event);
    default:
      return messageOfModel(event);
  }
}

EventLog::Message EventLog::messageOfModel(const hapticd_event& event) const {
  const auto [who, file] = models_.of(event);
  switch (event.kind) {
    case HAPTICD_CLICK:
      return {HSP_LOG_DEBUG, who,
              fmt::format("{}{} at {:.4f} s", *directionOfClick(event) != 0 ? "snapped " : "clicked",
                          directionOfClick(event), event.t)};
    case HAPTICD_TOUCH:
      if (event.t < kBegins)
        return {HSP_LOG_WARNING, who,
                device(event).name +
                    " has its tip inside this model at the start, so a force begins with the run (it grows over "
                    "limits.ramp_in)\n  fix: move "
                    "the model, the arm (mount) or the hand (hand), so that the tip starts outside"};
      return {HSP_LOG_DEBUG, who, fmt::format("{} touches it at {:.4f} s", device(event).name, event.t)};
    case HAPTICD_END_STOP:
      return {HSP_LOG_DEBUG, who, fmt::format("its joint came to its {} end at {:.4f} s", endOf(event), event.t)};
    case HAPTICD_SILENCED:
      return {HSP_LOG_ERROR, "", silenceReason(event, who, file)};
    case HAPTICD_DEGRADED:
      return {HSP_LOG_WARNING, who,
              fmt::format("answers less accurately (level {:.0f}), because ticks took too long", event.value)};
    case HAPTICD_RESTORED:
      return {HSP_LOG_INFO, who, "answers with its full accuracy again"};
    case HAPTICD_CAME:
      return {HSP_LOG_INFO, who, "is in the scene now"};
    case HAPTICD_LEFT:
      return {HSP_LOG_INFO, who, "has left the scene"};
    case HAPTICD_STALLED:
      return {
          HSP_LOG_WARNING, "",
          fmt::format(
              "no tick for {:.2f} s, until {:.2f} s: the process was stopped (SIGSTOP, a debugger), the "
              "machine was too busy, or a call of an arm's module took that long (compare \"in arms\" in the report of "
              "the run, or try: hapticd device check {})",
              event.value, event.t, devices_.size() == 1 ? shellWord(devices_[0].file) : "FILE")};
    default:
      return {HSP_LOG_DEBUG, "", ""};
  }
}

EventLog::Message EventLog::messageOfArm(const hapticd_event& event) const {
  const auto arm = static_cast<size_t>(event.probe);
  const bool held = event.probe >= 0 && arm < held_.size() && held_[arm];
  if (event.kind == HAPTICD_CLEARED)
    return {HSP_LOG_INFO, device(event).name,
            held ? "the hold is over; the forces come back" : "the fault is over; the forces come back"};
  const auto fault = static_cast<Fault>(event.code);
  if (fault == Fault::kStopped)  // from an order to hold; the end of a run makes no event
    return {HSP_LOG_WARNING, device(event).name,
            "the arm is held; its forces ended and stay off until the hold is cleared\n  fix: hapticd ctl clear"};
  const char* trouble = event.probe >= 0 && arm < arms_.size() ? arms_[arm]->troubleOf(fault) : nullptr;
  const auto [name, file] = device(event);
  return {HSP_LOG_ERROR, "", "fault: " + faultMessage(name, fault, event.value, trouble, file)};
}

EventLog::Message EventLog::messageOfLeader(const hapticd_event& event) const {
  if (event.model < 0 && event.code == static_cast<uint32_t>(Order::Led::kForce))
    return {HSP_LOG_DEBUG, "", ""};  // PusherLog reports more about programs that push
  const std::string what = event.model >= 0 ? models_.of(event).name : device(event).name;
  if (event.kind == HAPTICD_REFUSED)
    return {HSP_LOG_WARNING, what,
            fmt::format("{:.0f} record{} of its leader {} refused so far{}{}", event.value, event.value == 1 ? "" : "s",
                        event.value == 1 ? "was" : "were", *whyRefused(event) != 0 ? ": " : "", whyRefused(event))};
  return {HSP_LOG_INFO, what, leaderOf(event) + (event.kind == HAPTICD_JOINED ? " leads it" : " no longer leads it")};
}

}  // namespace hapticd::servo
