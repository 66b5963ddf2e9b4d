// SPDX-License-Identifier: MIT
/// Calls the four kinematic functions of a module so that a check can find out which of them crashed, hung,
/// or wrote beyond the memory for its results.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/call_name.hpp"
#include "hapticd/device.h"
#include "host/call_trail.hpp"

namespace hapticd::host {

using Joints = Eigen::Matrix<double, HDV_MAX_JOINTS, 1>;

/// Memory for `Most` numbers, of which a module may write the first `used`. All others contain kMark, and overrun()
/// finds whether the module overwrote one of them.
template <size_t Most>
class GuardedArray {
 public:
  explicit GuardedArray(size_t used) : used_(used) {
    numbers_.fill(kMark);
    std::fill_n(numbers_.begin(), used_, 0.0);
  }
  double* data() { return numbers_.data(); }
  const double* data() const { return numbers_.data(); }
  bool overrun() const {
    return std::any_of(numbers_.begin() + static_cast<std::ptrdiff_t>(used_), numbers_.end(),
                       [](double value) { return value != kMark; });
  }
  bool finite() const {
    return std::all_of(numbers_.begin(), numbers_.begin() + static_cast<std::ptrdiff_t>(used_),
                       [](double value) { return std::isfinite(value); });
  }

 private:
  static constexpr size_t kBeyond = 512;  ///< further numbers that a module with a wrong joint count may overwrite
  static constexpr double kMark = 8.25e77;
  size_t used_;
  std::array<double, Most + kBeyond> numbers_;
};

struct Tip {
  Eigen::Vector3d position{0, 0, 0};
  Eigen::Quaterniond orientation{1, 0, 0, 0};
  double length = 1;  ///< length of the quaternion that the module gave
};

class KinematicsCalls {
 public:
  using JacobianRoom = GuardedArray<6 * HDV_MAX_JOINTS>;
  using JointRoom = GuardedArray<HDV_MAX_JOINTS>;

  KinematicsCalls(const hdv_ext_kinematics& kinematics, const hdv_device* device)
      : kinematics_(kinematics), device_(device) {}

  Eigen::Index joints() const { return static_cast<Eigen::Index>(kinematics_.joint_count); }

  hsp_status forward(const Joints& q, Tip& tip) const {
    const CallName name = calling("forward");
    double turn[4] = {1, 0, 0, 0};
    const hsp_status status = kinematics_.forward(device_, q.data(), tip.position.data(), turn);
    tip.orientation = Eigen::Quaterniond(turn[0], turn[1], turn[2], turn[3]);
    tip.length = tip.orientation.norm();
    return status;
  }
  hsp_status jacobian(const Joints& q, JacobianRoom& J) const {
    const CallName name = calling("jacobian");
    return kinematics_.jacobian(device_, q.data(), J.data());
  }
  hsp_status gravity(const Joints& q, const Eigen::Vector3d& acceleration, JointRoom& torque) const {
    const CallName name = calling("gravity");
    return kinematics_.gravity(device_, q.data(), acceleration.data(), torque.data());
  }
  hsp_status inverse(const Eigen::Vector3d& position, JointRoom& q) const {
    const CallName name = calling("inverse");
    return kinematics_.inverse(device_, position.data(), q.data());
  }

 private:
  static CallName calling(const char* name) {
    noteCall(name);
    return CallName(name);
  }
  const hdv_ext_kinematics& kinematics_;
  const hdv_device* device_;
};

/// Returns joint positions for messages, such as "(0.1, -0.4)".
inline std::string placeText(const Joints& q, Eigen::Index joints) {
  std::string text = "(";
  for (Eigen::Index i = 0; i < joints; ++i) {
    char number[32];
    std::snprintf(number, sizeof number, "%s%.4g", i > 0 ? ", " : "", q[i]);
    text += number;
  }
  return text + ")";
}

}  // namespace hapticd::host
