// SPDX-License-Identifier: MIT
/// `hapticd plot`: a picture of a recording.
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "record/picture.hpp"
#include "record/recording.hpp"
#include "session/about.hpp"

namespace hapticd::cli {

namespace {

struct PlotArguments {
  std::string file, out;
  uint32_t arm = 0;
  std::optional<double> from, to;
};

/// The columns that are drawn; nullptr: a recording without them.
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

/// Models and limits of the run, and whether its time was real; without them where its description cannot be read.
record::RunNotes notesOf(const record::Recording& recording, uint32_t arm, bool& virtual_time) {
  record::RunNotes notes;
  notes.positions = true;
  const auto about = servo::readAbout(recording.aboutJson());
  if (!about) return notes;
  virtual_time = about->facts.virtual_time;
  for (const scene::Model& model : about->scene.models) notes.models.push_back(model.name);
  if (arm < about->scene.devices.size()) notes.force_limit_n = about->scene.devices[arm].limits.force;
  return notes;
}

int plot(const PlotArguments& options) {
  const std::string out = options.out.empty() ? options.file + ".svg" : options.out;
  if (const std::string wrong = wrongPicture(out); !wrong.empty()) return fail(kBadInput, wrong);
  if (options.from && options.to && *options.from >= *options.to)
    return fail(kBadInput, "--from is not before --to, expected a time before it");
  auto recording = record::Recording::open(options.file);
  if (!recording) return fail(kBadInput, recording.error());
  if (!(*recording)->closed())
    std::fprintf(stderr, "note: the recording ends early because its writer was killed; drawing what was written\n");
  const record::RecordedStream* ticks = (*recording)->stream("ticks");
  const auto columns = ticks != nullptr ? columnsOf(*ticks, options.arm) : std::nullopt;
  if (!columns) return fail(kBadInput, options.file + ": has no ticks of arm " + std::to_string(options.arm));
  std::vector<record::Sample> samples;
  double first = 0, last = 0;
  for (uint64_t row = 0; row < ticks->rows(); ++row) {
    const double t = ticks->number(row, *columns->t);
    (row == 0 ? first : last) = t;
    if (!std::isfinite(t) || (options.from && t < *options.from) || (options.to && t > *options.to)) continue;
    samples.push_back(sampleAt(*ticks, *columns, row));
  }
  if (samples.empty() && ticks->rows() > 0)
    return fail(kBadInput, fmt::format("{}: has no tick between --from and --to; the recording covers {:g} to {:g} s",
                                       options.file, first, last));
  if (!std::ofstream(out, std::ios::app))
    return fail(kBadInput, out + ": cannot be written, expected a file in a folder that you may write to");
  record::RunReport report;
  report.scene = options.file;
  report.ticks = samples.size();
  report.seconds = samples.empty() ? 0 : samples.back().t - samples.front().t;
  report.rate_hz = report.seconds > 0 ? static_cast<double>(samples.size() - 1) / report.seconds : 0;
  const record::RunNotes notes = notesOf(**recording, options.arm, report.virtual_time);
  if (auto drawn = record::drawRun(report, samples, notes, out); !drawn) return fail(kFailed, drawn.error());
  std::printf("%s: %zu ticks, %.2f s\n", out.c_str(), samples.size(), report.seconds);
  return kWorked;
}

}  // namespace

void addPlot(const Command& app, int& exit_code) {
  auto options = std::make_shared<PlotArguments>();
  const Command command = app.addSubcommand(
      "plot",
      "Draw a recording: depth, force, lateness and position over time, with faults, limits and models by name (SVG).");
  command.addOption("file", options->file, "recording or black box").required();
  command.addOption("--out", options->out, "picture to write; default: FILE.svg");
  command.addOption("--arm", options->arm, "index of the arm, from 0").wholeWithin(0, 7);
  command.addOption("--from", options->from, "start time [s]");
  command.addOption("--to", options->to, "end time [s]");
  command.footer("Example:\n  hapticd plot run.h5 --out run.svg --from 2 --to 4");
  command.callback([options, &exit_code] { exit_code = plot(*options); });
}

}  // namespace hapticd::cli
