// SPDX-License-Identifier: MIT
/// The extensions hdv.kinematics/1 and hdv.links/1 for a device module whose arm is a kinematics::Arm. Only modules
/// include this header: the kinematics library itself does not depend on the ABI.
#pragma once
#include <array>

#include "hapticd/device.h"
#include "hapticd/device_links.h"
#include "kinematics/arm.hpp"

namespace hapticd::kinematics {

/// C functions that call the kinematics of a device class T, which has `const Arm& kinematics() const`.
template <class T>
struct Extension {
  static const Arm& arm(const hdv_device* device) { return reinterpret_cast<const T*>(device)->kinematics(); }

  static hdv_ext_kinematics of(const Arm& arm) {
    return {
        sizeof(hdv_ext_kinematics), static_cast<uint32_t>(arm.jointCount()), &forward, &jacobian, &gravity, &inverse};
  }

  /// Returns the extension hdv.links/1. Its link_count is 0 if the arm cannot be drawn.
  static hdv_ext_links linksOf(const Arm& arm) {
    const auto parents = arm.parents();
    const Eigen::Vector3d base = arm.base();
    return {sizeof(hdv_ext_links),
            static_cast<uint32_t>(parents.size()),
            parents.data(),
            {base.x(), base.y(), base.z()},
            &links};
  }

 private:
  static hsp_status links(const hdv_device* device, const double* from, double* position,
                          double* orientation) noexcept HSP_RT {
    JointVector q;
    std::array<Pose, HDV_MAX_LINKS> ends;
    const size_t count = arm(device).parents().size();
    if (!take(arm(device), from, q) || !arm(device).links(q, {ends.data(), count})) return HSP_E_NUMERIC;
    for (size_t i = 0; i < count; ++i) {
      Eigen::Map<Eigen::Vector3d>(position + 3 * i) = ends[i].position;
      const Eigen::Quaterniond& turn = ends[i].orientation;
      double* to = orientation + 4 * i;
      to[0] = turn.w(), to[1] = turn.x(), to[2] = turn.y(), to[3] = turn.z();
    }
    return HSP_OK;
  }
  static bool take(const Arm& arm, const double* from, JointVector& q) noexcept {
    q = Eigen::Map<const JointVector>(from, arm.jointCount());
    return q.allFinite();
  }
  static hsp_status forward(const hdv_device* device, const double* from, double position[3],
                            double orientation[4]) noexcept HSP_RT {
    JointVector q;
    Pose tip;
    if (!take(arm(device), from, q) || !arm(device).forward(q, tip)) return HSP_E_NUMERIC;
    Eigen::Map<Eigen::Vector3d>(position, 3) = tip.position;
    orientation[0] = tip.orientation.w(), orientation[1] = tip.orientation.x();
    orientation[2] = tip.orientation.y(), orientation[3] = tip.orientation.z();
    return HSP_OK;
  }
  static hsp_status jacobian(const hdv_device* device, const double* from, double* to) noexcept HSP_RT {
    JointVector q;
    Jacobian J;
    if (!take(arm(device), from, q) || !arm(device).jacobian(q, J)) return HSP_E_NUMERIC;
    for (Eigen::Index row = 0; row < 6; ++row)
      for (Eigen::Index joint = 0; joint < J.cols(); ++joint) to[row * J.cols() + joint] = J(row, joint);
    return HSP_OK;
  }
  static hsp_status gravity(const hdv_device* device, const double* from, const double g[3],
                            double* to) noexcept HSP_RT {
    JointVector q, tau;
    if (!take(arm(device), from, q) || !arm(device).gravity(q, Eigen::Vector3d(g[0], g[1], g[2]), tau))
      return HSP_E_NUMERIC;
    for (Eigen::Index i = 0; i < tau.size(); ++i) to[i] = tau[i];
    return HSP_OK;
  }
  static hsp_status inverse(const hdv_device* device, const double position[3], double* joints) noexcept HSP_RT {
    JointVector q;
    if (!take(arm(device), joints, q)) q = arm(device).neutral();
    if (!arm(device).inverse(Eigen::Vector3d(position[0], position[1], position[2]), q)) return HSP_E_NUMERIC;
    for (Eigen::Index i = 0; i < q.size(); ++i) joints[i] = q[i];
    return HSP_OK;
  }
};

}  // namespace hapticd::kinematics
