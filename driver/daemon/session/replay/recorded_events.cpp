// SPDX-License-Identifier: MIT
#include "session/replay/recorded_events.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "session/messages/event_log.hpp"
#include "session/messages/silence_reason.hpp"

namespace hapticd::servo {

namespace {

constexpr uint32_t kMostPlaces = 256;  ///< models that get a name

/// The columns of an event; nullptr if the recording lacks them.
struct EventColumns {
  explicit EventColumns(const record::RecordedStream& events)
      : tick(events.find("tick")),
        t(events.find("t")),
        kind(events.find("kind")),
        model(events.find("model")),
        probe(events.find("probe")),
        code(events.find("code")),
        value(events.find("value")) {}
  bool all() const { return tick && t && kind && model && probe && code && value; }
  const record::Column *tick, *t, *kind, *model, *probe, *code, *value;
};

/// A number of a damaged file may be anything, and a conversion of it would be undefined.
template <class Whole>
Whole whole(double number) {
  constexpr double kMost = std::numeric_limits<int32_t>::max();
  return static_cast<Whole>(std::isfinite(number) ? std::clamp(number, -1.0, kMost) : -1.0);
}

hapticd_event eventAt(const record::RecordedStream& events, const EventColumns& c, uint64_t row) {
  const auto number = [&](const record::Column* column) { return events.number(row, *column); };
  hapticd_event event{};
  event.tick = static_cast<uint64_t>(std::max(int64_t{0}, whole<int64_t>(number(c.tick))));
  event.t = number(c.t);
  event.kind = static_cast<uint32_t>(whole<int64_t>(number(c.kind)));
  event.model = whole<int32_t>(number(c.model));
  event.probe = whole<int32_t>(number(c.probe));
  event.code = static_cast<uint32_t>(whole<int64_t>(number(c.code)));
  event.value = number(c.value);
  return event;
}

/// Gives a name to each model; to one that the recording does not name, its number.
void nameModels(PlaceNames& names, const RunModels& models) {
  for (const RunModel& one : models.all())
    names.came(one.number, one.since, {one.model.name, fileOfPlugin(one.model.plugin)});
  for (uint32_t place = 0; place < kMostPlaces; ++place)
    if (models.find(place, HUGE_VAL) == RunModels::kNone) names.came(place, 0, {models.nameOf(place, 0), ""});
}

}  // namespace

std::vector<RecordedMessage> messagesOf(const record::Recording& recording, const RecordedRun& run,
                                        const RunModels& models) {
  std::vector<RecordedMessage> messages;
  const record::RecordedStream* events = recording.stream("events");
  if (events == nullptr) return messages;
  const EventColumns columns(*events);
  if (!columns.all()) return messages;
  const Arms no_arms;
  std::vector<EventLog::Named> devices;
  for (const scene::Device& device : run.scene.devices) devices.push_back({device.name, device.file.string()});
  EventLog log(kMostPlaces, std::move(devices), no_arms);
  nameModels(log.names(), models);
  for (uint64_t row = 0; row < events->rows(); ++row) {
    const hapticd_event event = eventAt(*events, columns, row);
    if (event.kind == HAPTICD_END_STOP) continue;  // the motion of a joint says more
    EventLog::Message message = log.messageOf(event);
    log.note(event);
    if (!message.text.empty())
      messages.push_back({event.t, event.kind, message.level, std::move(message.who), std::move(message.text)});
  }
  return messages;
}

}  // namespace hapticd::servo
