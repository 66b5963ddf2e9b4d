// SPDX-License-Identifier: MIT
/// `hapticd plot`: draws a picture of a recording.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/mark_text.hpp"
#include "cli/recording/joint_motion.hpp"
#include "cli/recording/tick_times.hpp"
#include "cli/support/command.hpp"
#include "cli/support/open_end.hpp"
#include "cli/support/output_file.hpp"
#include "hapticd/client.h"
#include "hapticd/shape.h"
#include "record/picture.hpp"
#include "record/recording.hpp"
#include "session/replay/about.hpp"

namespace hapticd::cli {

namespace {

struct PlotArguments {
  std::string file, out;
  uint32_t arm = 0;
  std::optional<double> from, to;
};

/// The columns that are drawn; nullptr if the recording lacks them.
struct Columns {
  const record::Column *t, *depth, *model, *lateness, *compute, *fault, *force[3], *asked[3], *position[3];
};

std::optional<Columns> columnsOf(const record::RecordedStream& ticks, uint32_t arm) {
  const std::string prefix = "arm" + std::to_string(arm) + "_";
  Columns c{ticks.find("t"),
            ticks.find("depth"),
            ticks.find("model"),
            ticks.find("lateness_us"),
            ticks.find("compute_us"),
            ticks.find(prefix + "fault"),
            {},
            {},
            {}};
  constexpr const char* kAxes[] = {"x", "y", "z"};
  bool all = c.t != nullptr && c.depth != nullptr && c.model != nullptr && c.lateness != nullptr &&
             c.compute != nullptr && c.fault != nullptr;
  for (size_t i = 0; i < 3; ++i) {
    c.force[i] = ticks.find(prefix + "sent_f" + kAxes[i]);
    c.asked[i] = ticks.find(prefix + "f" + kAxes[i]);
    c.position[i] = ticks.find(prefix + kAxes[i]);
    all = all && c.force[i] != nullptr && c.asked[i] != nullptr && c.position[i] != nullptr;
  }
  return all ? std::optional(c) : std::nullopt;
}

/// Returns what is wrong with the arm that was asked for, and which arms there are.
std::string noTicksOf(uint32_t arm, const record::RecordedStream* ticks) {
  uint32_t arms = 0;
  while (ticks != nullptr && columnsOf(*ticks, arms)) ++arms;
  const std::string wrong = fmt::format(": has no ticks of arm {}", arm);
  if (arms == 0) return wrong + ", nor of any other, expected a recording of hapticd run --record, or a black box";
  return wrong + fmt::format(", expected --arm 0{} (the recording has {} arm{})",
                             arms == 1 ? "" : fmt::format(" to {}", arms - 1), arms, arms == 1 ? "" : "s");
}

record::Sample sampleAt(const record::RecordedStream& ticks, const Columns& c, uint64_t row) {
  record::Sample sample;
  sample.t = ticks.number(row, *c.t);
  sample.depth_m = ticks.number(row, *c.depth);
  sample.model = static_cast<int>(ticks.number(row, *c.model));
  double sent = 0, asked = 0;
  for (size_t i = 0; i < 3; ++i) {
    sent = std::hypot(sent, ticks.number(row, *c.force[i]));
    asked = std::hypot(asked, ticks.number(row, *c.asked[i]));
    sample.position_m[i] = ticks.number(row, *c.position[i]);
  }
  sample.force_n = sent;
  sample.asked_n = asked;
  sample.fault = static_cast<uint32_t>(ticks.number(row, *c.fault));
  sample.lateness_us = ticks.number(row, *c.lateness);
  sample.compute_us = ticks.number(row, *c.compute);
  return sample;
}

/// Notes when models were silenced, because otherwise the picture would not show why nothing is felt from then on.
void noteSilenced(const record::Recording& recording, record::RunNotes& notes) {
  const record::RecordedStream* events = recording.stream("events");
  const auto* kind = events != nullptr ? events->find("kind") : nullptr;
  const auto* model = events != nullptr ? events->find("model") : nullptr;
  const auto* t = events != nullptr ? events->find("t") : nullptr;
  if (kind == nullptr || model == nullptr || t == nullptr) return;
  for (uint64_t row = 0; row < events->rows(); ++row) {
    if (events->number(row, *kind) != double{HAPTICD_SILENCED}) continue;
    const double number = events->number(row, *model);
    const bool named = number >= 0 && number < static_cast<double>(notes.models.size());
    const std::string name = named ? notes.models[static_cast<size_t>(number)] : "a model";
    notes.moments.emplace_back(events->number(row, *t), name + " is silenced");
  }
}

void noteMarks(const record::Recording& recording, record::RunNotes& notes) {
  const record::RecordedStream* marks = recording.stream("marks");
  const auto* t = marks != nullptr ? marks->find("t") : nullptr;
  const auto* text = marks != nullptr ? marks->find("text") : nullptr;
  if (t == nullptr || text == nullptr) return;
  for (uint64_t row = 0; row < marks->rows(); ++row)
    if (const std::string said = marks->text(row, *text); isMarkText(said))
      notes.marks.emplace_back(marks->number(row, *t), said);
}

/// Notes how the hinges and sliders moved. @param from, to [s] what is drawn
void noteJoints(const record::Recording& recording, const scene::Scene& scene, double from, double to,
                record::RunNotes& notes) {
  std::map<size_t, record::JointTrack> tracks;
  TickTimes times(recording);
  eachJointPlace(recording, scene, [&](size_t model, const JointMotion& joint, double tick, const JointPlace& place) {
    const double t = times.of(tick), unit = joint.turns() ? 1 : 1e3;
    if (!(t >= from && t <= to)) return;
    record::JointTrack& track = tracks[model];
    track.title = (joint.turns() ? "angle of " : "way of ") + scene.models[model].name;
    track.unit = joint.turns() ? "rad" : "mm";
    track.places.emplace_back(t, place.position * unit);
    const double stop = place.stop != 0 ? joint.limit(place.stop) * unit : 0;
    if (place.stop != 0 && std::count(track.stops.begin(), track.stops.end(), stop) == 0) track.stops.push_back(stop);
  });
  for (auto& [model, track] : tracks) notes.joints.push_back(std::move(track));
}

/// Returns models and limits of the run, and whether it ran in virtual time; empty if the description of the run cannot
/// be read.
/// @param from, to [s] what is drawn
record::RunNotes notesOf(const record::Recording& recording, uint32_t arm, double from, double to, bool& virtual_time) {
  record::RunNotes notes;
  notes.positions = true;
  const auto about = servo::readAbout(recording.aboutJson());
  if (!about) return notes;
  virtual_time = about->facts.virtual_time;
  for (const scene::Model& model : about->scene.models) notes.models.push_back(model.name);
  if (arm < about->scene.devices.size()) notes.force_limit_n = about->scene.devices[arm].limits.force;
  if (about->scene.devices.size() > 1 && arm < about->scene.devices.size()) notes.arm = about->scene.devices[arm].name;
  noteSilenced(recording, notes);
  noteMarks(recording, notes);
  noteJoints(recording, about->scene, from, to, notes);
  return notes;
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

/// Returns the name of the recording, with the scene and the only arm of the run as far as they are known. If there are
/// several arms, the picture names the one that is drawn.
std::string titleOf(const std::string& file, const record::Recording& recording) {
  const std::string name = std::filesystem::path(file).filename().string();
  const auto about = servo::readAbout(recording.aboutJson());
  if (!about) return name;
  const auto& devices = about->scene.devices;
  return fmt::format("{} (scene {}{})", name, about->scene.file.filename().string(),
                     devices.size() == 1 ? ", arm " + devices[0].name : "");
}

record::RunReport reportOf(const std::string& title, const std::vector<record::Sample>& samples) {
  record::RunReport report;
  report.scene = title;
  report.ticks = samples.size();
  report.seconds = samples.empty() ? 0 : samples.back().t - samples.front().t;
  report.rate_hz = report.seconds > 0 ? static_cast<double>(samples.size() - 1) / report.seconds : 0;
  return report;
}

int plot(const PlotArguments& options) {
  const std::string out = options.out.empty() ? options.file + ".svg" : options.out;
  if (const std::string wrong = wrongPicture(out); !wrong.empty()) return fail(kBadInput, wrong);
  if (const std::string wrong = whyNotWritten(out, pictureKind(), {{options.file, "the recording"}}); !wrong.empty())
    return fail(kBadInput, wrong);
  if (options.from && options.to && *options.from >= *options.to)
    return fail(kBadInput, fmt::format("--from {:g} is not before --to {:g}; expected an earlier time", *options.from,
                                       *options.to));
  auto recording = record::Recording::open(options.file);
  if (!recording) return fail(kBadInput, recording.error());
  if (const std::string& damage = (*recording)->damage(); !damage.empty())
    std::fprintf(stderr, "warning: %s: %s\n", options.file.c_str(), damage.c_str());
  noteOpenEnd(options.file, **recording, "drawing");
  const record::RecordedStream* ticks = (*recording)->stream("ticks");
  const auto columns = ticks != nullptr ? columnsOf(*ticks, options.arm) : std::nullopt;
  if (!columns) return fail(kBadInput, options.file + noTicksOf(options.arm, ticks));
  std::vector<record::Sample> samples;
  std::vector<uint64_t> rows;
  double first = 0, last = 0;
  for (uint64_t row = 0; row < ticks->rows(); ++row) {
    const double t = ticks->number(row, *columns->t);
    (row == 0 ? first : last) = t;
    if (!std::isfinite(t) || (options.from && t < *options.from) || (options.to && t > *options.to)) continue;
    samples.push_back(sampleAt(*ticks, *columns, row));
    rows.push_back(row);
  }
  if (samples.empty() && ticks->rows() > 0)
    return fail(kBadInput, fmt::format("{}: has no tick between --from and --to; the recording covers {:g} to {:g} s",
                                       options.file, first, last));
  if (const std::string wrong = whyNotWritable(out); !wrong.empty()) return fail(kBadInput, wrong);
  record::RunReport report = reportOf(titleOf(options.file, **recording), samples);
  const record::RunNotes notes = notesOf(**recording, options.arm, options.from.value_or(-HUGE_VAL),
                                         options.to.value_or(HUGE_VAL), report.virtual_time);
  if (const record::Column* tick = ticks->find("tick"); tick != nullptr && !notes.arm.empty())
    takeOwnDepths(**recording, options.arm, *tick, *ticks, rows, samples);
  if (auto drawn = record::drawRun(report, samples, notes, out); !drawn) return fail(kFailed, drawn.error());
  std::printf("%s: %zu ticks, %.2f s\n", out.c_str(), samples.size(), report.seconds);
  return kWorked;
}

}  // namespace

void addPlot(const Command& app, int& exit_code) {
  auto options = std::make_shared<PlotArguments>();
  const Command command = app.addSubcommand("plot",
                                            "Draw a recording: depth, force, lateness, position, hinges and sliders "
                                            "over time, with faults, marks, limits and "
                                            "models by name (SVG).");
  command.addOption("file", options->file, "recording or black box").required();
  command.addOption("--out", options->out,
                    "picture to write; default: the name of the recording and .svg, such as run.h5.svg");
  command.addOption("--arm", options->arm, "index of the arm, from 0").wholeWithin(0, 7);
  command.addOption("--from", options->from, "start time [s]");
  command.addOption("--to", options->to, "end time [s]");
  command.footer("Example:\n  hapticd plot run.h5 --out run.svg --from 2 --to 4");
  command.callback([options, &exit_code] { exit_code = plot(*options); });
}

}  // namespace hapticd::cli
