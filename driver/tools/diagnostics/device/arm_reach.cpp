// SPDX-License-Identifier: MIT
#include "diagnostics/device/arm_reach.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace hapticd::diagnostics {
namespace {

using Eigen::Vector3d;

using Joints = std::array<double, HDV_MAX_JOINTS>;

/// Returns the tip of an arm; nothing if it cannot have these joints, for example because two limits are coupled.
std::optional<Vector3d> tipOf(const host::DeviceInstance& arm, const Joints& q) {
  const hdv_ext_kinematics& kinematics = arm.kinematics();
  Vector3d tip = Vector3d::Zero();
  std::array<double, 4> turn{};
  if (kinematics.forward(arm.handle(), q.data(), tip.data(), turn.data()) < 0 || !tip.allFinite()) return std::nullopt;
  Joints other = q;
  if (kinematics.inverse != nullptr && kinematics.inverse(arm.handle(), tip.data(), other.data()) < 0)
    return std::nullopt;
  return tip;
}

/// Returns the tip that is farthest along a direction; nothing if no pose was found.
std::optional<Vector3d> farthestAlong(const host::DeviceInstance& arm, const Vector3d& way) {
  constexpr int kTrials = 6000, kWide = 3000;  // the first are anywhere, the last very near to the best pose so far
  const hdv_info& info = arm.info();
  std::mt19937_64 random(1);  // the same trials in every run
  Joints best{}, q{};
  std::optional<Vector3d> farthest;
  for (int trial = 0; trial < kTrials; ++trial) {
    const double width = trial < kWide ? 1 : std::pow(1e-5, (trial - kWide + 0.0) / (kTrials - kWide));
    for (uint32_t i = 0; i < info.joint_count; ++i) {
      const double low = info.position_min[i], high = info.position_max[i];
      const double part = static_cast<double>(random() >> 11) * 0x1p-53;
      const double middle = farthest ? best[i] : 0.5 * (low + high);
      q[i] = std::clamp(middle + width * (2 * part - 1) * (high - low), low, high);
    }
    const auto tip = tipOf(arm, q);
    if (!tip || (farthest && tip->dot(way) <= farthest->dot(way))) continue;
    best = q, farthest = tip;
  }
  return farthest;
}

}  // namespace

std::optional<Eigen::AlignedBox3d> boxOfReach(const host::DeviceInstance& arm) {
  const hdv_info& info = arm.info();
  for (uint32_t i = 0; i < info.joint_count; ++i)
    if (!(info.position_max[i] > info.position_min[i]) || !std::isfinite(info.position_max[i] - info.position_min[i]))
      return std::nullopt;
  Eigen::AlignedBox3d box;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0})
      if (const auto tip = farthestAlong(arm, sign * Vector3d::Unit(axis))) box.extend(*tip);
  return box.isEmpty() ? std::nullopt : std::optional(box);
}

double reachOf(const scene::Device& device, const host::DeviceInstance& arm, const Vector3d& tip_device) {
  constexpr int kPoses = 4000;
  const scene::Value* limits = givenIn(device.parameters, "arm.limits");
  const uint32_t joints = arm.kinematics().joint_count;
  const bool given = limits != nullptr && limits->numbers.size() == 2 * joints;
  std::mt19937_64 random(1);  // the same poses in every run
  double farthest = 0;
  for (int pose = 0; pose < kPoses; ++pose) {
    std::array<double, HDV_MAX_JOINTS> q{};
    for (size_t i = 0; i < joints; ++i) {
      const double part = static_cast<double>(random() >> 11) * 0x1p-53;
      const double* range = given ? limits->numbers.data() + 2 * i : nullptr;
      q[i] = given ? range[0] + part * (range[1] - range[0]) : M_PI * (2 * part - 1);
    }
    Vector3d tip = Vector3d::Zero();
    std::array<double, 4> turn{};
    if (arm.kinematics().forward(arm.handle(), q.data(), tip.data(), turn.data()) < 0 || !tip.allFinite()) continue;
    farthest = std::max(farthest, (tip - tip_device).norm());
  }
  return farthest;
}

}  // namespace hapticd::diagnostics
