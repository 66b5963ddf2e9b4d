// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnostics/model_advice.hpp"
#include "diagnostics/node_path.hpp"
#include "document/node.hpp"

namespace hapticd::diagnostics {
namespace {

constexpr double kFarMount = 5;  ///< [m] farther than anybody reaches

const scene::Value* valueOf(const scene::Device& device, const char* id) {
  for (const scene::Value& value : device.parameters)
    if (value.id == id) return &value;
  return nullptr;
}

/// What the file says of the servo, and where.
class ServoGiven {
 public:
  ServoGiven(const scene::Scene& scene, document::Problems& warnings)
      : file_(scene.file.string()), root_(document::parseFile(scene.file, unread_)), warnings_(warnings) {}
  bool has(std::initializer_list<const char*> keys) const { return root_ && find(*root_, keys) != nullptr; }
  void warn(std::initializer_list<const char*> keys, const std::string& what) const {
    const document::Node* node = root_ ? find(*root_, keys) : nullptr;
    if (node == nullptr) return;
    std::string key;
    for (const char* part : keys) key += (key.empty() ? "" : ".") + std::string(part);
    document::report(warnings_, file_, node->line, node->column, key, what);
  }

 private:
  document::Problems unread_;
  std::string file_;
  std::optional<document::Node> root_;
  document::Problems& warnings_;
};

void gravityOf(const scene::Servo& servo, const ServoGiven& given) {
  constexpr double kStrong = 30;  // [m/s^2] three times the Earth's
  const Eigen::Vector3d& g = servo.gravity;
  const std::string text = fmt::format("[{:g}, {:g}, {:g}] m/s^2 ", g.x(), g.y(), g.z());
  if (g.norm() > kStrong)
    given.warn({"servo", "gravity"},
               text + fmt::format("is {:.3g} times the Earth's; expected m/s^2: [0, -9.81, 0]", g.norm() / 9.81));
  else if (g.y() > 0.5 * g.norm())
    given.warn({"servo", "gravity"}, text + "points up (+y is up): weight would lift; expected [0, -9.81, 0]");
  else if (g.norm() > 1 && g.y() > -0.5 * g.norm())
    given.warn({"servo", "gravity"}, text + "pulls sideways: +y is up here; expected [0, -9.81, 0]");
}

void servoOf(const scene::Servo& servo, const ServoGiven& given) {
  constexpr double kWideSearch = 2, kSlowest = 10, kNoTime = 1;  // [m], [Hz], [us]
  gravityOf(servo, given);
  for (const auto& [key, value] :
       {std::pair("activation_radius", servo.activation_radius), std::pair("hysteresis", servo.hysteresis)})
    if (value > kWideSearch)
      given.warn({"servo", key}, fmt::format("{:g} m reaches beyond every arm; expected metres: {:g} mm are {:g} m",
                                             value, value, value / 1000));
  if (servo.velocity.estimator == "butterworth" && servo.velocity.parameter < kSlowest)
    given.warn(
        {"servo", "velocity", "parameter"},
        fmt::format("a cut-off of {:g} Hz lags {:.3g} ms behind the hand, so that damping pushes late; expected 20 "
                    "to 200 Hz (of window alone it is a number of samples)",
                    servo.velocity.parameter, 1e3 * std::sqrt(2.0) / (2 * M_PI * servo.velocity.parameter)));
  if (servo.budget_us > 0 && servo.budget_us < kNoTime)
    given.warn({"servo", "budget_us"},
               fmt::format("{:g} us: no shape answers within that; expected microseconds", servo.budget_us));
}

/// What holds the arm, and the force that is let through.
void holdOf(const scene::Device& device, document::Problems& warnings) {
  constexpr double kLoose = 5, kHeavy = 10, kUnfeltForce = 0.05;  // [N/m], [kg], [N]
  const scene::Value *stiffness = valueOf(device, "hand.stiffness"), *mass = valueOf(device, "hand.mass");
  if (stiffness != nullptr && stiffness->number < kLoose)
    document::report(warnings, stiffness->place, "hand.stiffness",
                     fmt::format("{0:g} N/m holds no arm; expected N/m: {0:g} N/mm are {1:g} N/m", stiffness->number,
                                 stiffness->number * 1000));
  if (mass != nullptr && mass->number > kHeavy)
    document::report(
        warnings, mass->place, "hand.mass",
        fmt::format("{0:g} kg is no hand; expected kg: {0:g} g are {1:g} kg", mass->number, mass->number / 1000));
  if (device.limits.force > 0 && device.limits.force < kUnfeltForce)
    document::report(warnings, device.place.line > 0 ? device.place : document::Place{device.file.string()},
                     "limits.force",
                     fmt::format("{0:g} N cannot be felt; expected N: {0:g} kN are {1:g} N", device.limits.force,
                                 device.limits.force * 1000));
}

void handOf(const scene::Device& device, document::Problems& warnings) {
  constexpr double kCircles = 4;  // the script
  constexpr double kSpeed = 2;    // [m/s] what a hand reaches that strokes or presses
  if (device.module != "simulated") return;
  const scene::Value *sweep = valueOf(device, "hand.sweep"), *rise = valueOf(device, "hand.rise"),
                     *rate = valueOf(device, "hand.rate"), *radius = valueOf(device, "hand.radius");
  if (sweep != nullptr && std::abs(sweep->number) > M_PI * 1.001)
    document::report(
        warnings, sweep->place, "hand.sweep",
        fmt::format("{:g} rad to either side is more than half a turn; expected rad: {:g} degrees are {:.4g} "
                    "rad",
                    sweep->number, sweep->number, sweep->number * M_PI / 180));
  holdOf(device, warnings);
  if (rate == nullptr) return;
  const scene::Value* script = valueOf(device, "hand.script");
  const bool circles = script != nullptr && script->number == kCircles;
  const double turn = circles ? 1 : sweep != nullptr ? std::abs(sweep->number) : 0;
  const double arc = radius != nullptr ? turn * radius->number : 0;
  const double way = std::max(arc, rise != nullptr ? std::abs(rise->number) : 0);
  if (const double speed = way * 2 * M_PI * rate->number; speed > kSpeed)
    document::report(
        warnings, rate->place, "hand.rate",
        fmt::format("{:g} Hz over {:.3g} m move the hand at up to {:.3g} m/s; expected what a hand does, below "
                    "{:g} m/s: lengths in m, and times a second ({:g} times a minute are {:.3g} Hz)",
                    rate->number, way, speed, kSpeed, rate->number, rate->number / 60));
}

bool samePlace(const scene::Pose& a, const scene::Pose& b) {
  constexpr double kSame = 1e-6;
  return (a.position - b.position).norm() < kSame && a.orientation.angularDistance(b.orientation) < kSame;
}

/// Simulated arms may stand in one another, as long as their hands do not.
bool sameHand(const scene::Device& a, const scene::Device& b) {
  const auto differs = [](const scene::Device& one, const scene::Device& other) {
    return std::any_of(one.parameters.begin(), one.parameters.end(), [&](const scene::Value& value) {
      const scene::Value* there = valueOf(other, value.id.c_str());
      return value.id.rfind("hand.", 0) == 0 && (there == nullptr || there->number != value.number ||
                                                 there->text != value.text || there->numbers != value.numbers);
    });
  };
  return !differs(a, b) && !differs(b, a);
}

void mountsOf(const scene::Scene& scene, document::Problems& warnings) {
  for (size_t i = 0; i < scene.devices.size(); ++i) {
    const scene::Device& device = scene.devices[i];
    if (const double away = device.mount.position.norm(); away > kFarMount && device.place.line > 0)
      document::report(
          warnings, device.place, "device.mount.position",
          fmt::format("{:g} m from the world's origin, where the scenes have their shapes; expected metres: "
                      "{:g} mm are {:g} m",
                      away, away, away / 1000));
    for (size_t j = 0; j < i; ++j)
      if (samePlace(device.mount, scene.devices[j].mount) && sameHand(device, scene.devices[j]))
        document::report(
            warnings, device.place, fmt::format("devices[{}].mount", i),
            fmt::format("{} stands where {} stands; expected a mount for each: {{position: [x, y, z]}} in m",
                        device.name, scene.devices[j].name));
  }
}

}  // namespace

document::Problems doubtfulSettings(const scene::Scene& scene) {
  document::Problems warnings;
  servoOf(scene.servo, ServoGiven(scene, warnings));
  for (const scene::Device& device : scene.devices) handOf(device, warnings);
  mountsOf(scene, warnings);
  return warnings;
}

}  // namespace hapticd::diagnostics
