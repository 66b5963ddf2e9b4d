// SPDX-License-Identifier: MIT
#include "session.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "hapticd/device.h"
#include "scene/load.hpp"
#include "servo/arm/arm.hpp"
#include "servo/loop/lockstep.hpp"
#include "traced_shape/model_file.hpp"
#include "world/world.hpp"

namespace hapticd::table1 {
namespace {

using Eigen::Vector3d;
namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) {
  std::ofstream out(file);
  if (!(out << text) || !out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

/// Writes a model file, scaled, as JSON.
void writeScaled(const std::string& from, double scale, const fs::path& to) {
  const ModelFile model = readModelFile(from);
  std::string text = "{\"format\": \"hapticd-model/1\", \"surfaces\": [";
  for (size_t i = 0; i < model.surfaces.size(); ++i) {
    const spline::SurfaceData& s = model.surfaces[i];
    text +=
        fmt::format("{}{{\"name\": \"{}\", \"degree\": [{}, {}], \"knots\": [[{}], [{}]], \"points\": [", i ? ", " : "",
                    s.name, s.degree[0], s.degree[1], fmt::join(s.knots[0], ", "), fmt::join(s.knots[1], ", "));
    for (size_t k = 0; k < s.points.size(); ++k) {
      const Vector3d p = scale * s.points[k];
      text += fmt::format("{}[{}, {}, {}]", k ? ", " : "", p.x(), p.y(), p.z());
    }
    text += "]";
    if (!s.weights.empty()) text += fmt::format(", \"weights\": [{}]", fmt::join(s.weights, ", "));
    text += s.reversed ? ", \"outward\": \"reversed\"}" : "}";
  }
  write(to, text + "]}\n");
}

scene::Scene makeScene(const Subject& subject, bool moving, const Protocol& protocol, const Vector3d& start,
                       const fs::path& work) {
  fs::create_directories(work);
  writeScaled(HAPTICD_SOURCE_DIR "/config/models/" + subject.geometry, subject.scale, work / "model.json");
  const Plugin still{"nurbs_rigid", "static", kWall};
  const Plugin& plugin = moving ? subject.moving : still;
  write(work / "scene.yaml",
        fmt::format("hapticd: 1\nservo: {{rate: {}, velocity: {{estimator: window, parameter: {}}}}}\n"
                    "device: {}/config/devices/simulated-sarcos.yaml\n"
                    "hand: {{script: guided, mass: 1, stiffness: {}, damping: 10, center: [{}, {}, {}], radius: 0, "
                    "approach: 0, tremor: 0, wander: 0}}\n"
                    "models:\n  - name: {}\n    plugin: {}\n{}    pose: {{position: [0, {}, 0]}}\n"
                    "    parameters: {{geometry: model.json, {}}}\n",
                    protocol.rate, protocol.window, HAPTICD_SOURCE_DIR, protocol.stiffness, start.x(), start.y(),
                    start.z(), subject.name, plugin.name,
                    plugin.motion.empty() ? "" : "    motion: " + plugin.motion + "\n", subject.position_y,
                    plugin.parameters));
  host::Catalog catalog;
  scene::Loaded loaded = scene::load(work / "scene.yaml", catalog);
  std::string problems;
  for (const document::Problem& problem : loaded.problems) problems += problem.text() + "\n";
  if (!loaded.scene) throw std::runtime_error(problems);
  return *loaded.scene;
}

template <class T>
T must(Result<T> result) {
  if (!result) throw std::runtime_error(result.error());
  return std::move(*result);
}

/// World, arm and hand of a scene. Its owner calls tick() for each tick.
class Rig {
 public:
  explicit Rig(const scene::Scene& scene) : rate_(scene.servo.rate) {
    const auto log = [](int level, const std::string& who, const std::string& text) {
      if (level >= HSP_LOG_WARNING) fmt::print(stderr, "{}: {}\n", who, text);
    };
    world_ = must(servo::World::build(scene, {rate_, 1, false, false}, log));
    arm_ = must(servo::Arm::open(scene.devices[0], scene.servo, {rate_, world_->needsVelocity()}, log));
    handle_ = arm_->device().handle();
    hand_ = static_cast<const hdv_ext_hand*>(arm_->device().description().extension(handle_, HDV_EXT_HAND));
    if (hand_ == nullptr) throw std::runtime_error("the arm has no hand to guide");
    lockstep_.emplace(world_->lockstep());
    if (auto started = arm_->start(0, scene.servo.gravity); !started) throw std::runtime_error(started.error());
    arm_->carryWeight(true);
  }

  /// Makes one tick, in which the hand is pulled to `wish`.
  Sample tick(const Wish& wish) {
    const double dt = count_ == 0 ? 0 : 1 / rate_, t = static_cast<double>(count_) / rate_;
    const auto now = static_cast<Nanoseconds>(std::llround(t * 1e9));
    const Vector3d none = Vector3d::Zero();
    hand_->guide(handle_, wish.position.data(), wish.velocity.data(), none.data());
    const servo::Probe& probe = arm_->read(now, dt);
    servo::Core& core = world_->core();
    core.publish(t, {&probe, 1});
    lockstep_->before(t);
    core.tick(t, dt, {&probe, 1});
    arm_->write(now, dt, core.force(0), core.torque(0), core.exchange(0));
    ++count_;
    return sampleOf(t, core.contact(0, 0));
  }

  const hsp_pose& pose() const { return world_->core().models()[0].pose; }
  const Vector3d& tip() const { return arm_->probe().position; }
  double time() const { return static_cast<double>(count_) / rate_; }
  servo::Fault fault() const { return arm_->limiter().fault(); }

 private:
  Sample sampleOf(double t, const servo::Contact& contact) const {
    Sample sample;
    sample.t = t;
    sample.depth = contact.traced ? contact.world.depth_m : -1;
    sample.contact = contact.traced && sample.depth > 0;
    sample.force = arm_->force().norm();
    if (const auto felt = arm_->handForce()) sample.felt = -felt->dot(Eigen::Map<const Vector3d>(contact.world.normal));
    return sample;
  }

  double rate_;
  std::unique_ptr<servo::World> world_;
  std::unique_ptr<servo::Arm> arm_;
  std::optional<servo::Lockstep> lockstep_;
  hdv_device* handle_ = nullptr;
  const hdv_ext_hand* hand_ = nullptr;
  uint64_t count_ = 0;
};

hsp_pose startPose(const Subject& subject) {
  hsp_pose pose{};
  pose.position[1] = subject.position_y;
  pose.orientation[0] = 1;
  return pose;
}

}  // namespace

Recording run(const Subject& subject, bool moving, const Protocol& protocol, const std::string& work) {
  Operator first(protocol, subject.route), person(protocol, subject.route);
  const scene::Scene scene = makeScene(subject, moving, protocol, first.wish(0, 0, startPose(subject)).position, work);
  Rig rig(scene);
  Recording recording;
  const double dt = 1 / protocol.rate;
  while (rig.time() < protocol.seconds) {
    const Sample sample = rig.tick(person.wish(rig.time(), dt, rig.pose()));
    recording.depth.add(sample.contact, sample.depth, sample.force, dt, 0);
    recording.samples.push_back(sample);
  }
  if (rig.fault() != servo::Fault::kNone) recording.fault = servo::describe(rig.fault());
  return recording;
}

Recording press(const Subject& button, const Protocol& protocol, const std::string& work) {
  // the target is 75 mm deep, because the hand's spring is soft (about 20 N); at first the arm sinks, until its weight
  // is carried, and comes to rest
  constexpr double kSettle = 4, kSeconds = 24, kDepth = 0.075, kOutside = 0.005;
  const Aim middle = [&] {
    Aim aim = button.route(0);
    aim.point.x() = aim.point.z() = 0;
    return aim;
  }();
  const Vector3d rest = Vector3d(0, button.position_y, 0) + middle.point;
  const scene::Scene scene = makeScene(button, true, protocol, rest + kOutside * middle.normal, work);
  Rig rig(scene);
  Recording recording;
  while (rig.time() < kSettle + kSeconds) {
    const bool settled = rig.time() >= kSettle;
    const double phase = settled ? 2 * M_PI * (rig.time() - kSettle) / kSeconds : 0, in = 0.5 * (1 - std::cos(phase));
    Wish wish;
    wish.position = rest + (kOutside - (kDepth + kOutside) * in) * middle.normal;
    wish.velocity = -(kDepth + kOutside) * 0.5 * std::sin(phase) * 2 * M_PI / kSeconds * middle.normal;
    Sample sample = rig.tick(wish);
    sample.travel = (rest - rig.tip()).dot(middle.normal);
    if (settled) recording.samples.push_back(sample);
  }
  return recording;
}

}  // namespace hapticd::table1
