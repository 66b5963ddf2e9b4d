// SPDX-License-Identifier: MIT
#include "diagnostics/motor_advice.hpp"

#include <fmt/format.h>

#include "diagnostics/limit_advice.hpp"
#include "diagnostics/node_path.hpp"

namespace hapticd::diagnostics {

using document::Node;

/// 0 is taken for not known: such a joint has no bound of its own.
static void noTorque(const Node& root, const scene::Device& device, document::Problems& warnings) {
  const Node* list = find(root, {"parameters", "arm", "max_torque"});
  if (list == nullptr || !list->isSequence()) return;
  for (size_t i = 0; i < list->items.size(); ++i) {
    const Node& item = list->items[i];
    if (document::toNumber(item.scalar).value_or(1) != 0) continue;
    document::report(warnings, device.file.string(), item.line, item.column,
                     fmt::format("parameters.arm.max_torque[{}]", i),
                     fmt::format("0 is no bound: joint {} gets whatever a force asks of it; expected the N m that its "
                                 "motor gives at the joint",
                                 i + 1));
  }
}

void adviseMotors(const Node& root, const scene::Device& device, size_t joints, document::Problems& warnings) {
  constexpr double kCold = 1e-3, kHot = 200;  // W in the winding: less warms nothing, more melts those of a hand's arm
  noTorque(root, device, warnings);
  const Node* list = find(root, {"limits", "motors"});
  const std::vector<double> torque = motorsOf(device, joints);
  if (list == nullptr || !list->isSequence()) return;
  if (const size_t given = device.limits.motors.size(); given < joints && given > 0)
    document::report(warnings, device.file.string(), list->line, list->column, "limits.motors",
                     fmt::format("{} of {} joints: the heat of the other motors is not computed; expected an entry for "
                                 "each joint, in their order",
                                 given, joints));
  if (torque.empty()) return;
  for (size_t i = 0; i < device.limits.motors.size() && i < torque.size() && i < list->items.size(); ++i) {
    const scene::Motor& motor = device.limits.motors[i];
    if (!(motor.torque_constant > 0) || !(motor.ratio > 0)) continue;
    const double current = torque[i] / (motor.torque_constant * motor.ratio);
    const double heat = current * current * motor.resistance;
    if (heat >= kCold && heat <= kHot) continue;
    const Node *constant = list->items[i].find("torque_constant"),
               *at = constant != nullptr ? constant : &list->items[i];
    document::report(
        warnings, device.file.string(), at->line, at->column, fmt::format("limits.motors[{}].torque_constant", i),
        fmt::format("with ratio {:g}, the {:g} N m of arm.max_torque need {:.3g} A, which makes {:.3g} W in the "
                    "winding, so its heat is {}; the value must be in N m/A ({:g} mN m/A is {:g} N m/A), and ratio "
                    "must be joint torque over motor torque",
                    motor.ratio, torque[i], current, heat, heat < kCold ? "never noticed" : "always too much",
                    motor.torque_constant, motor.torque_constant / 1000));
  }
}

}  // namespace hapticd::diagnostics
