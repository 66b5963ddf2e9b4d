// SPDX-License-Identifier: MIT
#include "cli/recording/explain_recording.hpp"

#include <algorithm>
#include <cstdio>
#include <map>

#include "base/file_beginning.hpp"
#include "base/file_ending.hpp"
#include "cli/recording/force_of_a_tick.hpp"
#include "cli/recording/joint_ranges.hpp"
#include "cli/recording/recorded_marks.hpp"
#include "cli/recording/recorded_orders.hpp"
#include "cli/recording/tick_times.hpp"
#include "cli/recording/touched_features.hpp"
#include "cli/support/command.hpp"
#include "hapticd/abi.h"
#include "session/replay/recorded_events.hpp"

namespace hapticd::cli {

namespace {

constexpr size_t kMostLines = 200;

const char* levelName(int level) {
  return level >= HSP_LOG_ERROR ? "error" : level == HSP_LOG_WARNING ? "warning" : "info";
}

void printModel(const servo::RunModel& one, TickTimes& times) {
  const std::string plugin = one.model.plugin.empty() ? "" : " (" + one.model.plugin + ")";
  std::printf("  model     %s%s", one.model.name.c_str(), plugin.c_str());
  if (one.since > 0) std::printf(", from %.4f s on", times.of(static_cast<double>(one.since)));
  std::printf("\n");
}

void printRun(const std::string& file, const record::Recording& recording, const servo::RecordedRun& run,
              const servo::RunModels& models) {
  const record::RecordedStream* ticks = recording.stream("ticks");
  const uint64_t rows = ticks != nullptr ? ticks->rows() : 0;
  std::printf("%s: a %s of hapticd %s, begun %s\n", file.c_str(), recording.blackBox() ? "black box" : "recording",
              run.version.c_str(), run.started.c_str());
  std::printf("  scene     %s\n", run.scene.file.string().c_str());
  std::printf("  time      %.2f s: %llu ticks at %g Hz, in %s time%s\n", static_cast<double>(rows) / run.facts.rate,
              static_cast<unsigned long long>(rows), run.facts.rate, run.facts.virtual_time ? "virtual" : "real",
              recording.closed() || recording.blackBox() ? "" : "; its writer did not end normally");
  if (!recording.damage().empty()) std::printf("  damage    %s\n", recording.damage().c_str());
  for (const scene::Device& device : run.scene.devices)
    std::printf("  arm       %s (%s)\n", device.name.c_str(), device.module.c_str());
  TickTimes times(recording);
  for (const servo::RunModel& one : models.all()) printModel(one, times);
}

std::string timesInWords(uint64_t count) {
  return std::to_string(count) + (count == 1 ? " time" : " times");
}

/// Returns what a run without a message in its log has to tell. A daemon that crashes writes its black box itself, and
/// no message of the crash.
const char* nothingTold(const std::string& file) {
  return endingOf(file) == ".flight" ? "no fault before its end, which was a crash or a call that did not end"
                                     : "no fault, and no model was silenced, came or left";
}

/// Prints the events that the log of the run had. Touches and clicks are many, so only their number is printed.
void printEvents(const std::string& file, const std::vector<servo::RecordedMessage>& messages) {
  struct Counts {
    uint64_t touches = 0, clicks = 0;
  };
  std::map<std::string, Counts> felt;
  size_t lines = 0, left = 0;
  std::printf("events\n");
  for (const servo::RecordedMessage& message : messages) {
    if (message.level <= HSP_LOG_DEBUG) {
      ++(message.kind == HAPTICD_CLICK ? felt[message.who].clicks : felt[message.who].touches);
    } else if (lines++ < kMostLines) {
      std::printf("  %9.4f s  %-7s  %s%s%s\n", message.t, levelName(message.level), message.who.c_str(),
                  message.who.empty() ? "" : ": ", message.text.c_str());
    } else {
      ++left;
    }
  }
  if (left > 0) std::printf("  and %zu more; for all, run: hapticd export FILE --csv OUT --stream events\n", left);
  if (lines == 0) std::printf("  %s\n", nothingTold(file));
  for (const auto& [model, counts] : felt)
    std::printf("  %s was touched %s%s\n", model.c_str(), timesInWords(counts.touches).c_str(),
                counts.clicks > 0 ? (", and clicked " + timesInWords(counts.clicks) + " (in or out)").c_str() : "");
}

void printLines(const char* title, const std::vector<std::string>& lines, const char* stream) {
  if (!lines.empty()) std::printf("%s\n", title);
  for (size_t i = 0; i < std::min(lines.size(), kMostLines); ++i) std::printf("  %s\n", lines[i].c_str());
  if (lines.size() > kMostLines)
    std::printf("  and %zu more; for all, run: hapticd export FILE --csv OUT --stream %s\n", lines.size() - kMostLines,
                stream);
}

/// Returns a line for each mark, such as "2.0010 s  trial 7 begins".
std::vector<std::string> markLines(const record::Recording& recording) {
  std::vector<std::string> lines;
  for (const auto& [t, text] : recordedMarks(recording)) lines.push_back(fmt::format("{:9.4f} s  {}", t, text));
  return lines;
}

/// Prints what a recording is of, what happened, what was touched and what moved.
void printAll(const std::string& file, const record::Recording& recording, const servo::RecordedRun& run,
              const servo::RunModels& models) {
  printRun(file, recording, run, models);
  printEvents(file, servo::messagesOf(recording, run, models));
  printLines("marks", markLines(recording), "marks");
  printLines("orders", recordedOrders(recording, run, models), "orders");
  printLines("touched", touchedFeatures(recording, models, run.facts.rate), "contacts");
  printLines("moved", jointRanges(recording, models, run.facts.rate), "poses");
}

}  // namespace

bool isRecording(const std::string& file) {
  const auto first = readBeginning(file, 4);  // it does not wait for the writer of a pipe
  return first && *first == "\x89HDF";
}

int explainRecording(const std::string& file, std::optional<double> at) {
  const auto recording = record::Recording::open(file);
  if (!recording) return fail(kBadInput, recording.error());
  const auto run = servo::readAbout((*recording)->aboutJson());
  if (!run) return fail(kBadInput, file + ": " + run.error());
  const servo::RunModels models(**recording, run->scene);
  const auto forces = forceLines(**recording, models, run->scene, at);
  if (!forces) return fail(kBadInput, forces.error());
  if (at) {
    printLines("force", *forces, "contacts");
  } else {
    printAll(file, **recording, *run, models);
    printLines("greatest force (--at SECONDS shows that of another time)", *forces, "contacts");
  }
  if (auto same = (*recording)->unchanged(); !same) return fail(kFailed, same.error());
  return kWorked;
}

}  // namespace hapticd::cli
