// SPDX-License-Identifier: MIT
#include "diagnostics/scene/explain_cost.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "base/clock.hpp"
#include "base/offline_tick.hpp"
#include "diagnostics/reading/key_place.hpp"
#include "hapticd/abi.h"
#include "host/library.hpp"
#include "servo/arm/velocity_use.hpp"
#include "servo/loop/lockstep.hpp"
#include "servo/velocity/probe_velocity.hpp"
#include "tune/motion.hpp"
#include "world/world.hpp"

namespace hapticd::diagnostics {
namespace {

/// Drops messages: every set-up here returns its error as well, and the same models are set up many times.
void quiet(int, const std::string&, const std::string&) {}

std::string where(const document::Place& place, const std::string& key) {
  return place.line > 0 ? fmt::format("{}:{} {}", place.file, place.line, key) : place.file + " " + key;
}

/// Returns where the scene gives a key of its own, or only its file if it does not.
std::string where(const scene::Scene& scene, const std::string& key) {
  return where(placeOfKey(scene.file, key).value_or(document::Place{scene.file.string(), 0, 0}), key);
}

/// Returns the mean of the times without the longest hundredth of them: those contain interruptions, which are not a
/// cost of the part.
double meanOf(std::vector<double>& times) {
  if (times.empty()) return 0;
  std::sort(times.begin(), times.end());
  const size_t kept = std::max<size_t>(1, times.size() - times.size() / 100);
  double sum = 0;
  for (size_t i = 0; i < kept; ++i) sum += times[i];
  return sum / static_cast<double>(kept);
}

/// [ns] Returns how much reading the clock adds to a measured step.
double clockOverhead() {
  std::vector<double> times;
  for (int i = 0; i < 1000; ++i) {
    const Nanoseconds begun = monotonicNow();
    times.push_back(static_cast<double>(monotonicNow() - begun));
  }
  std::nth_element(times.begin(), times.begin() + 500, times.end());
  return times[500];
}

struct Measured {
  std::vector<double> step_ns;  ///< mean time of a step of each model
  double tick_ns = 0, search_ns = 0;
  double restingNs() const {
    double sum = tick_ns;
    for (const double step : step_ns) sum -= step;
    return std::max(0.0, sum);
  }
};

/// Measures one pass over the motion.
Result<Measured> pass(const scene::Scene& scene, const tune::Motion& motion) {
  auto world = servo::World::build(scene, {.rate = 1 / motion.period, .measure = true}, quiet);
  if (!world) return Error{world.error()};
  servo::Core& core = (*world)->core();
  core.serve({false, false});  // as for arms of three joints without a passivity controller; other arms cost more
  servo::Lockstep lockstep = (*world)->lockstep();
  const double overhead = clockOverhead();
  std::vector<std::vector<double>> steps(scene.models.size());
  std::vector<double> ticks, searches;
  servo::Probe probe;
  probe.valid = true;
  for (size_t i = 0; i < motion.position.size(); ++i) {
    const double t = static_cast<double>(i) * motion.period;
    probe.position = motion.position[i];
    probe.velocity = motion.velocity[i];
    const OfflineTick counted;
    core.publish(t, {&probe, 1});
    const Nanoseconds searched = monotonicNow();
    lockstep.before(t);
    const Nanoseconds begun = monotonicNow();
    core.tick(t, i == 0 ? 0 : motion.period, {&probe, 1});
    ticks.push_back(static_cast<double>(monotonicNow() - begun) -
                    overhead * static_cast<double>(1 + core.live().size()));
    searches.push_back(static_cast<double>(begun - searched));
    for (size_t k = 0; k < steps.size(); ++k)
      steps[k].push_back(std::max(0.0, static_cast<double>(core.models()[k].step_ns) - overhead));
  }
  Measured measured;
  for (auto& model : steps) measured.step_ns.push_back(meanOf(model));
  measured.tick_ns = meanOf(ticks);
  measured.search_ns = meanOf(searches);
  return measured;
}

/// Measures three times and keeps the shortest time of each part, because other programs can only make a part slower.
Result<Measured> measure(const scene::Scene& scene, const tune::Motion& motion) {
  auto best = pass(scene, motion);
  for (int i = 0; i < 2 && best; ++i) {
    const auto next = pass(scene, motion);
    if (!next) return Error{next.error()};
    for (size_t k = 0; k < best->step_ns.size(); ++k) best->step_ns[k] = std::min(best->step_ns[k], next->step_ns[k]);
    best->tick_ns = std::min(best->tick_ns, next->tick_ns);
    best->search_ns = std::min(best->search_ns, next->search_ns);
  }
  return best;
}

/// Returns what a shape asks for at activation.
std::optional<hsp_report> reportOf(const scene::Scene& scene, const scene::Model& model) {
  scene::Scene alone = scene;
  alone.models = {model};
  auto world = servo::World::build(alone, {.rate = scene.servo.rate}, quiet);
  if (!world) return std::nullopt;
  return (*world)->shapes()[0]->report();
}

scene::Model without(scene::Model model, const scene::Value& value) {
  std::erase_if(model.parameters, [&](const scene::Value& v) { return v.index == value.index; });
  return model;
}

/// Returns a parameter without which the shape would not ask for `flag`.
const scene::Value* reasonFor(const scene::Scene& scene, const scene::Model& model, uint32_t flag) {
  for (const scene::Value& value : model.parameters) {
    if (value.kind == HSP_PATH || value.kind == HSP_TEXT) continue;
    const auto report = reportOf(scene, without(model, value));
    if (report && (report->flags & flag) == 0) return &value;
  }
  return nullptr;
}

/// Returns the resident bytes of a library.
uint64_t residentOf(const std::filesystem::path& library) {
  // loaded again, because a module is unloaded when its device closes
  const auto loaded = host::Library::open(library);
  std::error_code error;
  const std::string file = std::filesystem::canonical(library, error).string();
  std::ifstream maps("/proc/self/smaps");
  uint64_t kilobytes = 0;
  bool inside = false;
  for (std::string line; std::getline(maps, line);) {
    if (line.find('-') != std::string::npos && line.find(':') > line.find(' '))
      inside = line.size() >= file.size() && line.compare(line.size() - file.size(), file.size(), file) == 0;
    else if (inside && line.rfind("Rss:", 0) == 0)
      kilobytes += std::stoull(line.substr(4));
  }
  return kilobytes * 1024;
}

class Costs {
 public:
  Costs(const scene::Scene& scene, const tune::Motion& motion) : scene_(scene), motion_(motion) {}

