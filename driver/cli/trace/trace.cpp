// SPDX-License-Identifier: MIT
/// `hapticd trace`: runs the servo core over a prescribed probe path, in virtual time, without a device.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/offline_tick.hpp"
#include "cli/support/command.hpp"
#include "cli/support/guarded_command.hpp"
#include "cli/support/output_file.hpp"
#include "cli/support/probe_path.hpp"
#include "cli/support/tick_watch.hpp"
#include "cli/trace/trace_writer.hpp"
#include "document/suggestion.hpp"
#include "servo/loop/lockstep.hpp"
#include "servo/velocity/probe_velocity.hpp"
#include "session/messages/setup_watch.hpp"
#include "session/messages/silence_reason.hpp"
#include "world/world.hpp"

namespace hapticd::cli {

namespace {

struct TraceArguments {
  std::string scene, probe, out, models;
};

/// Returns the indices of the models to print; an empty `filter` means all.
Result<std::vector<uint32_t>> chosenModels(const scene::Scene& scene, const std::string& filter) {
  constexpr std::size_t kMostListed = 24;
  std::vector<uint32_t> chosen;
  if (filter.empty()) {
    for (uint32_t i = 0; i < scene.models.size(); ++i) chosen.push_back(i);
    return chosen;
  }
  for (const std::string& name : command_line::split(filter, ',')) {
    const auto it =
        std::find_if(scene.models.begin(), scene.models.end(), [&](const auto& m) { return m.name == name; });
    if (it == scene.models.end()) {
      std::vector<std::string> names;
      for (const scene::Model& model : scene.models) names.push_back(model.name);
      return Error{"--models: the scene has no model \"" + name + "\"; expected one of " +
                   document::listedFor(name, names, kMostListed) + document::suggestionOfName(name, names)};
    }
    chosen.push_back(static_cast<uint32_t>(it - scene.models.begin()));
  }
  return chosen;
}

/// Runs the core over the path, one tick per row.
Result<void> traceRows(const scene::Scene& scene, servo::World& world, const std::vector<PathRow>& rows,
                       TraceWriter& writer) {
  std::optional<servo::ProbeVelocity> velocity;
  if (world.needsVelocity()) {
    auto estimator = servo::makeEstimator(scene.servo.velocity, scene.servo.rate);
    if (!estimator) return Error{estimator.error()};
    velocity.emplace(*estimator);
  }
  servo::Lockstep lockstep = world.lockstep();
  servo::Probe probe;
  for (size_t i = 0; i < rows.size(); ++i) {
    const double t = rows[i].t, dt = i == 0 ? 0 : t - rows[i - 1].t;
    probe.valid = rows[i].finite();
    if (probe.valid) {
      probe.position = rows[i].position;
      probe.orientation = rows[i].orientation.normalized();
      if (velocity) probe.velocity = velocity->update(probe.position, dt);
    } else if (velocity) {
      velocity->reset();
    }
    const OfflineTick counted;
    world.core().publish(t, {&probe, 1});
    lockstep.before(t);
    world.core().tick(t, dt, {&probe, 1});
    if (auto written = writer.write(t, world.core(), probe.valid); !written) return written;
  }
  return writer.close();
}

/// Returns the files that a trace reads, each with a name for it.
Inputs filesRead(const TraceArguments& options, const scene::Scene& scene) {
  Inputs files{{options.scene, "the scene"}, {options.probe, "the probe path"}};
  for (const scene::Device& device : scene.devices) files.emplace_back(device.file.string(), "a device file");
  for (const scene::Model& model : scene.models)
    for (const scene::Value& value : model.parameters)
      if (value.kind == HSP_PATH) files.emplace_back(value.text, "a file of the scene's models");
  return files;
}

/// Warns of a path that is far from everything, because it was probably given in mm.
void warnOfFarRows(const std::string& file, const std::vector<PathRow>& rows) {
  constexpr double kFar = 10;  // [m]
  for (size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i].finite() || !(rows[i].position.norm() > kFar)) continue;
    std::fprintf(
        stderr,
        "warning: %s: row %zu is %.4g m from the world's origin, where no arm reaches; positions must be in m\n",
        file.c_str(), i + 1, rows[i].position.norm());
    return;
  }
}

