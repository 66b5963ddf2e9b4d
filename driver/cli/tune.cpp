// SPDX-License-Identifier: MIT
/// `hapticd tune`: measures cost and error of the settings of a scene on this machine, and chooses one.
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "base/clock.hpp"
#include "base/os.hpp"
#include "base/regular_file.hpp"
#include "cli/support/command.hpp"
#include "cli/support/guarded_command.hpp"
#include "cli/support/open_end.hpp"
#include "cli/support/probe_path.hpp"
#include "cli/support/tick_watch.hpp"
#include "record/recording.hpp"
#include "session/messages/setup_watch.hpp"
#include "tune/page.hpp"
#include "tune/write_scene.hpp"
#include "world/world.hpp"

namespace hapticd::cli {
namespace {

struct TuneArguments {
  std::string scene, probe, motion, page, picture, json;
  std::optional<double> budget_us;
  double tolerance_um = 1, force_tolerance = 0.1, motion_seconds = 5, limit_seconds = 50;
  bool write = false;
};

std::atomic<bool> stopped{false};

/// Ctrl-C ends the search and keeps what was found. If a plugin never returns, the search cannot end: a second Ctrl-C,
/// or any signal not sent by a person, ends the command.
void stopTuning(int signal) {
  if (stopped.exchange(true) || signal != SIGINT) watch::forceEnd(currentOwner());
}

/// Returns the motion of a path file, resampled to the scene's rate.
Result<tune::Motion> motionOfFile(const std::string& file, double rate) {
  auto rows = readProbePath(file);
  if (!rows) return Error{rows.error()};
  if (rows->size() < 100)
    return Error{file + ": the path has " + std::to_string(rows->size()) +
                 " rows; expected at least 100, one for each tick"};
  const double period = (rows->back().t - rows->front().t) / static_cast<double>(rows->size() - 1);
  std::vector<Eigen::Vector3d> position;
  for (const PathRow& row : *rows) {
    if (!row.finite())
      return Error{file + ": a row holds a value that is not a finite number; expected a path without gaps"};
    position.push_back(row.position);
  }
  return tune::resampled(tune::motionThrough(std::move(position), period), rate);
}

/// Returns the motion of the first arm in a recording or a black box.
Result<tune::Motion> motionOfRecording(const std::string& file, double rate) {
  auto recording = record::Recording::open(file);
  if (!recording) return Error{recording.error()};
  const record::RecordedStream* ticks = (*recording)->stream("ticks");
  const record::Column* columns[] = {nullptr, nullptr, nullptr, nullptr};
  const char* names[] = {"t", "arm0_x", "arm0_y", "arm0_z"};
  for (size_t i = 0; i < 4; ++i)
    if (ticks == nullptr || (columns[i] = ticks->find(names[i])) == nullptr)
      return Error{file + ": the stream of ticks has no column " + names[i] +
                   "; expected a recording of `hapticd run --record`"};
  noteOpenEnd(file, **recording, "measuring over");
  if (ticks->rows() < 100)
    return Error{file + ": the recording has " + std::to_string(ticks->rows()) + " ticks; expected at least 100"};
  std::vector<Eigen::Vector3d> position;
  for (uint64_t i = 0; i < ticks->rows(); ++i) {
    Eigen::Vector3d p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = ticks->number(i, *columns[1 + axis]);
    if (!p.allFinite() && position.empty())
      return Error{file +
                   ": the first tick has no position of the tip (arm0_x, arm0_y, arm0_z); expected a recording that "
                   "begins with samples"};
    position.push_back(p.allFinite() ? p : position.back());
  }
  if (auto same = (*recording)->unchanged(); !same) return Error{same.error()};
  const double seconds = ticks->number(ticks->rows() - 1, *columns[0]) - ticks->number(0, *columns[0]);
  const double period = seconds / static_cast<double>(ticks->rows() - 1);
  if (!(period > 0))
    return Error{file + ": the times of its ticks do not increase; expected a recording of `hapticd run --record`"};
  return tune::resampled(tune::motionThrough(std::move(position), period), rate);
}

/// Prints nothing: messages of plugins were printed at the first set-up, and the same models are now set up hundreds of
/// times.
void quiet(int level, const std::string& who, const std::string& text) {
  if (level >= HSP_LOG_ERROR) logToTerminal(level, who, text);
}

/// Returns the motion that the user gave (a path file or a recording), or the motion of the scene's hand.
Result<tune::Motion> motionFor(const TuneArguments& options, const scene::Scene& scene) {
  if (!options.probe.empty()) return motionOfFile(options.probe, scene.servo.rate);
  if (!options.motion.empty()) return motionOfRecording(options.motion, scene.servo.rate);
  return tune::motionOfHand(scene, options.motion_seconds, quiet);
}

std::string nameOfMotion(const TuneArguments& options) {
  const std::string file = options.probe + options.motion;
  return file.empty() ? "the motion of the scene's hand" : file;
}

/// Shows the progress: a bar on a terminal, or a line every five seconds in a log.
bool showProgress(const tune::Progress& progress) {
  static Nanoseconds told = monotonicNow();
  constexpr Nanoseconds kEvery = 5'000'000'000;
  if (isatty(STDERR_FILENO) == 0) {
    if (monotonicNow() - told >= kEvery) {
      told = monotonicNow();
      std::fprintf(stderr, "tune: %zu of %zu settings tried, about %.0f s left\n", progress.done, progress.expected,
                   progress.seconds_left);
    }
  } else {
    constexpr int kWidth = 30;
    const int filled = static_cast<int>(kWidth * progress.done / std::max<size_t>(progress.expected, 1));
    std::fprintf(stderr, "\r[%-*s] %zu of %zu settings, %.0f s left \033[K", kWidth,
                 std::string(static_cast<size_t>(filled), '#').c_str(), progress.done, progress.expected,
                 progress.seconds_left);
  }
  return !stopped;
}

bool save(const std::string& file, const std::string& text) {
  if (file.empty()) return true;
  const auto written = writeWhole(file, text);
  if (!written) fail(kFailed, written.error());
  return static_cast<bool>(written);
}

std::string tunedName(const std::string& scene) {
  std::filesystem::path path(scene);
  return (path.parent_path() / (path.stem().string() + ".tuned.yaml")).string();
}

int report(const TuneArguments& options, const tune::Findings& findings) {
  const bool to_program = options.json == "-";
  std::fputs(to_program ? tune::json(findings).c_str() : tune::table(findings).c_str(), stdout);
  bool saved = save(options.page, tune::page(findings));
  saved = save(options.picture, tune::picture(findings)) && saved;
  saved = (to_program || save(options.json, tune::json(findings))) && saved;
  if (options.write) {
    const std::string file = tunedName(options.scene);
    if (auto written = tune::writeScene(findings, options.scene, file); !written) return fail(kFailed, written.error());
    std::fprintf(to_program ? stderr : stdout, "\nwritten: %s\n", file.c_str());
  }
  if (!saved) return kFailed;
  return findings.tuning.reached ? kWorked : kFailed;
}

/// Measures the servo's own settings.
Result<void> sweep(const scene::Scene& scene, const tune::Motion& motion, bool uses_velocity,
                   tune::Findings& findings) {
  auto rates = tune::measureRates(scene, motion, quiet);
  if (!rates) return Error{rates.error()};
  findings.rates = std::move(*rates);
  auto radii = tune::measureRadii(scene, motion, quiet);
  if (!radii) return Error{radii.error()};
  findings.radii = std::move(*radii);
  if (!uses_velocity) return {};
  auto estimators = tune::measureEstimators(scene, motion, quiet);
  if (!estimators) return Error{estimators.error()};
  findings.estimators = std::move(*estimators);
  return {};
}

int tuneScene(const TuneArguments& options) {
  auto scene = loadSceneOrReport(options.scene);
  if (!scene) return kBadInput;
  if (scene->models.empty()) return fail(kBadInput, options.scene + ": the scene has no model, expected one to tune");
  const GuardedCommand guarded;
  const TickWatch watched;
  std::optional<servo::SetupWatch> waiting(std::in_place, logToTerminal);
  auto world = servo::World::build(*scene, {.rate = scene->servo.rate}, logToTerminal);
  waiting.reset();
  if (!world) return fail(kBadInput, world.error());
  const bool uses_velocity = (*world)->needsVelocity();
  world->reset();

  auto motion = motionFor(options, *scene);
  if (!motion)
    return fail(kBadInput, motion.error() + ((options.probe + options.motion).empty()
                                                 ? "; if no hand is simulated, give a motion with --probe or --motion"
                                                 : ""));
  tune::Findings findings;
  findings.scene = options.scene;
  findings.motion = nameOfMotion(options) + ", " + std::to_string(motion->position.size()) + " ticks";
  findings.knobs = tune::findKnobs(*scene, catalog());
  if (options.budget_us) findings.goal.budget_ns = *options.budget_us * 1e3;
  findings.goal.tolerance_m = options.tolerance_um * 1e-6;
  findings.goal.force_tolerance_n = options.force_tolerance;
  findings.limit_seconds = options.limit_seconds;

  os::onStopSignal(stopTuning);
  const GuardedCommand in_front;  // installed before the handler of signals below
  auto tuning =
      tune::search(*scene, *motion, findings.knobs, {findings.goal, options.limit_seconds, showProgress, quiet});
  if (isatty(STDERR_FILENO) != 0) std::fputs("\r\033[K", stderr);
  if (!tuning) return fail(kFailed, tuning.error());
  findings.tuning = std::move(*tuning);
  tune::numberPoints(findings);
  if (!stopped)
    if (auto swept = sweep(*scene, *motion, uses_velocity, findings); !swept) return fail(kFailed, swept.error());
  return report(options, findings);
}

/// Adds the options for the goal of the search and its motion.
void addGoal(const Command& command, const std::shared_ptr<TuneArguments>& options) {
  const Option budget = command
                            .addOption("--budget-us", options->budget_us,
                                       "choose the most accurate setting whose tick time (p99) is below this [us]")
                            .within(1e-3, 1e6);
  command
      .addOption("--tolerance-um", options->tolerance_um,
                 "choose the cheapest setting with errors of the foot point below this [um]")
      .within(1e-6, 1e6)
      .excludes(budget)
      .showDefault();
  command
      .addOption("--force-tolerance-n", options->force_tolerance,
                 "with --tolerance-um: also require errors of the force below this [N]")
      .within(1e-9, 1e3)
      .showDefault();
  const Option probe =
      command.addOption("--probe", options->probe,
                        "measure over this path (CSV, as for trace) instead of the motion of the scene's hand");
  command.addOption("--motion", options->motion, "measure over the motion in this recording or black box")
      .excludes(probe);
  command.addOption("--motion-seconds", options->motion_seconds, "duration of the hand's motion [s]")
      .within(0.2, 10.0)
      .showDefault();
  command.addOption("--limit-seconds", options->limit_seconds, "stop trying settings after this [s]")
      .within(1.0, 86400.0)
      .showDefault();
}

void addOutputs(const Command& command, const std::shared_ptr<TuneArguments>& options) {
  command.addFlag("--write", options->write,
                  "write SCENE.tuned.yaml beside the scene, with the chosen setting and the reason");
  command.addOption("--page", options->page, "write a report (one HTML file that needs no network)");
  command.addOption("--picture", options->picture, "write the picture (SVG)");
  command
      .addOption("--json", options->json,
                 "write everything that was measured (JSON) to this file; alone or as -: print it instead of the table")
      .expected(0, 1)
      .valueWithoutWord("-");
}

}  // namespace

void addTune(const Command& app, int& exit_code) {
  auto options = std::make_shared<TuneArguments>();
  const Command command = app.addSubcommand(
      "tune", "Measure the cost and the error of a scene's settings on this machine, and choose one.");
  command.addOption("scene", options->scene, "scene file (YAML)").required();
  addGoal(command, options);
  addOutputs(command, options);
  command.footer(
      "Errors are measured against a converged reference; the largest over the motion counts. Ctrl-C ends the "
      "measurement\nand keeps the results so far; a second one ends the command at once. The exit code is 1 if no "
      "setting reaches the goal.\n\nExample:\n  "
      "hapticd tune config/scenes/teapot.yaml --tolerance-um 1 --page tune.html --write");
  setGuardedCallback(command, exit_code, [options] { return tuneScene(*options); });
}

}  // namespace hapticd::cli
