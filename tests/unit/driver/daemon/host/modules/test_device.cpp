// SPDX-License-Identifier: MIT
/// A planar arm of two sliding joints, for tests of the host and of device files.
#include <cstring>
#include <stdexcept>

#include "hapticd/device.hpp"

namespace {

struct TestDevice : hapticd::Device {
  static constexpr hapticd::DeviceInfo kInfo{"org.hapticd.test.device", "test_device", "0.1.0", "MIT",
                                             "Two sliding joints and a hand."};
  double gain = 0, hand_mass = 0;
  std::string port, hand_mode;

  static constexpr auto fields() {
    using F = hapticd::Fields<TestDevice>;
    return std::array{
        F::real("gain", &TestDevice::gain, "", 0, 10, 1, "A gain; 0 makes open() fail."),
        F::path("port", &TestDevice::port, "A device node."),
        F::real("hand.mass", &TestDevice::hand_mass, "kg", 0.001, 10, 0.1, "Mass of the hand."),
        F::text("hand.mode", &TestDevice::hand_mode, "rest", "What the hand does."),
    };
  }
  void open(hdv_info& info) {
    if (gain == 0) throw std::runtime_error("no arm on the bus");
    info.joint_count = 2;
    info.capabilities = HDV_C_SIMULATED;
    info.rate_hz = 1000;
    std::strcpy(info.product, "test arm");
  }
  void start(const hdv_start&) {}
  hsp_status read(uint64_t now_ns, hdv_sample& sample) noexcept HSP_RT {
    sample.time_ns = now_ns;
    return HSP_OK;
  }
  hsp_status write(uint64_t, const hdv_command&) noexcept HSP_RT { return HSP_OK; }

  const void* extension(const char* name) {
    static const hdv_ext_kinematics kKinematics = {
        sizeof(hdv_ext_kinematics),
        2,
        [](const hdv_device*, const double* q, double position[3],
           double orientation[4]) noexcept HSP_RT -> hsp_status {
          position[0] = q[0], position[1] = q[1], position[2] = 0;
          orientation[0] = 1, orientation[1] = orientation[2] = orientation[3] = 0;
          return HSP_OK;
        },
        [](const hdv_device*, const double*, double* J) noexcept HSP_RT -> hsp_status {
          for (int i = 0; i < 12; ++i) J[i] = i == 0 || i == 3 ? 1 : 0;
          return HSP_OK;
        },
        [](const hdv_device*, const double*, const double gravity[3], double* tau) noexcept HSP_RT -> hsp_status {
          tau[0] = -gravity[0], tau[1] = -gravity[1];  // 1 kg
          return HSP_OK;
        },
        [](const hdv_device*, const double position[3], double* q) noexcept HSP_RT -> hsp_status {
          q[0] = position[0], q[1] = position[1];
          return position[2] == 0 ? HSP_OK : HSP_E_NUMERIC;
        }};
    return std::strcmp(name, HDV_EXT_KINEMATICS) == 0 ? &kKinematics : nullptr;
  }
};

}  // namespace

HAPTICD_DEVICES(TestDevice)