  Result<std::vector<CostRow>> run() {
    auto world = servo::World::build(scene_, {.rate = scene_.servo.rate}, quiet);
    if (!world) return Error{world.error()};
    auto measured = measure(scene_, motion_);
    if (!measured) return Error{measured.error()};
    measured_ = *measured;
    for (size_t i = 0; i < scene_.models.size(); ++i) addModel(i, *(*world)->shapes()[i]);
    addEstimator(**world);
    addSearch(**world);
    add("the host's own work in a tick", where(scene_, "servo"), "sums, guards and contact statistics",
        measured_.restingNs(), 0);
    addLibraries();
    return std::move(rows_);
  }

 private:
  void add(std::string part, std::string asked_by, std::string why, double ns, uint64_t bytes) {
    rows_.push_back({std::move(part), std::move(asked_by), std::move(why), std::max(0.0, ns), bytes});
  }

  void addModel(size_t index, const host::ShapeInstance& shape) {
    const scene::Model& model = scene_.models[index];
    const std::string key = fmt::format("models[{}]", index), name = "model " + model.name;
    add(name, where(model.place, key), model.plugin, measured_.step_ns[index], shape.report().locked_bytes);
    if ((shape.description().flags & HSP_C_DEFORMS) != 0)
      add(name + ": deformation", where(model.place, key + ".plugin"),
          "part of the step, so its time is in the row of the model itself; parts at rest cost nothing", 0, 0);
    else if (model.kinematic)
      addPath(index);
    else
      addAsked(index, shape, HSP_R_MOVES, ": integrator", "moves by itself", "it is static, so nothing is integrated");
    addAsked(index, shape, HSP_R_VELOCITY, ": velocity", "it has damping, viscosity or friction",
             "it does not read that of the tip");
    const bool moves = model.kinematic || (shape.report().flags & HSP_R_MOVES) != 0;
    const bool placed = moves || !model.pose.position.isZero(0) || !model.pose.orientation.vec().isZero(0);
    add(name + ": transform", placed ? where(model.place, key + (model.kinematic ? ".motion" : ".pose")) : "",
        placed ? "probe in, foot and normal out" : "it stands at the world's origin", placed ? transformCost() : 0, 0);
  }

