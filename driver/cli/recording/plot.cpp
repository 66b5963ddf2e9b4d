// SPDX-License-Identifier: MIT
/// `hapticd plot`: draws a picture of a recording.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/recording/plot_notes.hpp"
#include "cli/support/command.hpp"
#include "cli/support/open_end.hpp"
#include "cli/support/output_file.hpp"
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
  const record::RunNotes notes = notesOf(**recording, *ticks, rows, options.arm, samples, report.virtual_time);
  if (auto same = (*recording)->unchanged(); !same) return fail(kFailed, same.error());
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
