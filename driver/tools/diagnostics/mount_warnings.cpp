// SPDX-License-Identifier: MIT
#include "diagnostics/mount_warnings.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "diagnostics/limit_warnings.hpp"
#include "diagnostics/node_path.hpp"

namespace hapticd::diagnostics {

using document::Node;

void warnOfNoMount(const Node& root, const scene::Device& device, const host::DeviceInstance& arm,
                   document::Problems& warnings) {
  constexpr double kInside = 0.03, kAway = 0.3;  // [m] the radius of a small shape; a reach of the hand
  const Node* described = find(root, {"parameters", "arm"});
  const Node* given = root.find("mount");
  if (described == nullptr || !described->isMap() || (given != nullptr && !given->entries.empty())) return;
  const hdv_ext_kinematics& kinematics = arm.kinematics();
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();
  std::array<double, 4> turn{};
  const auto q = restJoints(root, kinematics.joint_count);
  if (kinematics.forward(arm.handle(), q.data(), tip.data(), turn.data()) < 0 || !tip.allFinite()) return;
  // If one of these keys is given, its author has chosen where the tip is.
  const bool placed = described->find("origin") != nullptr || described->find("base_position") != nullptr;
  if (tip.norm() <= kAway && (placed || tip.norm() >= kInside)) return;
  const Eigen::Vector3d mount = Eigen::Vector3d(0, 0, 0.09) - tip;
  const Node& at = given != nullptr ? *given : root;
  const auto shown = [](double value) { return std::round(value * 1e3) / 1e3 + 0.0; };  // [m]; -0 becomes 0
  document::report(
      warnings, device.file.string(), at.line, at.column, "mount",
      fmt::format("not given, so the tip rests at [{:g}, {:g}, {:g}] m of the world, {} the shapes that scenes have "
                  "about the origin; expected where the arm stands: mount: {{position: [{:g}, {:g}, {:g}]}} puts the "
                  "resting tip 9 cm in front of them",
                  shown(tip.x()), shown(tip.y()), shown(tip.z()), tip.norm() < kInside ? "inside" : "far from",
                  shown(mount.x()), shown(mount.y()), shown(mount.z())));
}

}  // namespace hapticd::diagnostics
