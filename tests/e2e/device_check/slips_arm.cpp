// SPDX-License-Identifier: MIT
/// A planar arm of two joints that makes one slip of many, by its parameter: what the examination of modules must find.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <vector>

#include "hapticd/device.hpp"

namespace {

struct SlipsArm : hapticd::Device {
  static constexpr hapticd::DeviceInfo kInfo{"org.hapticd.test.slips_arm", "slips_arm", "0.1.0", "MIT",
                                             "A planar arm of two joints that makes a slip."};
  std::string slip;

  static constexpr auto fields() {
    using F = hapticd::Fields<SlipsArm>;
    return std::array{F::text("slip", &SlipsArm::slip, "none", "Which slip it makes.")};
  }
  bool is(const char* name) const { return slip == name; }

  void open(hdv_info& info) {
    if (is("absent")) throw std::runtime_error("no arm on the bus");
    info.joint_count = is("info_joints") ? 3 : 2;
    info.capabilities = HDV_C_SIMULATED;
    if (is("claims_pacing")) info.capabilities |= HDV_C_PACING;
    if (is("claims_torque")) info.capabilities |= HDV_C_TORQUE;
    info.rate_hz = is("fast") ? 1e9 : 1000;
    info.max_force = info.continuous_force = 6;
    for (int i = 0; i < 2; ++i) {
      if (is("forgets")) continue;
      info.max_torque[i] = 1;
      info.position_min[i] = -1;
      info.position_max[i] = 1;
    }
    info.buttons = is("buttons") ? 99 : 1;
    if (is("product"))
      std::memset(info.product, 'x', sizeof info.product);
    else
      std::strcpy(info.product, "slips");
  }
  void start(const hdv_start& how) {
    start_ns_ = how.time_ns;
    room_.assign(4, 0.0);
  }
  hsp_status read(uint64_t now_ns, hdv_sample& sample) noexcept HSP_RT {
    sample.time_ns = is("read_microseconds") ? now_ns / 1000 : now_ns;
    sample.sequence = is("sequence") ? 1 : ++sequence_;
    sample.flags = HDV_S_CALIBRATED;
    const bool later = now_ns > start_ns_ + 1'000'000'000;
    sample.position[0] = pushed_;
    if (!later) return HSP_OK;
    if (is("read_nan")) sample.position[1] = std::nan("");
    if (is("read_beyond"))
      for (int k = 0; k < beyond_; ++k) sample.torque[k] = 7;
    if (is("read_heap"))
      for (int k = 0; k < beyond_; ++k) room_.data()[k] = 1e300;
    if (is("read_allocates")) room_ = std::vector<double>(1000 + sequence_);
    if (is("read_prints")) std::printf("read\n");
    if (is("read_sleeps")) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (is("read_stalls") && stalls_-- == 100) std::this_thread::sleep_for(std::chrono::seconds(1));
    if (is("read_hangs")) std::this_thread::sleep_for(std::chrono::seconds(100));
    if (is("read_crashes")) std::raise(SIGSEGV);
    if (is("read_status")) return HSP_E_IO;
    return HSP_OK;
  }
  hsp_status write(uint64_t, const hdv_command& command) noexcept HSP_RT {
    if (is("off_pushes")) pushed_ += 1e-4 * command.torque[0];
    return HSP_OK;
  }
  void stop() {
    if (is("stop_hangs")) std::this_thread::sleep_for(std::chrono::seconds(100));
  }

  const void* extension(const char* name) {
    if (std::strcmp(name, HDV_EXT_CUT) == 0) return &kCut;
    if (std::strcmp(name, HDV_EXT_KINEMATICS) != 0) return nullptr;
    table_ = {sizeof(hdv_ext_kinematics), is("no_joints") ? 0u : 2u, &forward, &jacobian, &gravity, &inverse};
    if (is("no_jacobian")) table_.jacobian = nullptr;
    return &table_;
  }

 private:
  static constexpr double kUpper = 0.15, kLower = 0.13;  // m
  static const SlipsArm& self(const hdv_device* device) { return *reinterpret_cast<const SlipsArm*>(device); }

