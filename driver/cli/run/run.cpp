// SPDX-License-Identifier: MIT
/// `hapticd run`: the daemon itself, in the foreground.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>

#include "base/clock.hpp"
#include "base/file_ending.hpp"
#include "base/os.hpp"
#include "base/shell_word.hpp"
#include "cli/run/outcome.hpp"
#include "cli/run/signals.hpp"
#include "cli/run/view_process.hpp"
#include "cli/support/command.hpp"
#include "cli/support/guarded_command.hpp"
#include "cli/support/output_file.hpp"
#include "diagnostics/check/added_models.hpp"
#include "diagnostics/device/enable_button.hpp"
#include "document/node.hpp"
#include "host/file_stamp.hpp"
#include "log/log.hpp"
#include "session/requests/run_files.hpp"
#include "session/run/runner.hpp"
#include "tune/noisy_damping.hpp"
#include "tune/stability.hpp"
#include "watch/quarantine.hpp"

namespace hapticd::cli {

namespace {

struct RunArguments {
  std::string scene, device, report, picture, record, name, log_level = "info";
  log::Settings log;
  std::optional<double> duration, rate;
  std::optional<int> cpu;
  std::optional<int> priority;
  bool virtual_time = false, allow_non_rt = false, view = false, no_open = false;
};

/// Time at which the program began, taken when its libraries were loaded.
const Nanoseconds program_start = monotonicNow();

/// Returns a file that was given for two purposes, so that one would overwrite the other; "" if all differ. Devices and
/// pipes may be given more than once.
std::string writtenTwice(const RunArguments& options) {
  namespace fs = std::filesystem;
  std::error_code error;
  std::set<fs::path> known{fs::weakly_canonical(options.scene, error)};
  for (const std::string& file : {options.report, options.picture, options.record}) {
    const fs::file_status status = fs::status(file, error);
    if (file.empty() || (fs::exists(status) && !fs::is_regular_file(status))) continue;
    if (!known.insert(fs::weakly_canonical(file, error)).second) return file;
  }
  return "";
}

void showStatus(const servo::Runner& runner) {
  const servo::BlackBoxRow& row = runner.telemetry().newest();
  const double force = std::hypot(row.force[0], row.force[1], row.force[2]);
  std::fprintf(stderr, "\r%8.1f s  late %6.1f us  tick %6.1f us  force %6.3f N  depth %7.3f mm ", row.t,
               static_cast<double>(row.lateness_us), static_cast<double>(row.compute_us), force,
               static_cast<double>(row.depth_m) * 1e3);
}

/// Warns that a plugin that ended an earlier run is tried again, because its file was rebuilt or replaced. Of several
/// builds that did so, the newest is named.
void tellTriedAgain(const scene::Model& model, const std::vector<watch::QuarantinedPlugin>& all) {
  const auto builds =
      std::count_if(all.begin(), all.end(), [&](const auto& one) { return one.plugin == model.plugin; });
  const auto newest =
      std::find_if(all.rbegin(), all.rend(), [&](const auto& one) { return one.plugin == model.plugin; });
  if (newest == all.rend()) return;
  const watch::QuarantinedPlugin& entry = *newest;
  log::write(
      HSP_LOG_WARNING, "",
      "model " + model.name + ": plugin '" + entry.plugin + "' ended an earlier run by " + entry.reason + " (" +
          entry.fileForPeople() + (builds > 1 ? "; and " + std::to_string(builds - 1) + " before it" : "") +
          "); the file has changed since, or is another one, so it runs again\n  fix: " + "hapticd plugin check " +
          shellWord(model.library.string()) + "; once it is repaired: hapticd plugin clear " + entry.plugin);
}

/// Removes from the scene the models of plugins that crashed the daemon. They stay out until the file of the plugin
/// changes or the user clears the plugin. @return a message for each model
std::vector<std::string> leaveOutQuarantined(scene::Scene& scene, const std::filesystem::path& dir) {
  std::vector<std::string> messages;
  if (dir.empty()) return messages;
  const std::vector<watch::QuarantinedPlugin> all = watch::quarantined(dir);
  for (const watch::QuarantinedPlugin& entry : all)
    std::erase_if(scene.models, [&](const scene::Model& model) {
      if (!entry.holds(model.plugin, host::identityOnDisk(model.library))) return false;
      messages.push_back("model " + model.name + ": plugin '" + entry.plugin + "' ended an earlier run by " +
                         entry.reason + "; the model is left out; once the plugin is repaired: hapticd plugin clear " +
                         entry.plugin);
      return true;
    });
  std::set<std::string> told;  // several models may have one plugin
  for (const scene::Model& model : scene.models)
    if (told.insert(model.plugin).second) tellTriedAgain(model, all);
  return messages;
}

/// Warns, before any force is sent, of paths that are too fast, of arms that push less because they are slow, and of
/// stiffnesses that cannot be stable on the opened arms.
void warnOfSettings(servo::Runner& runner, double rate) {
  scene::Scene scene = runner.scene();
  scene.servo.rate = rate;
  std::vector<double> stiffness;
  for (const auto& shape : runner.world().shapes())
    if (shape != nullptr) stiffness.push_back(shape->report().max_stiffness);
  printWarnings(tune::fastPaths(scene), stderr);
  for (size_t i = 0; i < runner.arms().size(); ++i) {
    document::Problems slow;
    if (const std::string& why = runner.arms()[i]->slowness(); !why.empty())
      document::report(slow, scene.devices[i].place, "servo.rate", scene.devices[i].name + ": " + why);
    printWarnings(slow, stderr);
    printWarnings(tune::unstableSettings(scene, scene.devices[i], runner.arms()[i]->info(), stiffness), stderr);
    printWarnings(tune::noisyDamping(scene, scene.devices[i], runner.arms()[i]->info()), stderr);
  }
}

/// Logs a message, unless the error that ends the set-up will contain it anyway.
void logOfRun(int level, const std::string& who, const std::string& text) {
  if (!SetupErrors::holdsBack(level, who, text)) log::write(level, who, text);
}

/// Starts a process that serves a page for this run. It must start before this process takes rights that a child must
/// not inherit.
Result<void> showPage(const RunArguments& options, const servo::RunFiles* files, scene::Scene& scene) {
  if (files == nullptr || files->name().empty())
    return Error{
        "--view: a run in virtual time has no black box, so there is nothing to show\n  fix: leave --virtual-time out"};
  guideSimulatedHands(scene);
  std::vector<std::string> arguments{"--name", files->name(), "--control", "--until-end"};
  if (!options.no_open) arguments.emplace_back("--open");
  if (auto started = startView(arguments); !started) return Error{started.error()};
  return {};
}

/// Returns why a recording cannot have this file name, or "" if it can: a person who writes run.csv expects a table.
std::string wrongRecording(const std::string& file) {
  const std::string ending = endingOf(file);
  for (const char* other : {".csv", ".mcap", ".json", ".svg", ".txt", ".xlsx"})
    if (ending == other)
      return file +
             ": recordings are HDF5, expected a name that ends in .h5\n  fix: hapticd export RECORDING makes tables "
             "(--csv FOLDER) or MCAP (--mcap FILE) of it";
  return "";
}

/// Returns what is wrong with the files that the run must write; "" if nothing is.
std::string wrongFiles(const RunArguments& options) {
  if (const std::string wrong = wrongPicture(options.picture); !wrong.empty()) return wrong;
  for (const std::string& file : {options.report, options.picture, options.record})
    if (const std::string wrong = whyNotWritable(file); !wrong.empty()) return wrong;
  const Inputs inputs{{options.scene, "the scene"}, {options.device, "the device file"}};
  for (const auto& [file, kind] : {std::pair(options.report, reportKind()), std::pair(options.picture, pictureKind()),
                                   std::pair(options.record, recordingKind())})
    if (const std::string wrong = whyNotWritten(file, kind, inputs); !wrong.empty()) return wrong;
  if (const std::string file = writtenTwice(options); !file.empty())
    return file + ": the file is named twice, expected different files for the scene, --report, --picture and --record";
  return wrongRecording(options.record);
}

servo::RunOptions runOptions(const RunArguments& options, const scene::Scene& scene) {
  servo::RunOptions how;
  how.rate = options.rate.value_or(scene.servo.rate);
  how.duration = options.duration;
  how.virtual_time = options.virtual_time;
  how.cpu = options.cpu ? options.cpu : daemonSettings().cpu;
  how.priority = options.priority.value_or(daemonSettings().priority.value_or(os::kServoPriority));
  how.allow_non_rt = options.allow_non_rt;
  how.record = options.record;
  how.state_dir = watch::stateDir().string();
  if (how.state_dir.empty())
    log::write(HSP_LOG_WARNING, "",
               "no state folder is writable: a plugin that ends this run will not be left out of the next one\n  fix: "
               "set HOME, XDG_STATE_HOME or STATE_DIRECTORY to a folder that you may write to");
  return how;
}

/// Runs from the first tick to the last.
Result<void> tickToTheEnd(servo::Runner& runner, servo::RunFiles* files) {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  size_t told = 0;
  const auto every = [&](const servo::Runner& r) {
    for (; told < r.warnings().size(); ++told) log::write(HSP_LOG_WARNING, "", r.warnings()[told]);
    if (terminal) showStatus(r);
    if (files != nullptr) files->look();
  };
  const auto end = [files] {
    if (files != nullptr) files->end();
  };
  auto done = runner.run(every, end);
  end();  // the run has not begun
  if (terminal) std::fputs("\r\033[K", stderr);
  return done;
}

/// Loads a scene for a run that goes on, with all that the command line and the daemon file change in every scene.
Result<scene::Scene> loadDuringRun(const RunArguments& options, const std::string& file) {
  catalog().refresh();
  scene::Loaded loaded = scene::load(file, catalog(), {true, options.device});
  std::string problems;
  for (const document::Problem& problem : loaded.problems) problems += (problems.empty() ? "" : "\n") + problem.text();
  if (!loaded.scene) return Error{problems};
  applyDaemonFile(*loaded.scene);
  if (options.view) guideSimulatedHands(*loaded.scene);
  return std::move(*loaded.scene);
}

int runScene(const RunArguments& options, scene::Scene& scene) {
  servo::RunOptions how = runOptions(options, scene);
  // a run in virtual time is soon over, so it has a status page and a black box only if it was given a name
  std::unique_ptr<servo::RunFiles> files;
  if (!options.virtual_time || !options.name.empty()) {
    auto opened = servo::RunFiles::open(options.name, how);
    if (!opened) return fail(kBadInput, opened.error());
    files = std::move(*opened);
  }
  if (options.view)
    if (auto shown = showPage(options, files.get(), scene); !shown) return fail(kFailed, shown.error());
  const std::vector<std::string> left_out = leaveOutQuarantined(scene, watch::stateFolder());
  for (const std::string& text : left_out) log::write(HSP_LOG_WARNING, "", text);
  const SetupErrors once;
  auto world = servo::Runner::buildWorld(scene, how, logOfRun);
  if (!world) return fail(kBadInput, world.error());
  heedStopSignals();  // from here on files must be removed at the end
  auto runner = servo::Runner::prepare(scene, how, std::move(*world), logOfRun);
  if (!runner) return fail(kFailed, runner.error());
  once.print();
  warnOfSettings(**runner, how.rate);
  const StopBySignal stop(**runner);
  if (!options.virtual_time) heedSuspendSignal();
  const auto advise = [&runner](const scene::Scene& models, const std::vector<double>& stiffness) {
    return diagnostics::warningsOfAddedModels(**runner, models, stiffness, catalog());
  };
  const auto load = [&options](const std::string& file) { return loadDuringRun(options, file); };
  if (files) files->serve(**runner, load, catalog(), advise, logOfRun);
  if (auto done = tickToTheEnd(**runner, files.get()); !done) return fail(kFailed, done.error());
  return conclude({options.scene, options.report, options.picture, options.record, how.rate, options.virtual_time,
                   program_start, left_out},
                  **runner);
}

/// Reports an enable button that no report of its arm contains, because forces could never be enabled then. Returns
/// false if there is one.
bool switchesAreThere(const scene::Scene& scene) {
  document::Problems wrong;
  for (const scene::Device& device : scene.devices)
    if (const auto root = document::parseFile(device.file, wrong))
      diagnostics::checkEnableButton(*root, device.file.string(), wrong);
  printProblems(wrong, stderr);
  return wrong.empty();
}

int run(const RunArguments& options) {
  if (auto opened = log::open(options.log); !opened) return fail(kBadInput, opened.error());
  if (const std::string wrong = wrongFiles(options); !wrong.empty()) return fail(kBadInput, wrong);
  // Watches the plugins whenever the run itself does not watch them: during the set-up, and until all memory that a
  // plugin could damage is freed.
  const GuardedCommand guarded(watch::stateDir());
  auto scene = loadSceneOrReport(options.scene, options.device);
  if (!scene || !switchesAreThere(*scene)) return kBadInput;
  if (scene->devices.front().chosen_by_default)
    log::write(HSP_LOG_INFO, "",
               "no device is named: using the simulated one of " + scene->devices.front().file.string());
  return runScene(options, *scene);
}

/// Returns "" if the text is the number of a processor of this machine.
std::string ownProcessor(const std::string& text) {
  const int last = os::processors() - 1;
  const std::string range = last > 0 ? "0 to " + std::to_string(last) : "0";
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || *end != '\0' || number != std::floor(number))
    return "\"" + text + "\" is not a whole number, expected " + range;
  if (number >= 0 && number <= last) return "";
  return "this machine has no processor " + text + ", expected " + range;
}

/// Returns "" if the text is a number; for "1s" and the like, returns what to write instead.
std::string plainSeconds(const std::string& text) {
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  if (end != text.c_str() && *end == '\0') return "";
  return "\"" + text + "\" is not a number, expected seconds, such as --for 10";
}

void addTiming(const Command& command, RunArguments& options) {
  command.addOption("--device", options.device, "device file to use instead of the scene's");
  command.addOption("--for", options.duration, "duration of the run [s]; default: until it is stopped (Ctrl-C)")
      .check(plainSeconds)
      .within(1e-3, 1e9);
  command.addFlag("--virtual-time", options.virtual_time,
                  "run as fast as the processor allows, on simulated devices; the same input gives the same bits");
  command.addOption("--rate", options.rate, "servo rate [Hz] instead of the scene's")
      .within(10.0, 20000.0);  // the range of servo.rate
  command.addOption("--cpu", options.cpu, "processor to pin the servo thread to: 0 to one less than nproc prints")
      .check(ownProcessor);
  command
      .addOption("--priority", options.priority,
                 "SCHED_FIFO priority of the servo thread; default: the daemon file's, or 80")
      .wholeWithin(1, 98);
}

void addOutputs(const Command& command, RunArguments& options) {
  command.addOption("--report", options.report, "write a report (JSON)");
  command.addOption(
      "--picture", options.picture,
      "write a picture of depth, force and lateness over time (SVG), of the last 10 s of a longer run; hapticd "
      "plot draws all of a recording");
  command.addOption("--name", options.name, "name of this daemon for top, ctl and view; default: hapticd")
      .check([](const std::string& name) {
        const bool plain = name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_") ==
                           std::string::npos;
        return plain && name.size() <= 32 ? std::string() : "expected up to 32 letters, digits, - and _";
      });
  command.addOption("--record", options.record,
                    "record every tick (HDF5), for replay, plot, Python and MATLAB; on a full disk the run goes on, "
                    "and its exit code is 1");
  command.addFlag("--view", options.view,
                  "show the run in a browser page; on a simulated arm the mouse replaces the hand's script");
  command.addFlag("--no-open", options.no_open, "with --view: print the address of the page, but start no browser")
      .needs("--view");
  command.addOption("--log-level", options.log_level, "lowest level that is logged; default: info")
      .oneOf({"debug", "info", "warning", "error"});
  command.addOption("--log-file", options.log.file,
                    "write the log to this file too; at 10 MB a new file begins, and three older ones are kept");
  command.addFlag("--log-json", options.log.json, "log one JSON object per line");
}

}  // namespace

void addRun(const Command& app, int& exit_code) {
  auto options = std::make_shared<RunArguments>();
  const Command command = app.addSubcommand("run", "Run the daemon: the servo loop on a scene and its device.");
  command.addOption("scene", options->scene, "scene file (YAML)").required();
  addTiming(command, *options);
  addOutputs(command, *options);
  command.addFlag("--allow-non-rt", options->allow_non_rt, "allow forces on real hardware without real-time rights");
  command.footer("Example:\n  hapticd run config/scenes/teapot.yaml --for 10 --report report.json --picture run.svg");
  command.callback([options, &exit_code] {
    options->log.level = log::levelOf(options->log_level);
    exit_code = run(*options);
    watch::guardTheEnd(watch::stateDir());
  });
}

}  // namespace hapticd::cli
