// SPDX-License-Identifier: MIT
/// Base class of the arms that are driven through a vendor's library. The joints of such an arm are the coordinates of
/// its tip, and the library compensates the weight of the arm.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstring>

#include "hapticd/device.hpp"
#include "hapticd/device_trouble.h"
#include "vendor_arm/exchange.hpp"

namespace hapticd::vendor_arm {

/// A derived class Arm defines `fields()`, `open()` and `start()`, has a parameter for `reach`, and calls describe() in
/// open().
template <class Arm>
class CartesianArm : public Device {
 public:
  double reach = 0;  ///< [m] largest distance of the tip from the origin, on each axis

  hsp_status read(uint64_t, hdv_sample& sample) noexcept HSP_RT { return exchange_.read(sample); }
  hsp_status write(uint64_t, const hdv_command& command) noexcept HSP_RT { return exchange_.write(command); }
  const void* extension(const char* name) {
    if (std::strcmp(name, HDV_EXT_KINEMATICS) == 0) return &kKinematics;
    if (std::strcmp(name, HDV_EXT_CUT) == 0) return &kCut;
    if (std::strcmp(name, HDV_EXT_TROUBLE) == 0) return &kTrouble;
    return nullptr;
  }

 protected:
  static Arm& self(hdv_device* arm) { return *reinterpret_cast<Arm*>(arm); }
  static const Arm& self(const hdv_device* arm) { return *reinterpret_cast<const Arm*>(arm); }

  void describe(hdv_info& info, double max_force) const {
    info.joint_count = 3;
    info.capabilities = HDV_C_UNVERIFIED | HDV_C_CALIBRATION;
    info.max_force = max_force;
    for (int i = 0; i < 3; ++i) {
      info.max_torque[i] = max_force;
      info.position_min[i] = -reach, info.position_max[i] = reach;
    }
  }

  Exchange exchange_;

 private:
  CartesianArm() = default;
  friend Arm;

  /// The orientation is always the identity: the handle can turn, but its orientation is not measured.
  static hsp_status forward(const hdv_device*, const double* q, double position[3],
                            double orientation[4]) noexcept HSP_RT {
    std::copy_n(q, 3, position);
    orientation[0] = 1;
    std::fill_n(orientation + 1, 3, 0.0);
    return HSP_OK;
  }
  static hsp_status jacobian(const hdv_device*, const double*, double* J) noexcept HSP_RT {
    constexpr int kNumbers = 18, kJoints = 3;
    std::fill_n(J, kNumbers, 0.0);
    for (int i = 0; i < kJoints; ++i) J[i * kJoints + i] = 1;
    return HSP_OK;
  }
  static hsp_status weight(const hdv_device*, const double*, const double*, double* tau) noexcept HSP_RT {
    std::fill_n(tau, 3, 0.0);
    return HSP_OK;
  }
  static hsp_status inverse(const hdv_device* arm, const double position[3], double* q) noexcept HSP_RT {
    for (int i = 0; i < 3; ++i)
      if (!(std::abs(position[i]) <= self(arm).reach)) return HSP_E_NUMERIC;
    std::copy_n(position, 3, q);
    return HSP_OK;
  }
  static void cut(hdv_device* arm) noexcept HSP_RT { self(arm).exchange_.cut(); }
  static const char* why(const hdv_device* arm) noexcept HSP_RT {
    return self(arm).exchange_.lost() ? "the vendor's library lost the arm; plug it in and start the daemon again"
                                      : nullptr;
  }

  static constexpr hdv_ext_kinematics kKinematics = {
      sizeof(hdv_ext_kinematics), 3, &forward, &jacobian, &weight, &inverse};
  static constexpr hdv_ext_cut kCut = {sizeof(hdv_ext_cut), 0, &cut};
  static constexpr hdv_ext_trouble kTrouble = {sizeof(hdv_ext_trouble), 0, &why};
};

}  // namespace hapticd::vendor_arm