/// Warns if the times of the rows are not those of ticks, because each row is one tick: damping and motion then differ
/// from a run.
void warnOfRowTimes(const std::string& file, const std::vector<PathRow>& rows, double rate) {
  constexpr double kFactor = 2;
  if (rows.size() < 2) return;
  const double apart = (rows.back().t - rows.front().t) / static_cast<double>(rows.size() - 1);
  if (apart <= kFactor / rate && apart >= 1 / (kFactor * rate)) return;
  std::fprintf(stderr,
               "warning: %s: rows are %.4g s apart, but a tick of this scene lasts %.4g s (servo.rate %g Hz); each row "
               "is one tick, so damping and motion differ from a run\n",
               file.c_str(), apart, 1 / rate, rate);
}

int trace(const TraceArguments& options) {
  auto scene = loadSceneOrReport(options.scene, "", false);
  if (!scene) return kBadInput;
  const OutputKind kind = tableKind(TraceWriter::kFirstColumns);
  if (const std::string wrong = whyNotWritten(options.out, kind, filesRead(options, *scene)); !wrong.empty())
    return fail(kBadInput, wrong);
  auto rows = readProbePath(options.probe);
  if (!rows) return fail(kBadInput, rows.error());
  warnOfFarRows(options.probe, *rows);
  warnOfRowTimes(options.probe, *rows, scene->servo.rate);
  auto models = chosenModels(*scene, options.models);
  if (!models) return fail(kBadInput, models.error());
  const GuardedCommand guarded;
  const TickWatch watched;
  const SetupErrors once;
  const servo::SetupWatch waiting(logToTerminal);
  auto world = servo::World::build(*scene, {.rate = scene->servo.rate, .keep_disabled = true}, logToTerminal);
  if (!world) return fail(kBadInput, world.error());
  auto writer = TraceWriter::open(options.out, *scene, *models);
  if (!writer) return fail(kBadInput, writer.error());
  if (auto done = traceRows(*scene, **world, *rows, **writer); !done) return fail(kFailed, done.error());
  int code = kWorked;
  for (const servo::ModelState& model : (*world)->core().models())
    if (const std::string why = servo::silenceReason(model); !why.empty()) code = fail(kFailed, why);
  return code;
}

}  // namespace

void addTrace(const Command& app, int& exit_code) {
  auto options = std::make_shared<TraceArguments>();
  const Command command =
      app.addSubcommand("trace", "Run the servo core over a prescribed probe path, in virtual time.");
  command.addOption("scene", options->scene, "scene file (YAML)").required();
  command
      .addOption("--probe", options->probe,
                 "probe path (CSV) with t,x,y,z[,qw,qx,qy,qz] in s and m, world frame; one row per tick; the line with "
                 "these names may be left out")
      .required();
  command.addOption("--out", options->out, "CSV file to write, one row per tick and model; - for standard output")
      .required();
  command.addOption("--models", options->models, "names of the only models to write, separated by commas");
  command.footer(
      "The column status is 0 (nearest) if the foot is the nearest point, 1 (degraded) if the answer is coarser than "
      "asked\nor not proved to be the nearest, 2 (held) if a contact is held and another point is nearer, -2 if the "
      "model was\nsilenced, and -6 if the surface or the sample was lost (no force).\nForces are those of the models "
      "without limits: limits belong to a "
      "device, and a trace has none.\nThe columns of the foot point are nan while nothing of the model is "
      "traced.\n\nExample:\n  hapticd trace config/scenes/teapot.yaml --probe stroke.csv --out feet.csv");
  setGuardedCallback(command, exit_code, [options] { return trace(*options); });
}

}  // namespace hapticd::cli
