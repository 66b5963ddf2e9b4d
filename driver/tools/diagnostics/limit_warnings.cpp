// SPDX-License-Identifier: MIT
#include "diagnostics/limit_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "base/short_number.hpp"
#include "diagnostics/given_values.hpp"
#include "diagnostics/motor_reach.hpp"
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

using Joints = std::array<double, HDV_MAX_JOINTS>;

/// Returns three rows of the Jacobian in one pose, from `first` on; nothing if the module cannot calculate it.
std::optional<Eigen::Matrix3Xd> jacobianAt(const Joints& q, const host::DeviceInstance& arm, Eigen::Index first) {
  const hdv_ext_kinematics& kinematics = arm.kinematics();
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor> all(6, kinematics.joint_count);
  if (kinematics.jacobian(arm.handle(), q.data(), all.data()) < 0) return std::nullopt;
  return all.middleRows<3>(first);
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
  const std::string allowed =  // a wrong limit is told elsewhere, and was not read
      device.limits.force > 0 ? fmt::format(", but limits.force allows only {:g} N", device.limits.force) : "";
  document::report(warnings, device.file.string(), at->line, at->column, "parameters.arm.max_torque",
                   fmt::format("these torques give {} N at the tip{}; torques must be in N m, here and in the "
                               "scales of the torques: {:g} N mm is {:g} N m",
                               shortNumber(reach), allowed, most, most / 1000));
}

/// Moves joints between their stops: those of a simulated chain to the middle, where it begins, and others to the
/// nearest stop if they are beyond it.
void keepWithinStops(const Node& root, std::array<double, HDV_MAX_JOINTS>& q, uint32_t joints) {
  const Node *rows = find(root, {"parameters", "arm", "limits"}), *kind = find(root, {"parameters", "arm", "kind"});
  const Node* module = find(root, {"module"});
  if (rows == nullptr || !rows->isSequence() || rows->items.size() != joints) return;
  const bool middle = module != nullptr && module->scalar == "simulated" && kind != nullptr && kind->scalar == "chain";
  for (size_t i = 0; i < joints && i < q.size(); ++i) {
    const Node& row = rows->items[i];
    if (!row.isSequence() || row.items.size() != 2) continue;
    const auto low = document::toNumber(row.items[0].scalar), high = document::toNumber(row.items[1].scalar);
    if (low && high && *low < *high) q[i] = middle ? (*low + *high) / 2 : std::clamp(q[i], *low, *high);
  }
}

}  // namespace

std::array<double, HDV_MAX_JOINTS> restJoints(const Node& root, uint32_t joints) {
  std::array<double, HDV_MAX_JOINTS> q{};
  const Node* pose = find(root, {"parameters", "calibration", "pose"});
  if (pose == nullptr || !pose->isSequence() || pose->items.size() != joints) {
    keepWithinStops(root, q, joints);
    return q;
  }
  for (size_t i = 0; i < joints && i < q.size(); ++i) q[i] = document::toNumber(pose->items[i].scalar).value_or(0);
  return q;
}

std::vector<double> motorsOf(const scene::Device& device, size_t joints) {
  const scene::Value* value = givenIn(device.parameters, "arm.max_torque");
  std::vector<double> torque = value == nullptr ? std::vector<double>() : value->numbers;
  if (torque.size() == 1) torque.assign(joints, torque[0]);
  const bool all = torque.size() == joints && std::all_of(torque.begin(), torque.end(), [](double t) { return t > 0; });
  return all ? torque : std::vector<double>();
}

std::optional<double> forceOfMotors(const Node& root, const scene::Device& device, const host::DeviceInstance& arm) {
  const std::vector<double> motors = motorsOf(device, arm.kinematics().joint_count);
  const auto linear = jacobianAt(restJoints(root, arm.kinematics().joint_count), arm, 0);
  return motors.empty() || !linear ? std::nullopt : farthestReach(*linear, motors);
}

/// The largest force of the motors at the tip [N], and where it holds: at rest, or, if the arm rests stretched out, the
/// median over some poses. The links of a stretched arm bear any force along the arm, so its motors bound nothing
/// there.
struct MotorForce {
  double most = 0;
  const char* where = "at rest";
};

static std::optional<MotorForce> motorForce(const Node& root, const scene::Device& device,
                                            const host::DeviceInstance& arm) {
  if (const auto at_rest = forceOfMotors(root, device, arm)) return MotorForce{*at_rest};
  const uint32_t joints = arm.kinematics().joint_count;
  const std::vector<double> motors = motorsOf(device, joints);
  if (motors.empty()) return std::nullopt;
  constexpr int kPoses = 12;
  std::vector<double> reaches;
  for (int pose = 0; pose < kPoses; ++pose) {
    Joints q = restJoints(root, joints);
    for (uint32_t i = 0; i < joints; ++i) q[i] += 0.9 * std::sin(1.7 * (pose + 1) + 2.3 * i);  // up to 0.9 rad away
    keepWithinStops(root, q, joints);
    const auto linear = jacobianAt(q, arm, 0);
    if (const auto reach = linear ? farthestReach(*linear, motors) : std::nullopt) reaches.push_back(*reach);
  }
  if (reaches.empty()) return std::nullopt;
  const auto middle = reaches.begin() + static_cast<std::ptrdiff_t>(reaches.size() / 2);
  std::nth_element(reaches.begin(), middle, reaches.end());
  return MotorForce{*middle, "in half of twelve poses, as it rests stretched out"};
}

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
