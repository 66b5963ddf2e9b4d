// SPDX-License-Identifier: MIT
#include "cli/recording/plot_notes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "cli/recording/joint_motion.hpp"
#include "cli/recording/recorded_marks.hpp"
#include "cli/recording/tick_times.hpp"
#include "hapticd/client.h"
#include "hapticd/shape.h"
#include "session/replay/about.hpp"
#include "session/replay/run_models.hpp"

namespace hapticd::cli {

namespace {

/// Notes when models were silenced, because otherwise the picture would not show why nothing is felt from then on.
void noteSilenced(const record::Recording& recording, const servo::RunModels& models, record::RunNotes& notes) {
  const record::RecordedStream* events = recording.stream("events");
  const auto* kind = events != nullptr ? events->find("kind") : nullptr;
  const auto* model = events != nullptr ? events->find("model") : nullptr;
  const auto* t = events != nullptr ? events->find("t") : nullptr;
  const auto* tick = events != nullptr ? events->find("tick") : nullptr;
  if (kind == nullptr || model == nullptr || t == nullptr || tick == nullptr) return;
  for (uint64_t row = 0; row < events->rows(); ++row) {
    if (events->number(row, *kind) != double{HAPTICD_SILENCED}) continue;
    const std::string name = models.nameOf(events->number(row, *model), events->number(row, *tick));
    notes.moments.emplace_back(events->number(row, *t), name + " is silenced");
  }
}

/// Replaces the depths of the stream `ticks`, which are the greatest of all arms, by those of one arm from the stream
/// `contacts`. There is no depth if nothing was traced.
void takeOwnDepths(const record::Recording& recording, uint32_t arm, const record::Column& tick_column,
                   const record::RecordedStream& ticks, const std::vector<uint64_t>& rows,
                   std::vector<record::Sample>& samples) {
  const record::RecordedStream* contacts = recording.stream("contacts");
  if (contacts == nullptr) return;
  const auto *tick = contacts->find("tick"), *probe = contacts->find("probe"), *flags = contacts->find("flags"),
             *depth = contacts->find("depth"), *model = contacts->find("model");
  for (const auto* column : {tick, probe, flags, depth, model})
    if (column == nullptr) return;
  uint64_t at = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    const double now = ticks.number(rows[i], tick_column);
    samples[i].depth_m = std::nan(""), samples[i].model = -1;
    while (at < contacts->rows() && contacts->number(at, *tick) < now) ++at;
    for (; at < contacts->rows() && contacts->number(at, *tick) == now; ++at) {
      const auto word = static_cast<uint32_t>(contacts->number(at, *flags));
      const double deep = contacts->number(at, *depth);
      if (contacts->number(at, *probe) != arm || (word & HSP_OUT_TRACED) == 0 || deep <= samples[i].depth_m) continue;
      samples[i].depth_m = deep, samples[i].model = static_cast<int>(contacts->number(at, *model));
    }
  }
}

/// Replaces the numbers of the models by their places among those of the run, because a number can mean several models.
void takeModels(const servo::RunModels& models, const record::Column& tick, const record::RecordedStream& ticks,
                const std::vector<uint64_t>& rows, std::vector<record::Sample>& samples) {
  for (size_t i = 0; i < samples.size(); ++i) {
    const size_t place = models.find(samples[i].model, ticks.number(rows[i], tick));
    samples[i].model = place == servo::RunModels::kNone ? -1 : static_cast<int>(place);
  }
}

/// Notes how the hinges and sliders moved. @param from, to [s] what is drawn
void noteJoints(const record::Recording& recording, const servo::RunModels& models, double from, double to,
                record::RunNotes& notes) {
  std::map<size_t, record::JointTrack> tracks;
  TickTimes times(recording);
  eachJointPlace(recording, models, [&](size_t model, const JointMotion& joint, double tick, const JointPlace& place) {
    const double t = times.of(tick), unit = joint.turns() ? 1 : 1e3;
    if (!(t >= from && t <= to)) return;
    record::JointTrack& track = tracks[model];
    track.title = (joint.turns() ? "angle of " : "travel of ") + models.all()[model].model.name;
    track.unit = joint.turns() ? "rad" : "mm";
    track.places.emplace_back(t, place.position * unit);
    const double stop = place.stop != 0 ? joint.limit(place.stop) * unit : 0;
    if (place.stop != 0 && std::count(track.stops.begin(), track.stops.end(), stop) == 0) track.stops.push_back(stop);
  });
  for (auto& [model, track] : tracks) notes.joints.push_back(std::move(track));
}

}  // namespace

record::RunNotes notesOf(const record::Recording& recording, const record::RecordedStream& ticks,
                         const std::vector<uint64_t>& rows, uint32_t arm, std::vector<record::Sample>& samples,
                         bool& virtual_time) {
  record::RunNotes notes;
  notes.positions = true;
  const auto about = servo::readAbout(recording.aboutJson());
  if (!about) return notes;
  virtual_time = about->facts.virtual_time;
  const servo::RunModels models(recording, about->scene);
  for (const servo::RunModel& one : models.all()) notes.models.push_back(one.model.name);
  if (arm < about->scene.devices.size()) notes.force_limit_n = about->scene.devices[arm].limits.force;
  if (about->scene.devices.size() > 1 && arm < about->scene.devices.size()) notes.arm = about->scene.devices[arm].name;
  noteSilenced(recording, models, notes);
  notes.marks = recordedMarks(recording);
  if (!samples.empty()) noteJoints(recording, models, samples.front().t, samples.back().t, notes);
  const record::Column* tick = ticks.find("tick");
  if (tick == nullptr) return notes;
  if (!notes.arm.empty()) takeOwnDepths(recording, arm, *tick, ticks, rows, samples);
  takeModels(models, *tick, ticks, rows, samples);
  return notes;
}

}  // namespace hapticd::cli
