// SPDX-License-Identifier: MIT
#include "diagnostics/scene/setting_plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "diagnostics/reading/key_place.hpp"
#include "diagnostics/scene/value_plausibility.hpp"
#include "link/link.hpp"
#include "tune/stability.hpp"

namespace hapticd::diagnostics {
namespace {

using Eigen::Vector3d;

/// Returns the place of a key in the scene, or the beginning of the scene if it is not there.
document::Place placeIn(const scene::Scene& scene, const std::string& key) {
  return placeOfKey(scene.file, key).value_or(document::Place{scene.file.string(), 1, 1});
}

void checkGravity(const scene::Scene& scene, document::Problems& warnings) {
  // [m/s^2]; factor of the Earth's; cosine of the angle to straight down
  constexpr double kEarth = 9.81, kStrong = 3, kLow = 0.5;
  const Vector3d& g = scene.servo.gravity;
  const auto tell = [&](const std::string& what) {
    document::report(warnings, placeIn(scene, "servo.gravity"), "servo.gravity",
                     fmt::format("[{:g}, {:g}, {:g}] {}; expected [0, -9.81, 0] m/s^2, or [0, 0, 0] for none", g.x(),
                                 g.y(), g.z(), what));
  };
  if (g.norm() > kStrong * kEarth) tell(fmt::format("is {:.3g} times the Earth's gravity", g.norm() / kEarth));
  if (g.y() > kLow * g.norm()) return tell("points up, as +y is up in the world: bodies fall upwards");
  if (g.norm() > 0 && -g.y() < kLow * g.norm()) tell("pulls aside, as +y is up in the world");
}

void checkServo(const scene::Scene& scene, document::Problems& warnings) {
  constexpr double kWidest = 2, kLeast = 2;  // [m] beyond the reach of arms; [us] of a tick, less than any shape needs
  constexpr double kFastHand = 2, kSearch = 1e-9 * link::kSearchPeriod;  // [m/s]; [s] between two searches
  const scene::Servo& servo = scene.servo;
  if (servo.activation_radius < kFastHand * kSearch)
    document::report(
        warnings, placeIn(scene, "servo.activation_radius"), "servo.activation_radius",
        fmt::format("a surface is felt once a search, every {:g} ms, has found it nearer than {:g} m, so a hand faster "
                    "than {:g} m/s can pass through it unfelt; expected {:g} m or more, or leave this out (0.1 m)",
                    kSearch * 1e3, servo.activation_radius, servo.activation_radius / kSearch, kFastHand * kSearch));
  if (servo.activation_radius > kWidest)
    document::report(
        warnings, placeIn(scene, "servo.activation_radius"), "servo.activation_radius",
        fmt::format(
            "{0:g} m is so large that every surface is always traced; the value must be in m: {0:g} mm is {1:g} m",
            servo.activation_radius, servo.activation_radius / 1000));
  if (servo.budget_us > 0 && servo.budget_us < kLeast)
    document::report(warnings, placeIn(scene, "servo.budget_us"), "servo.budget_us",
                     fmt::format("{0:g} us is too short for any shape; the value must be in us: {0:g} ms is {1:g} us",
                                 servo.budget_us, servo.budget_us * 1000));
}

/// Warns of a wait for programs that is longer than the servo waits.
void checkAnswerTime(const scene::Scene& scene, document::Problems& warnings) {
  constexpr double kShare = 0.25, kRounding = 1e-9;  // share of the period, as in a run
  const double period = 1 / scene.servo.rate, most = kShare * period;
  if (scene.clients.answer_time > (1 + kRounding) * most)
    document::report(
        warnings, placeIn(scene, "clients.answer_time"), "clients.answer_time",
        fmt::format("the wait is {:g} s, but at {:g} Hz the servo waits at most a quarter of its period of {:g} s; "
                    "expected at most {:g} s",
                    scene.clients.answer_time, scene.servo.rate, period, most));
}

/// Warns of settings of programs that push, where no program may.
void checkIdleClients(const scene::Scene& scene, document::Problems& warnings) {
  const bool off = scene.clients.mode == scene::ClientMode::kOff;
  if (!off && scene.clients.push) return;
  for (const char* id : {"max_force", "exclusive", "answer_time", "push"}) {
    const std::string key = std::string("clients.") + id;
    const auto place = placeOfKey(scene.file, key);
    if (!place || (!off && id == std::string_view("push"))) continue;
    document::report(warnings, *place, key,
                     fmt::format("has no effect, because no program may push ({}); remove this key, or set {}",
                                 off ? "mode: off" : "push: false", off ? "mode: add" : "push: true"));
  }
}

/// Warns of an origin of HDAPI programs that is far away from all arms.
void checkOrigin(const scene::Scene& scene, document::Problems& warnings) {
  constexpr double kFar = 2;  // [m] beyond the reach of arms
  const Vector3d& origin = scene.clients.origin;
  double away = origin.norm();
  if (scene.clients.frame == scene::ClientFrame::kWorld)
    for (const scene::Device& device : scene.devices) away = std::min(away, (origin - device.mount.position).norm());
  const double most = origin.cwiseAbs().maxCoeff();
  if (away > kFar)
    document::report(warnings, placeIn(scene, "clients.origin"), "clients.origin",
                     fmt::format("is {:.4g} m away from the arms; the value must be in m: {:g} mm is {:g} m", away,
                                 most, most / 1000));
}

/// Returns the settings of a simulated hand as text. Two arms in the same place are allowed if their hands differ.
std::string handOf(const scene::Device& device) {
  std::string text;
  for (const scene::Value& value : device.parameters) {
    if (value.id.rfind("hand.", 0) != 0) continue;
    text += value.id + fmt::format(" {} {}", value.number, value.text);
    for (const double x : value.numbers) text += fmt::format(" {}", x);
  }
  return text;
}

bool inOnePlace(const scene::Device& a, const scene::Device& b) {
  constexpr double kNear = 1e-3;  // [m], [rad]
  return a.file == b.file && handOf(a) == handOf(b) && (a.mount.position - b.mount.position).norm() < kNear &&
         a.mount.orientation.angularDistance(b.mount.orientation) < kNear;
}

void checkTwoArms(const scene::Scene& scene, document::Problems& warnings) {
  for (size_t i = 1; i < scene.devices.size(); ++i)
    for (size_t first = 0; first < i; ++first) {
      if (!inOnePlace(scene.devices[first], scene.devices[i])) continue;
      const std::string key = fmt::format("devices[{}]", i);
      const auto mount = placeOfKey(scene.file, key + ".mount");
      document::report(
          warnings, mount ? *mount : placeIn(scene, key), key + ".mount",
          fmt::format("{} is in the same place as {}; expected a mount of its own: {{position: [x, y, z]}} in m",
                      scene.devices[i].name, scene.devices[first].name));
      break;
    }
}

/// Warns of an arm whose base is inside a model. The base of a chain is the place about which its first link turns.
void checkBases(const scene::Scene& scene, const ModelBoxes& boxes, document::Problems& warnings) {
  constexpr double kOpen = 0.6;  // share of a box's half widths, because a model may leave the corners of its box free
  for (const scene::Device& device : scene.devices) {
    const document::Place place = device.place.file.empty() ? document::Place{device.file.string()} : device.place;
    const scene::Value *links = nullptr, *base = nullptr;
    for (const scene::Value& value : device.parameters) {
      if (value.id == "arm.dh" && !value.numbers.empty()) links = &value;
      if ((value.id == "arm.base_position" || value.id == "arm.origin") && value.numbers.size() == 3) base = &value;
    }
    if (links == nullptr) continue;
    Eigen::Vector3d at = device.mount.position;
    if (base != nullptr) at += device.mount.orientation * Eigen::Map<const Eigen::Vector3d>(base->numbers.data());
    for (size_t i = 0; i < boxes.size() && i < scene.models.size(); ++i) {
      const scene::Pose& pose = scene.models[i].pose;
      if (!boxes[i] || boxes[i]->isEmpty() || scene.models[i].kinematic) continue;
      const Eigen::Vector3d in = pose.orientation.conjugate() * (at - pose.position) - boxes[i]->center();
      if ((in.array().abs() > kOpen * 0.5 * boxes[i]->sizes().array()).any()) continue;
      const auto mount = placeOfKey(device.file, "mount");
      document::report(
          warnings, mount ? *mount : place, "mount",
          fmt::format("{} stands with its base in the middle of {}{}; expected mount: {{position: [x, y, z]}} in "
                      "m, which puts its tip in front of the models: hapticd device twin proposes one",
                      device.name, scene.models[i].name, mount ? "" : ", as it has no mount"));
      break;
    }
  }
}

}  // namespace

document::Problems implausibleSettings(const scene::Scene& scene, const ModelBoxes& boxes) {
  document::Problems warnings;
  checkGravity(scene, warnings);
  checkServo(scene, warnings);
  checkIdleClients(scene, warnings);
  checkAnswerTime(scene, warnings);
  checkOrigin(scene, warnings);
  checkTwoArms(scene, warnings);
  checkBases(scene, boxes, warnings);
  return warnings;
}

document::Problems stiffTogether(const scene::Scene& scene, const scene::Device& device, const hdv_info& info,
                                 const std::vector<double>& stiffness) {
  document::Problems warnings;
  for (const std::vector<size_t>& group : modelsInOnePlace(scene)) {
    scene::Scene together = scene;
    together.models = {scene.models[group[0]]};
    scene::Model& model = together.models[0];
    std::vector<double> sum(1);
    for (const size_t i : group) sum[0] += i < stiffness.size() ? stiffness[i] : 0;
    model.name += fmt::format(" with {} in its place", group.size() == 2 ? scene.models[group[1]].name
                                                                         : fmt::format("{} models", group.size() - 1));
    for (document::Problem& one : tune::unstableSettings(together, device, info, sum)) {
      if (one.key.rfind("models[0]", 0) != 0 || one.key.ends_with(".damping")) continue;  // reported elsewhere
      one.key.replace(0, 9, fmt::format("models[{}]", group[0]));
      warnings.push_back(std::move(one));
    }
  }
  return warnings;
}

document::Problems lightAdmittance(const scene::Scene& scene, const scene::Device& device, const hdv_info& info) {
  constexpr double kLightest = 0.1;  // share of the felt mass: an arm cannot seem much lighter than it is
  document::Problems warnings;
  if (!device.admittance || info.mass_kg <= 0 || device.admittance->mass >= kLightest * info.mass_kg) return warnings;
  document::Place place = device.place.file.empty() ? document::Place{device.file.string()} : device.place;
  std::string key = "admittance.mass";
  const std::string in_scene = "device.admittance.mass";
  for (size_t i = 0; i <= scene.devices.size(); ++i) {
    const std::string there = i == 0 ? in_scene : fmt::format("devices[{}].admittance.mass", i - 1);
    if (i > 0 && &scene.devices[i - 1] != &device) continue;
    if (const auto found = placeOfKey(scene.file, there)) place = *found, key = there;
  }
  if (key == "admittance.mass")
    if (const auto found = placeOfKey(device.file, key)) place = *found;
  document::report(warnings, place, key,
                   fmt::format("{:g} kg is {:.3g} times less than the {:.3g} kg of {}, which cannot follow so light a "
                               "mass; the value must be in kg; expected {:.2g} kg or more",
                               device.admittance->mass, info.mass_kg / device.admittance->mass, info.mass_kg,
                               device.name, kLightest * info.mass_kg));
  return warnings;
}

}  // namespace hapticd::diagnostics