  static hsp_status forward(const hdv_device* device, const double* q, double* p, double* turn) noexcept HSP_RT {
    const SlipsArm& me = self(device);
    const double a = q[0], b = q[0] + q[1], size = me.is("far") ? 1e4 : 1;
    p[0] = size * (kUpper * std::cos(a) + kLower * std::cos(b));
    p[1] = size * (kUpper * std::sin(a) + kLower * std::sin(b));
    p[2] = 0;
    turn[0] = std::cos(b / 2), turn[1] = turn[2] = 0, turn[3] = std::sin(b / 2);
    if (me.is("orientation_0")) turn[0] = turn[3] = 0;
    if (me.is("forward_nan_aside") && q[0] < 0) p[0] = std::nan("");
    if (me.is("forward_nan")) p[1] = std::nan("");
    if (me.is("forward_nan_at_stop") && q[0] > 0.7) p[1] = std::nan("");
    return me.is("forward_status") ? HSP_E_NUMERIC : HSP_OK;
  }
  static hsp_status jacobian(const hdv_device* device, const double* q, double* J) noexcept HSP_RT {
    const SlipsArm& me = self(device);
    const double a = q[0], b = q[0] + q[1], sign = me.is("jacobian_sign") ? -1 : 1;
    std::fill_n(J, me.is("jacobian_beyond") ? 200 : 12, 0.0);
    J[0] = sign * (-kUpper * std::sin(a) - kLower * std::sin(b)), J[1] = -sign * kLower * std::sin(b);
    J[2] = sign * (kUpper * std::cos(a) + kLower * std::cos(b)), J[3] = sign * kLower * std::cos(b);
    J[10] = J[11] = me.is("no_angular_rows") ? 0 : 1;
    if (me.is("jacobian_crash")) *static_cast<volatile int*>(nullptr) = 1;
    if (me.is("jacobian_hangs")) std::this_thread::sleep_for(std::chrono::seconds(100));
    return me.is("jacobian_status") ? HSP_E_NUMERIC : HSP_OK;
  }
  static hsp_status gravity(const hdv_device* device, const double* q, const double* g, double* tau) noexcept HSP_RT {
    const SlipsArm& me = self(device);
    const bool right = me.is("weight_right") || me.is("weight_aside");
    const double kg = me.is("weight_pulls") ? -0.3 : me.is("weight_in_grams") ? 300 : right ? 0.3 : 0;
    double J[12];
    jacobian(device, q, J);
    const bool aside = me.is("weight_aside");
    for (int i = 0; i < 2; ++i)
      tau[i] = -kg * (J[i] * g[aside ? 1 : 0] + J[2 + i] * g[aside ? 0 : 1] + J[4 + i] * g[2]);
    if (me.is("weight") || me.is("weight_nan")) tau[0] = tau[1] = me.is("weight") ? 50 : std::nan("");
    return HSP_OK;
  }
  static hsp_status inverse(const hdv_device* device, const double* p, double* q) noexcept HSP_RT {
    const SlipsArm& me = self(device);
    const double c = (p[0] * p[0] + p[1] * p[1] - kUpper * kUpper - kLower * kLower) / (2 * kUpper * kLower);
    if (me.is("inverse_nan")) return q[0] = std::nan(""), HSP_OK;
    if (me.is("inverse_refuses")) return HSP_E_NUMERIC;
    if (!(std::abs(c) <= 1)) return me.is("inverse_anywhere") ? HSP_OK : HSP_E_NUMERIC;
    const double s = std::sqrt(1 - c * c);
    q[1] = std::atan2(s, c);
    q[0] = std::atan2(p[1], p[0]) - std::atan2(kLower * s, kUpper + kLower * c);
    if (me.is("inverse_mirrored")) q[0] = -q[0];
    return HSP_OK;
  }
  static void cut(hdv_device*) noexcept HSP_RT {}
  static constexpr hdv_ext_cut kCut = {sizeof(hdv_ext_cut), 0, &cut};

  hdv_ext_kinematics table_{};
  std::vector<double> room_;
  double pushed_ = 0;
  int stalls_ = 200;
  volatile int beyond_ = 60;
  uint64_t start_ns_ = 0, sequence_ = 0;
};

}  // namespace

HAPTICD_DEVICES(SlipsArm)
