// SPDX-License-Identifier: MIT
/// `hapticd explain`: prints what a scene makes the daemon load, start and compute, why, and what it costs; or what
/// happened in a recording.
#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/offline_tick.hpp"
#include "base/os.hpp"
#include "base/shell_word.hpp"
#include "cli/recording/explain_recording.hpp"
#include "cli/support/command.hpp"
#include "cli/support/guarded_command.hpp"
#include "cli/support/tick_watch.hpp"
#include "diagnostics/device/slow_arm.hpp"
#include "diagnostics/scene/explain_cost.hpp"
#include "document/reader.hpp"
#include "servo/arm/velocity_use.hpp"
#include "servo/loop/lockstep.hpp"
#include "session/messages/setup_watch.hpp"
#include "world/world.hpp"

namespace hapticd::cli {

using namespace diagnostics;

namespace {

/// Prints one line with a fact and its reason.
void printLine(const char* what, const std::string& why) {
  std::printf("  %-22s %s\n", what, why.c_str());
}

std::string where(const document::Place& place) {
  return place.line > 0 ? place.file + ":" + std::to_string(place.line) : place.file;
}

std::string bytes(uint64_t count) {
  char text[32];
  if (count < 10240) {
    std::snprintf(text, sizeof text, "%llu B", static_cast<unsigned long long>(count));
  } else {
    std::snprintf(text, sizeof text, "%.1f kB", static_cast<double>(count) / 1024);
  }
  return text;
}

/// Returns the median CPU time of one step of each model [ns], with the probe resting near the surface of the model.
std::vector<uint64_t> measureSteps(servo::World& world, const scene::Scene& scene) {
  constexpr int kTicks = 300;
  const double dt = 1 / scene.servo.rate;
  std::vector<uint64_t> medians;
  for (uint32_t index = 0; index < scene.models.size(); ++index) {
    const host::ShapeInstance& shape = *world.shapes()[index];
    servo::Probe probe;
    probe.valid = true;
    Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = low;
    if (!shape.bounds(low.data(), high.data())) low.setZero(), high.setZero();
    // A place just outside the front of the box, which a hand meets first.
    const Eigen::Vector3d front(0.5 * (low.x() + high.x()), 0.5 * (low.y() + high.y()), high.z() + 1e-3);
    probe.position = scene.models[index].pose.orientation * front + scene.models[index].pose.position;
    servo::Lockstep lockstep = world.lockstep();
    std::vector<uint64_t> costs;
    for (int i = 0; i < kTicks; ++i) {
      const OfflineTick counted;
      world.core().publish(i * dt, {&probe, 1});
      lockstep.before(i * dt);
      world.core().tick(i * dt, i == 0 ? 0 : dt, {&probe, 1});
      costs.push_back(world.core().models()[index].step_ns);
    }
    std::nth_element(costs.begin(), costs.begin() + kTicks / 2, costs.end());
    medians.push_back(costs[kTicks / 2]);
  }
  return medians;
}

/// The debug messages of the models. The key is the name of the model.
using Details = std::multimap<std::string, std::string>;

std::string surfacesOf(const host::ShapeInstance& shape, double activation_radius) {
  if (shape.surfaces() == nullptr) return "is traced by its plugin in every tick";
  const uint32_t count = shape.surfaces()->surface_count;
  return std::to_string(count) + (count == 1 ? " surface" : " surfaces") +
         ", traced while within the activation radius, " + document::numberText(activation_radius) + " m";
}

std::string motionOf(const scene::Model& model, const host::ShapeInstance& shape) {
  if ((shape.report().flags & HSP_R_MOVES) != 0) return "moved by its plugin: integrated in every tick";
  if (!model.kinematic) return "none: no integrator, its pose is fixed";
  if (model.path.empty()) return "rests until a program moves it";
  return "follows " + std::to_string(model.path.size()) + " points of a path";
}

void explainModels(const scene::Scene& scene, servo::World& world, const std::vector<uint64_t>& costs,
                   const Details& details) {
  std::printf("models\n");
  for (size_t i = 0; i < scene.models.size(); ++i) {
    const scene::Model& model = scene.models[i];
    const host::ShapeInstance& shape = *world.shapes()[i];
    const hsp_report& report = shape.report();
    std::printf("  %s  (%s, %s)\n", model.name.c_str(), model.plugin.c_str(), where(model.place).c_str());
    if (!model.enabled)
      printLine("  starts", "disabled: neither felt nor traced until it is enabled (hapticd ctl enable " +
                                shellWord(model.name) + "); what follows is its cost then");
    printLine("  surfaces", surfacesOf(shape, scene.servo.activation_radius));
    printLine("  motion", motionOf(model, shape));
    if ((shape.description().flags & HSP_C_DEFORMS) != 0)
      printLine("  deformation", "not computed until it is touched; then only moving control points are integrated");
    const bool identity = model.pose.position.isZero(0) && model.pose.orientation.vec().isZero(0);
    const bool still = (report.flags & HSP_R_MOVES) == 0 && !model.kinematic;
    printLine("  transform",
              identity && still
                  ? "none: the model stands at the world's origin"
                  : "in every tick in which it is traced: the probe into its frame, foot point and normal back");
    printLine("  velocity",
              (report.flags & HSP_R_VELOCITY) != 0 ? "used (damping, viscosity or friction)" : "not used");
    printLine("  memory", bytes(report.locked_bytes));
    printLine("  cost", std::to_string(costs[i]) +
                            " ns (median) of a step while the probe rests 1 mm in front of the model's box; "
                            "a hand on its path may take far less or more: see --cost");
    const auto [begin, end] = details.equal_range(model.name);
    for (auto detail = begin; detail != end; ++detail) printLine(detail == begin ? "  details" : "", detail->second);
  }
}

/// Says which estimator runs, and names everything that uses its velocity.
std::string estimatorText(const scene::Scene& scene, const servo::World& world) {
  std::set<std::string> users;
  if (world.needsVelocity()) users.insert("a model uses velocity");
  for (const scene::Device& device : scene.devices)
    if (const auto key = servo::keyThatUsesVelocity(device, scene.clients); key == "clients")
      users.insert("programs may push (clients)");
    else if (!key.empty())
      users.insert(std::string(key) + " of " + device.name);
  std::string text;
  for (const std::string& user : users) text += (text.empty() ? "" : ", ") + user;
  if (text.empty()) return "none: nothing in the scene uses velocity";
  const scene::Velocity& velocity = scene.servo.velocity;
  return velocity.estimator + " (" + document::numberText(velocity.parameter) + "): " + text;
}

void explainServo(const scene::Scene& scene, const servo::World& world) {
  std::printf("servo\n");
  printLine("rate", std::to_string(static_cast<int>(scene.servo.rate)) + " Hz");
  constexpr double kShare = 0.8;
  char deadline[160];
  std::snprintf(
      deadline, sizeof deadline,
      "%.4g us for all models; beyond it the least important models are traced less accurately, never left out",
      scene.servo.budget_us > 0 ? scene.servo.budget_us : kShare * 1e6 / scene.servo.rate);
  printLine("budget of a tick", deadline);
  printLine("velocity estimator", estimatorText(scene, world));
}

void explainSimulation(servo::World& world) {
  std::printf("simulation side\n");
  const size_t count = world.proximity().modelCount();
  const std::string every = "every 5 ms over " + std::to_string(count) + (count == 1 ? " model, " : " models, ");
  const sim::Searching amount = world.proximity().amount();
  printLine("proximity search", amount == sim::Searching::kNone ? "none: no model has surfaces to search"
                                : amount == sim::Searching::kSmall
                                    ? every + "by the main thread: one small surface needs no thread"
                                    : every + "on its own thread");
}

void explainFiles(const scene::Scene& scene) {
  std::set<std::string> libraries;
  for (const scene::Model& model : scene.models) libraries.insert(model.library.string());
  for (const scene::Device& device : scene.devices) libraries.insert(device.library.string());
  std::printf("libraries\n");
  for (const std::string& library : libraries) std::printf("  %s\n", library.c_str());
  std::printf("devices\n");
  for (const scene::Device& device : scene.devices) {
    const std::string reason = device.chosen_by_default ? "the scene names none" : where(device.place);
    std::printf("  %s  (%s, %s)\n", device.name.c_str(), device.module.c_str(), reason.c_str());
    if (const std::string slow = slownessOf(device, scene.servo.rate); !slow.empty()) printLine("  less force", slow);
  }
}

struct ExplainArguments {
  std::string scene, device;
  std::optional<double> at;
  bool cost = false, json = false;
};

int explainCost(const ExplainArguments& options, const scene::Scene& scene) {
  const auto rows = costOf(scene);
  if (!rows) return fail(kBadInput, rows.error());
  std::fputs((options.json ? costJson(options.scene, *rows) : costTable(*rows)).c_str(), stdout);
  return kWorked;
}

int explain(const ExplainArguments& options) {
  if (isRecording(options.scene)) {
    if (options.cost || options.json || !options.device.empty())
      return fail(kBadInput, options.scene +
                                 ": is a recording, which is explained in words alone, so --cost, --json and "
                                 "--device do not apply; for numbers, run: hapticd export " +
                                 shellWord(options.scene) + " --csv FOLDER");
    return explainRecording(options.scene, options.at);
  }
  if (options.at) return fail(kBadInput, options.scene + ": is no recording, and --at is a time of a recording");
  auto scene = loadSceneOrReport(options.scene, options.device);
  if (!scene) return kBadInput;
  const GuardedCommand guarded;
  const TickWatch watched;
  const servo::SetupWatch waiting(logToTerminal);
  if (options.cost || options.json) return explainCost(options, *scene);
  const SetupErrors once;
  Details details;
  const auto listen = [&details](int level, const std::string& who, const std::string& text) {
    if (level == HSP_LOG_DEBUG) details.emplace(who, text);
    logToTerminal(level, who, text);
  };
  auto world = servo::World::build(*scene, {.rate = scene->servo.rate, .measure = true}, listen);
  if (!world) return fail(kBadInput, world.error());
  const std::vector<uint64_t> costs = measureSteps(**world, *scene);
  explainServo(*scene, **world);
  explainSimulation(**world);
  explainModels(*scene, **world, costs, details);
  explainFiles(*scene);
  std::printf("memory\n");
  printLine("models", bytes((*world)->lockedBytes()));
  printLine("process now", bytes(os::residentBytes()));
  return kWorked;
}

}  // namespace

void addExplain(const Command& app, int& exit_code) {
  auto options = std::make_shared<ExplainArguments>();
  const Command command = app.addSubcommand(
      "explain", "Show what the daemon loads, starts and computes for a scene, why, and at what cost.");
  command.addOption("scene", options->scene, "scene file (YAML); or a recording, whose events are printed in words")
      .required();
  command.addOption("--device", options->device, "device file; replaces the devices of the scene");
  command.addFlag("--cost", options->cost,
                  "print a table of every part: the line of the scene that asks for it, its time per tick [ns] and its "
                  "memory [bytes]; parts that are not needed are listed too");
  command.addFlag("--json", options->json, "print the same table as JSON");
  command.addOption("--at", options->at,
                    "of a recording: why the force of this time [s] is what it is: models, faces, programs, limits");
  command.footer(
      "Examples:\n  hapticd explain config/scenes/teapot.yaml --cost\n  hapticd explain run.h5            # what "
      "happened in a run that was recorded\n  hapticd explain run.h5 --at 2.5   # why the force was what it was then");
  setGuardedCallback(command, exit_code, [options] { return explain(*options); });
}

}  // namespace hapticd::cli