  /// Adds the row for the motion of a kinematic model, which moves along its path or by a program.
  void addPath(size_t index) {
    const scene::Model& model = scene_.models[index];
    const std::string key = fmt::format("models[{}]", index), part = "model " + model.name + ": motion";
    if (model.path.empty())
      return add(part, where(model.place, key + ".motion"),
                 "kinematic: it is moved from outside, so nothing is integrated", 0, 0);
    scene::Scene still = scene_;
    still.models[index].kinematic = false;
    still.models[index].path.clear();
    const auto less = measure(still, motion_);
    add(part, where(model.place, key + ".path"),
        fmt::format("kinematic: it follows the {} points of its path", model.path.size()),
        less ? measured_.restingNs() - less->restingNs() : 0, model.path.size() * sizeof(scene::PathPoint));
  }

  /// Adds the row for what a parameter causes: the cost of the model with the parameter minus the cost without it.
  void addAsked(size_t index, const host::ShapeInstance& shape, uint32_t flag, const char* part, const char* why,
                const char* why_not) {
    const scene::Model& model = scene_.models[index];
    if ((shape.report().flags & flag) == 0) return add("model " + model.name + part, "", why_not, 0, 0);
    const scene::Value* value = reasonFor(scene_, model, flag);
    const std::string key = fmt::format("models[{}]", index);
    if (value == nullptr)
      return add("model " + model.name + part, where(model.place, key + ".plugin"),
                 std::string(why) + ": all shapes of this kind do", 0, 0);
    scene::Scene other = scene_;
    other.models[index] = without(model, *value);
    const auto less = measure(other, motion_);
    const auto report = reportOf(scene_, other.models[index]);
    add("model " + model.name + part, where(value->place, key + ".parameters." + value->id), why,
        less ? measured_.step_ns[index] - less->step_ns[index] : 0,
        report ? shape.report().locked_bytes - std::min(shape.report().locked_bytes, report->locked_bytes) : 0);
  }

  double transformCost() const {
    hsp_pose pose{};
    pose.orientation[0] = 0.8, pose.orientation[1] = 0.6, pose.position[0] = 0.1;
    const servo::Frame frame = servo::Frame::of(pose);
    Eigen::Vector3d p = Eigen::Vector3d::Ones();
    constexpr int kTimes = 100'000;
    const Nanoseconds begun = monotonicNow();
    for (int i = 0; i < kTimes; ++i) {
      p = frame.pointToModel(p);
      p = 0.5 * (frame.pointToWorld(p) + frame.vectorToWorld(p));
    }
    const double each = static_cast<double>(monotonicNow() - begun) / kTimes;
    return p.allFinite() ? each : 0;  // p is read, so that the compiler keeps the loop
  }

  void addEstimator(const servo::World& world) {
    std::set<std::string> keys;  // where something beside the models asks for it
    for (const scene::Device& device : scene_.devices)
      if (const std::string key(servo::keyThatUsesVelocity(device, scene_.clients)); key == "clients")
        keys.insert(where(scene_, key));
      else if (!key.empty())
        keys.insert(where(placeOfKey(device.file, key).value_or(device.place), key));
    if (!world.needsVelocity() && keys.empty())
      return add("velocity estimator", "", "no model and no limit needs a velocity", 0, 0);
    auto estimator = servo::makeEstimator(scene_.servo.velocity, scene_.servo.rate);
    if (!estimator) return;
    const Nanoseconds begun = monotonicNow();
    for (const Eigen::Vector3d& position : motion_.position) estimator->update(position, motion_.period);
    const double each = static_cast<double>(monotonicNow() - begun) / static_cast<double>(motion_.position.size());
    std::string asked_by;
    for (const CostRow& row : rows_)
      if (row.there() && row.part.find(": velocity") != std::string::npos)
        asked_by += (asked_by.empty() ? "" : ", ") + row.asked_by;
    for (const std::string& key : keys) asked_by += (asked_by.empty() ? "" : ", ") + key;
    add("velocity estimator", asked_by, scene_.servo.velocity.estimator, each, sizeof *estimator);
  }

