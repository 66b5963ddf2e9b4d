// SPDX-License-Identifier: MIT
#include "diagnostics/device/motor_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "diagnostics/device/motor_force.hpp"
#include "diagnostics/reading/given_values.hpp"
#include "document/table.hpp"

namespace hapticd::diagnostics {

using document::Node;

/// Warns of a largest torque of 0: it means that the torque is unknown, so the torque of the joint is not bounded.
static void noTorque(const Node& root, const scene::Device& device, document::Problems& warnings) {
  const Node* list = find(root, {"parameters", "arm", "max_torque"});
  if (list == nullptr || !list->isSequence()) return;
  for (size_t i = 0; i < list->items.size(); ++i) {
    const Node& item = list->items[i];
    if (document::toNumber(item.scalar).value_or(1) != 0) continue;
    document::report(
        warnings, device.file.string(), item.line, item.column, fmt::format("parameters.arm.max_torque[{}]", i),
        fmt::format("0 is no bound: nothing limits the torque of joint {}; expected the torque in N m that its "
                    "motor gives at the joint",
                    i + 1));
  }
}

/// The motors of a file, and what warnings about them need.
struct Motors {
  std::vector<const Node*> list;
  const scene::Device& device;
  document::Problems& warnings;

  size_t count() const { return std::min(device.limits.motors.size(), list.size()); }
  void warn(size_t i, const char* key, const std::string& what) const {
    const Node *given = list[i]->find(key), *at = given != nullptr ? given : list[i];
    document::report(warnings, device.file.string(), at->line, at->column, fmt::format("limits.motors[{}].{}", i, key),
                     what);
  }
};

/// Warns of values that no motor of an arm for a hand has. @return true if the motor has such a value
static bool oddMotor(const Motors& motors, size_t i) {
  constexpr double kStrong = 8, kResists = 200, kReduces = 0.5;  // [N m/A] with its gear; [ohm]; ratio of a gear
  const scene::Motor& motor = motors.device.limits.motors[i];
  const size_t before = motors.warnings.size();
  if (motor.torque_constant > kStrong)
    motors.warn(i, "torque_constant",
                fmt::format("{0:g} N m/A is more than any motor of such an arm gives, so its heat would never be "
                            "noticed; the value must be in N m/A: {0:g} mN m/A is {1:g} N m/A",
                            motor.torque_constant, motor.torque_constant / 1000));
  if (motor.resistance > kResists)
    motors.warn(i, "resistance",
                fmt::format("{0:g} ohm would make it hot at once; the value must be in ohm: {0:g} mohm is {1:g} ohm",
                            motor.resistance, motor.resistance / 1000));
  if (motor.ratio > 0 && motor.ratio < kReduces)
    motors.warn(i, "ratio",
                fmt::format("with {:g} the joint would be weaker than its motor; the value must be the torque at the "
                            "joint divided by the torque at the motor: {:.3g} if it was inverted",
                            motor.ratio, 1 / motor.ratio));
  if (motor.housing_time <= motor.winding_time)
    motors.warn(
        i, "housing_time",
        fmt::format("{0:g} s is no longer than the {1:g} s of winding_time, but a housing warms more slowly than "
                    "its winding; the value must be in s: {0:g} min is {2:g} s",
                    motor.housing_time, motor.winding_time, motor.housing_time * 60));
  return motors.warnings.size() > before;
}

/// Warns of a motor whose winding gets far too hot, or not at all warm, at the largest torque of its joint.
static void oddHeat(const Motors& motors, size_t i, double torque) {
  constexpr double kCold = 1e-3, kHot = 200;  // [W] less does not warm a winding; more melts that of an arm for a hand
  const scene::Motor& motor = motors.device.limits.motors[i];
  if (!(motor.torque_constant > 0) || !(motor.ratio > 0)) return;
  const double current = torque / (motor.torque_constant * motor.ratio);
  const double heat = current * current * motor.resistance;
  if (heat >= kCold && heat <= kHot) return;
  motors.warn(i, "torque_constant",
              fmt::format("with ratio {:g}, the {:g} N m of arm.max_torque need {:.3g} A, which makes {:.3g} W in the "
                          "winding, so its heat is {}; the value must be in N m/A ({:g} mN m/A is {:g} N m/A), and "
                          "ratio must be joint torque over motor torque",
                          motor.ratio, torque, current, heat, heat < kCold ? "never noticed" : "always too much",
                          motor.torque_constant, motor.torque_constant / 1000));
}

void warnOfMotors(const Node& root, const scene::Device& device, size_t joints, document::Problems& warnings) {
  noTorque(root, device, warnings);
  const Node* list = find(root, {"limits", "motors"});
  if (list == nullptr) return;
  if (const size_t given = device.limits.motors.size(); list->isSequence() && given < joints && given > 0)
    document::report(warnings, device.file.string(), list->line, list->column, "limits.motors",
                     fmt::format("{} of {} joints: the heat of the other motors is not computed; expected an entry for "
                                 "each joint, in their order",
                                 given, joints));
  const std::vector<double> torque = motorsOf(device, joints);
  const Motors motors{document::elementsOf(*list), device, warnings};
  for (size_t i = 0; i < motors.count(); ++i)
    if (!oddMotor(motors, i) && i < torque.size()) oddHeat(motors, i, torque[i]);
}

}  // namespace hapticd::diagnostics
