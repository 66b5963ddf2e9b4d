// SPDX-License-Identifier: MIT
#include "diagnostics/device/mount_warnings.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <optional>

#include "diagnostics/device/rest_joints.hpp"
#include "diagnostics/reading/given_values.hpp"

namespace hapticd::diagnostics {

using document::Node;
namespace {

constexpr double kAway = 0.3;  ///< [m] a reach of the hand: scenes have their shapes nearer to the world's origin

double shown(double value) {
  return std::round(value * 1e3) / 1e3 + 0.0;
}  // [m]; -0 becomes 0

/// Returns the tip at rest [m] in the device frame, of an arm that its file describes.
std::optional<Eigen::Vector3d> restingTip(const Node& root, const host::DeviceInstance& arm) {
  const Node* described = find(root, {"parameters", "arm"});
  if (described == nullptr || !described->isMap()) return std::nullopt;
  const hdv_ext_kinematics& kinematics = arm.kinematics();
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();
  std::array<double, 4> turn{};
  const auto q = restJoints(root, kinematics.joint_count);
  if (kinematics.forward(arm.handle(), q.data(), tip.data(), turn.data()) < 0 || !tip.allFinite()) return std::nullopt;
  return tip;
}

}  // namespace

void warnOfFarMount(const Node& root, const scene::Device& device, const host::DeviceInstance& arm,
                    document::Problems& warnings) {
  const Node* given = root.find("mount");
  // Only where the file says how the arm is held at the start, the place of its tip at rest is known.
  if (find(root, {"parameters", "calibration", "pose"}) == nullptr) return;
  const auto tip = restingTip(root, arm);
  if (given == nullptr || !given->isMap() || given->entries.empty() || !tip) return;
  const Eigen::Vector3d turned = device.mount.orientation * *tip, at = device.mount.position + turned;
  if (at.norm() <= kAway) return;
  const Node* position = given->find("position");
  const Node& node = position != nullptr ? *position : *given;
  const Eigen::Vector3d mount = Eigen::Vector3d(0, 0, 0.09) - turned;
  document::report(
      warnings, device.file.string(), node.line, node.column, "mount",
      fmt::format("the tip rests at [{:g}, {:g}, {:g}] m of the world, {:.2g} m away from the shapes that scenes have "
                  "about the origin; is a sign or a decimal point wrong? expected where the device frame stands in "
                  "the world, in m: [{:g}, {:g}, {:g}] puts the resting tip 9 cm in front of the shapes",
                  shown(at.x()), shown(at.y()), shown(at.z()), at.norm(), shown(mount.x()), shown(mount.y()),
                  shown(mount.z())));
}

void warnOfNoMount(const Node& root, const scene::Device& device, const host::DeviceInstance& arm,
                   document::Problems& warnings) {
  constexpr double kInside = 0.03;  // [m] the radius of a small shape
  const Node* described = find(root, {"parameters", "arm"});
  const Node* given = root.find("mount");
  const auto resting = restingTip(root, arm);
  if (!resting || (given != nullptr && !given->entries.empty())) return;
  const Eigen::Vector3d& tip = *resting;
  // If one of these keys is given, its author has chosen where the tip is.
  const bool placed = described->find("origin") != nullptr || described->find("base_position") != nullptr;
  if (tip.norm() <= kAway && (placed || tip.norm() >= kInside)) return;
  const Eigen::Vector3d mount = Eigen::Vector3d(0, 0, 0.09) - tip;
  const Node& at = given != nullptr ? *given : root;
  document::report(
      warnings, device.file.string(), at.line, at.column, "mount",
      fmt::format("not given, so the tip rests at [{:g}, {:g}, {:g}] m of the world, {} the shapes that scenes have "
                  "about the origin; expected where the arm stands: mount: {{position: [{:g}, {:g}, {:g}]}} puts the "
                  "resting tip 9 cm in front of them",
                  shown(tip.x()), shown(tip.y()), shown(tip.z()), tip.norm() < kInside ? "inside" : "far from",
                  shown(mount.x()), shown(mount.y()), shown(mount.z())));
}

}  // namespace hapticd::diagnostics
