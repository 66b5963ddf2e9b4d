// SPDX-License-Identifier: MIT
#include "diagnostics/device/motor_force.hpp"

#include <algorithm>
#include <cmath>

#include "diagnostics/device/motor_reach.hpp"

namespace hapticd::diagnostics {

using document::Node;

std::optional<Eigen::Matrix3Xd> jacobianAt(const Joints& q, const host::DeviceInstance& arm, Eigen::Index first) {
  const hdv_ext_kinematics& kinematics = arm.kinematics();
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor> all(6, kinematics.joint_count);
  if (kinematics.jacobian(arm.handle(), q.data(), all.data()) < 0) return std::nullopt;
  return all.middleRows<3>(first);
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

std::optional<MotorForce> motorForce(const Node& root, const scene::Device& device, const host::DeviceInstance& arm) {
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

}  // namespace hapticd::diagnostics
