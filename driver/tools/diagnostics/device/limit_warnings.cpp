// SPDX-License-Identifier: MIT
#include "diagnostics/device/limit_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "base/short_number.hpp"
#include "diagnostics/device/motor_force.hpp"
#include "diagnostics/device/motor_reach.hpp"
#include "diagnostics/device/rest_joints.hpp"
#include "diagnostics/reading/given_values.hpp"
#include "document/reader.hpp"

namespace hapticd::diagnostics {
namespace {

using document::Node;

/// Warns if limits.force is larger than the force of the arm. A force of 0 means that it is unknown.
void forceBeyondArm(const Node& root, const scene::Device& device, document::Problems& warnings) {
  const scene::Value* most = givenIn(device.parameters, "device.max_force");
  if (most == nullptr) most = givenIn(device.parameters, "max_force");
  if (most == nullptr || most->number <= 0 || device.limits.force <= most->number) return;
  const Node* limit = find(root, {"limits", "force"});
  const document::Place place =
      limit != nullptr ? document::Place{device.file.string(), limit->line, limit->column} : most->place;
  document::report(warnings, place, "limits.force",
                   document::numberText(device.limits.force) + " N is more than the arm's " + most->id + " of " +
                       document::numberText(most->number) + " N, expected no more");
}

/// Warns of a limit that the motors cannot reach at rest in any direction: it was meant in other units, or has no
/// effect.
void beyondMotors(const Node* at, const char* key, double given, double reach, const char* unit, const char* where,
                  const std::string& file, document::Problems& warnings) {
  constexpr double kBeyond = 1.5;  // factor, because elsewhere in its workspace an arm may give somewhat more
  if (at == nullptr || given <= kBeyond * reach) return;
  document::report(warnings, file, at->line, at->column, key,
                   fmt::format("{:g} {} is beyond the motors: with arm.max_torque they give at most {} {} {}; "
                               "expected a limit below that, or the torques at the joints (motor times gear)",
                               given, unit, shortNumber(reach), unit, where));
}

/// Warns of motors that push far harder than allowed, because N mm were meant.
void motorsBeyondAll(const Node& root, const scene::Device& device, double reach, document::Problems& warnings) {
  constexpr double kMost = 1000, kTimes = 100;  // [N]; factor of limits.force
  const Node* at = find(root, {"parameters", "arm", "max_torque"});
  if (at == nullptr || reach < kMost || reach < kTimes * device.limits.force) return;
  const scene::Value* torques = givenIn(device.parameters, "arm.max_torque");
  double most = 600;  // [N mm] as an example
  if (torques != nullptr && !torques->numbers.empty())
    most = *std::max_element(torques->numbers.begin(), torques->numbers.end());
  const std::string allowed =  // a wrong limit is reported elsewhere, and was not read
      device.limits.force > 0 ? fmt::format(", but limits.force allows only {:g} N", device.limits.force) : "";
  document::report(warnings, device.file.string(), at->line, at->column, "parameters.arm.max_torque",
                   fmt::format("these torques give {} N at the tip{}; torques must be in N m, here and in the "
                               "scales of the torques: {:g} N mm is {:g} N m",
                               shortNumber(reach), allowed, most, most / 1000));
}

}  // namespace

void warnOfLimits(const Node& root, const scene::Device& device, const host::DeviceInstance& arm,
                  document::Problems& warnings) {
  forceBeyondArm(root, device, warnings);
  const std::string file = device.file.string();
  const std::vector<double> motors = motorsOf(device, arm.kinematics().joint_count);
  const auto angular = jacobianAt(restJoints(root, arm.kinematics().joint_count), arm, 3);
  if (motors.empty() || !angular) return;
  if (const auto reach = motorForce(root, device, arm)) {
    beyondMotors(find(root, {"limits", "force"}), "limits.force", device.limits.force, reach->most, "N", reach->where,
                 file, warnings);
    motorsBeyondAll(root, device, reach->most, warnings);
    const scene::Value* claimed = givenIn(device.parameters, "device.max_force");
    beyondMotors(find(root, {"parameters", "device", "max_force"}), "parameters.device.max_force",
                 claimed == nullptr ? 0 : claimed->number, reach->most, "N", reach->where, file, warnings);
  }
  // In a direction in which no motor moves the tip, the mechanism carries the load. Without a bound, the sum of all
  // motors is used.
  const double together = std::accumulate(motors.begin(), motors.end(), 0.0);
  beyondMotors(find(root, {"limits", "torque"}), "limits.torque", device.limits.torque,
               farthestReach(*angular, motors).value_or(together), "N m", "at rest", file, warnings);
}

}  // namespace hapticd::diagnostics
