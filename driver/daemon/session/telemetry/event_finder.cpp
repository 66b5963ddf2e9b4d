// SPDX-License-Identifier: MIT
#include "session/telemetry/event_finder.hpp"

#include <iterator>
#include <utility>

#include "status/page.hpp"

namespace hapticd::servo {

namespace {

constexpr double kStalled = 0.25;  ///< [s] a longer gap between two ticks means that the process was stopped
constexpr uint32_t kWhy = 16;      ///< the code of HAPTICD_REFUSED is what is led + kWhy * the reason, see client.h

uint32_t codeOf(Order::Led led, PoseFollower::Refusal why) noexcept HSP_RT {
  return static_cast<uint32_t>(led) + kWhy * static_cast<uint32_t>(why);
}

uint32_t directionOf(uint32_t flags) noexcept HSP_RT {
  if ((flags & HSP_OUT_WENT_IN) != 0) return HAPTICD_WENT_IN;
  return (flags & HSP_OUT_CAME_OUT) != 0 ? uint32_t{HAPTICD_CAME_OUT} : 0;
}

}  // namespace

void EventFinder::add(uint32_t kind, int32_t model, int32_t probe, uint32_t code, double value) noexcept HSP_RT {
  if (count_ == found_.size()) return;
  found_[count_++] = {0, 0, kind, model, probe, code, value};
}

void EventFinder::order(const Order& order) noexcept HSP_RT {
  const auto target = static_cast<int32_t>(order.target);
  switch (order.kind) {
    case Order::Kind::kAdopt:
      if (order.target < models_.size()) models_[order.target] = ModelNote();
      return add(HAPTICD_CAME, target, -1, 0, 0);
    case Order::Kind::kRelease:
      if (order.target >= models_.size() || models_[order.target].leaving) return;
      models_[order.target].leaving = true;
      ++leaving_;
      return;
    case Order::Kind::kLead:
    case Order::Kind::kUnlead: {
      const bool of_model = order.param == static_cast<uint32_t>(Order::Led::kModel);
      const uint32_t kind = order.kind == Order::Kind::kLead ? HAPTICD_JOINED : HAPTICD_LOST;
      return add(kind, of_model ? target : -1, of_model ? -1 : target, order.param, order.value);
    }
    case Order::Kind::kHold:
      if (order.target >= arms_.size() || arms_[order.target].fault != Fault::kNone) return;
      arms_[order.target].fault = Fault::kStopped;
      return add(HAPTICD_FAULT, -1, target, static_cast<uint32_t>(Fault::kStopped), 0);
    default:
      return;
  }
}

void EventFinder::tick(double t, const Core& core, const Arms& arms) noexcept HSP_RT {
  if (t - last_t_ >= kStalled) add(HAPTICD_STALLED, -1, -1, 0, t - last_t_);
  last_t_ = t;
  if (leaving_ > 0) findLeft(core);
  for (const uint32_t index : core.live())
    if (index < models_.size()) check(t, index, core);
  for (uint32_t i = 0; i < arms.size() && i < arms_.size(); ++i) check(t, i, *arms[i]);
  for (size_t i = 0; i < count_; ++i) found_[i].t = t;
}

void EventFinder::findLeft(const Core& core) noexcept HSP_RT {
  for (uint32_t i = 0; i < models_.size() && i < core.models().size(); ++i) {
    if (!models_[i].leaving || core.models()[i].shape != nullptr) continue;
    models_[i] = ModelNote();
    --leaving_;
    add(HAPTICD_LEFT, static_cast<int32_t>(i), -1, 0, 0);
  }
}

template <class Note>
bool EventFinder::refused(double t, uint64_t now, Note& note) noexcept HSP_RT {
  if (now == note.refused || t - note.refused_told < kRefusedPeriod) return false;
  note.refused = now;
  note.refused_told = t;
  return now > 0;
}

void EventFinder::check(double t, uint32_t index, const Core& core) noexcept HSP_RT {
  const ModelState& model = core.models()[index];
  const auto number = static_cast<int32_t>(index);
  ModelNote& note = models_[index];
  const bool stepped = model.rested == 0;
  for (uint32_t probe = 0; probe < core.probeCount() && stepped; ++probe) {
    const Contact& contact = core.contact(index, probe);
    if (!contact.traced) continue;
    const auto by = static_cast<int32_t>(probe);
    if ((contact.world.flags & HSP_OUT_EVENT) != 0) add(HAPTICD_CLICK, number, by, directionOf(contact.world.flags), 0);
    if (!(contact.world.depth_m > 0)) continue;
    if (t - note.touched[probe] >= kFreeFor)
      add(HAPTICD_TOUCH, number, by, 0, Eigen::Map<const Vector3d>(contact.world.force).norm());
    note.touched[probe] = t;
  }
  if (model.guard.silenced() && note.fault != model.guard.fault()) {
    note.fault = model.guard.fault();
    const bool sized = note.fault == ShapeFault::kPulls || note.fault == ShapeFault::kJump;
    const double value = sized ? model.breach.force : model.failed_status;
    add(HAPTICD_SILENCED, number, -1, static_cast<uint32_t>(note.fault), value);
  }
  if (stepped) findEnd(t, number, model, note);
  if (model.level != note.level) {
    add(model.level > 0 ? HAPTICD_DEGRADED : HAPTICD_RESTORED, number, -1, 0, model.level);
    note.level = model.level;
  }
  if (const uint64_t count = model.lead.refused(); refused(t, count, note))
    add(HAPTICD_REFUSED, number, -1, codeOf(Order::Led::kModel, model.lead.why()), static_cast<double>(count));
}

/// Finds that a joint came to an end of its range. One that begins there has not come to it.
void EventFinder::findEnd(double t, int32_t number, const ModelState& model, ModelNote& note) noexcept HSP_RT {
  const bool known = std::exchange(note.seen, true);
  if (model.at_end == 0) return;
  if (known && t - note.at_end >= kFreeFor) add(HAPTICD_END_STOP, number, -1, endOf(model), 0);
  note.at_end = t;
}

void EventFinder::check(double t, uint32_t index, const Arm& arm) noexcept HSP_RT {
  ArmNote& note = arms_[index];
  const auto number = static_cast<int32_t>(index);
  const Fault fault = arm.limiter().fault();
  const bool again = arm.limiter().faults() != note.faults;
  if (fault != Fault::kNone && fault == note.fault && again) {  // it was cleared, and came back in this tick
    add(HAPTICD_CLEARED, -1, number, 0, 0);
    note.fault = Fault::kNone;
  }
  note.faults = arm.limiter().faults();
  if (fault != note.fault) {
    note.fault = fault;
    if (fault != Fault::kStopped)  // kStopped here is the planned end of the run; a hold is noted in order()
      add(fault != Fault::kNone ? HAPTICD_FAULT : HAPTICD_CLEARED, -1, number, static_cast<uint32_t>(fault),
          fault != Fault::kNone ? arm.limiter().measured() : 0);
  }
  if (const uint64_t count = arm.hand().refused(); refused(t, count, note))
    add(HAPTICD_REFUSED, -1, number, codeOf(Order::Led::kHand, arm.hand().why()), static_cast<double>(count));
  if (const uint64_t count = arm.clients().refused(); refused(t, count, note.pushes))
    add(HAPTICD_REFUSED, -1, number, static_cast<uint32_t>(Order::Led::kForce), static_cast<double>(count));
}

const char* whyRefused(const hapticd_event& event) {
  if (event.kind != HAPTICD_REFUSED) return "";
  switch (static_cast<PoseFollower::Refusal>(event.code / kWhy)) {
    case PoseFollower::Refusal::kNotFinite:
      return "a number is not finite";
    case PoseFollower::Refusal::kTime:
      return "its time is in the future or negative; expected seconds of CLOCK_MONOTONIC, or 0";
    case PoseFollower::Refusal::kFar:
      return "its position is farther than 10 m from the world's origin; the value must be in m";
    case PoseFollower::Refusal::kNotUnit:
      return "its orientation does not have length 1; expected a unit quaternion w, x, y, z";
    case PoseFollower::Refusal::kNone:
      break;
  }
  return "";
}

const char* directionOfClick(const hapticd_event& event) {
  if (event.kind != HAPTICD_CLICK || event.code == 0) return "";
  return event.code == HAPTICD_WENT_IN ? "in" : "out";
}

uint32_t endOf(const ModelState& model) noexcept HSP_RT {
  if (model.at_end == 0) return 0;
  return (model.at_end & HSP_OUT_AT_LOWEST) != 0 ? uint32_t{HAPTICD_LOWEST} : uint32_t{HAPTICD_HIGHEST};
}

const char* endOf(const hapticd_event& event) {
  return event.kind == HAPTICD_END_STOP ? status::nameOfEnd(event.code) : "";
}

const char* nameOfEvent(uint32_t kind) {
  static constexpr const char* kNames[] = {"",         "click",       "touch",   "fault", "cleared", "silenced",
                                           "degraded", "restored",    "came",    "left",  "joined",  "lost",
                                           "refused",  "quarantined", "stalled", "mark",  "end_stop"};
  static_assert(std::size(kNames) == HAPTICD_EVENT_KINDS);
  return kind < std::size(kNames) ? kNames[kind] : "";
}

}  // namespace hapticd::servo