  void addSearch(servo::World& world) {
    const char* by[] = {"", "in the main thread: one small surface needs no thread", "on its own thread"};
    const auto amount = world.proximity().amount();
    const std::string asked_by = amount == sim::Searching::kNone ? "" : where(scene_, "models") + " with surfaces";
    add("proximity search", asked_by,
        amount == sim::Searching::kNone
            ? "no model has surfaces to search"
            : std::string("every 5 ms, outside the tick, ") + by[static_cast<size_t>(amount)],
        measured_.search_ns, 0);
  }

  void addLibraries() {
    std::set<std::string> seen;
    for (size_t i = 0; i < scene_.models.size(); ++i)
      if (seen.insert(scene_.models[i].library.string()).second)
        add("library " + scene_.models[i].library.filename().string(),
            where(scene_.models[i].place, fmt::format("models[{}].plugin", i)), "plugin", 0,
            residentOf(scene_.models[i].library));
    for (const scene::Device& device : scene_.devices)
      if (seen.insert(device.library.string()).second)
        add("library " + device.library.filename().string(), where(device.place, "device"), "module of " + device.name,
            0, residentOf(device.library));
  }

  const scene::Scene& scene_;
  const tune::Motion& motion_;
  Measured measured_;
  std::vector<CostRow> rows_;
};

/// Returns the motion of the simulated hand; without one, a stroke along the front of the first model.
tune::Motion motionFor(const scene::Scene& scene) {
  if (auto motion = tune::motionOfHand(scene, 1, quiet)) return *motion;
  std::vector<Eigen::Vector3d> position;
  const Eigen::Vector3d start = scene.models.empty() ? Eigen::Vector3d::Zero() : scene.models[0].pose.position;
  for (int i = 0; i < 1000; ++i) position.push_back(start + Eigen::Vector3d(0.02 * std::sin(0.006 * i), 0, 0.05));
  return tune::motionThrough(std::move(position), 1 / scene.servo.rate);
}

}  // namespace

Result<std::vector<CostRow>> costOf(const scene::Scene& scene) {
  const tune::Motion motion = motionFor(scene);
  return Costs(scene, motion).run();
}

std::string costTable(const std::vector<CostRow>& rows) {
  std::string text = "what the scene needs, and what each part costs in a second of the hand's motion\n";
  text += fmt::format("  {:<34} {:>9} {:>10}  {}\n", "part", "ns per tick", "bytes", "asked for by");
  for (const CostRow& row : rows)
    if (row.there())
      text +=
          fmt::format("  {:<34} {:>9.0f} {:>10}  {} ({})\n", row.part, row.tick_ns, row.bytes, row.asked_by, row.why);
  text += "what is not needed\n";
  for (const CostRow& row : rows)
    if (!row.there()) text += fmt::format("  {:<34} {}\n", row.part, row.why);
  return text +
         "the times are means over ticks that follow each other at once; a run sleeps between its ticks, so its caches "
         "are colder and its steps take longer\n";
}

std::string costJson(const std::string& scene, const std::vector<CostRow>& rows) {
  auto parts = nlohmann::ordered_json::array();
  for (const CostRow& row : rows)
    parts.push_back({{"part", row.part},
                     {"there", row.there()},
                     {"asked_by", row.asked_by},
                     {"why", row.why},
                     {"tick_ns", row.tick_ns},
                     {"bytes", row.bytes}});
  return nlohmann::ordered_json{{"scene", scene}, {"parts", parts}}.dump(2) + "\n";
}

}  // namespace hapticd::diagnostics
