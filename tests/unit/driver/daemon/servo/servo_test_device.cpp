// SPDX-License-Identifier: MIT
/// A gantry of three sliding joints for the tests of the loop: it presses into y < 0, and fails when it is told to.
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>

#include "hapticd/device.hpp"

namespace {

using hapticd::Fields;

/// What the arm was told and asked, for the test to read (the module is loaded into the test's own process).
struct Log {
  double force[3];
  uint32_t mode;
  int reads, writes;
  bool only_numbers = true;
  std::atomic<int> hold;  ///< the test's: 1 keeps the next write inside the module, which makes it 2, until it is 0
};

struct Gantry : hapticd::Device {
  double depth, fail_at, well_at, speed, own_rate;
  int failure, every;
  bool hardware;
  Log log{};
  static constexpr const char* kFailures[] = {"none",         "lost",        "not_finite", "stale", "fault",
                                              "uncalibrated", "random",      "moves",      "jumps", "released",
                                              "gravity",      "orientation", "jacobian"};
  static constexpr hapticd::DeviceInfo kInfo{"org.hapticd.test.gantry", "gantry", "1.0.0", "MIT", "A gantry."};
  static constexpr auto fields() {
    using F = Fields<Gantry>;
    return std::array{
        F::real("depth", &Gantry::depth, "m", -1, 1, 0.002, "Depth below y = 0."),
        F::real("fail_at", &Gantry::fail_at, "s", 0, 1e9, 0.05, "When it fails."),
        F::choice("failure", &Gantry::failure, kFailures, 0, "How it fails."),
        F::real("well_at", &Gantry::well_at, "s", 0, 1e9, 1e9, "When it is well again."),
        F::boolean("hardware", &Gantry::hardware, false, "It says that it is no simulation."),
        F::real("speed", &Gantry::speed, "m/s", 0, 100, 0, "Along x, once it fails by moving, or is well again."),
        F::integer("every", &Gantry::every, "", 1, 1000, 1, "Only so many reads have a new sample."),
        F::real("own_rate", &Gantry::own_rate, "Hz", 0, 1e5, 0, "Of its measurements; 0: of read().")};
  }

  void open(hdv_info& info) {
    info.joint_count = 3;
    info.rate_hz = 1000;
    info.max_force = 8.5;
    info.buttons = 1;
    info.capabilities = (hardware ? 0u : static_cast<uint32_t>(HDV_C_SIMULATED)) |
                        (failure == 5 ? static_cast<uint32_t>(HDV_C_CALIBRATION) : 0u);
  }
  void start(const hdv_start& how) { start_ns_ = how.time_ns; }
  hsp_status read(uint64_t now_ns, hdv_sample& sample) noexcept HSP_RT {
    if (log.reads % every != 0) {  // the sample is as the last one
      ++log.reads;
      return HSP_OK;
    }
    double t = static_cast<double>(now_ns - start_ns_) * 1e-9;
    if (own_rate > 0 && !measures(t, sample)) return HSP_OK;
    const bool failed = t >= fail_at && t < well_at;
    bad_gravity_ = failed && failure == 10;
    bad_orientation_ = failed && failure == 11;
    bad_jacobian_ = failed && failure == 12;
    sample.position[0] = 0;
    sample.position[1] = -depth;
    sample.flags = failure == 5 && t < well_at ? 0u : static_cast<uint32_t>(HDV_S_CALIBRATED);
    if (failed && failure == 1) return HSP_E_IO;
    if (failure == 1 && t >= well_at) sample.position[0] = speed * (t - well_at);
    if (failed && failure == 2) sample.position[0] = std::numeric_limits<double>::quiet_NaN();
    if (failed && failure == 4) sample.flags |= HDV_S_FAULT;
    if (failed && failure == 7) sample.position[0] = speed * (t - fail_at);
    if (failed && failure == 8) sample.position[0] = 0.3;
    sample.buttons = failure == 9 && (failed || t == 0) ? 0 : 1;  // a switch is not found pressed
    if (failure == 6) return failAtRandom(sample);
    if (!failed || failure != 3) ++sample.sequence;
    ++log.reads;
    return HSP_OK;
  }
  /// Gives the last measurement before a time [s] its stamp. Returns false if an earlier read has seen it.
  bool measures(double& t, hdv_sample& sample) noexcept HSP_RT {
    const double before = measured_;
    t = measured_ = std::floor(t * own_rate) / own_rate;
    sample.time_ns = start_ns_ + 1 + static_cast<uint64_t>(std::llround(1e9 * t));
    return measured_ > before;
  }
  /// Once in a thousand reads something goes wrong, for up to 80 reads.
  hsp_status failAtRandom(hdv_sample& sample) noexcept HSP_RT {
    random_ = random_ * 6364136223846793005u + 1442695040888963407u;
    const uint64_t dice = random_ >> 33;
    sample.flags = HDV_S_CALIBRATED;
    ++log.reads;
    if (bad_left_ == 0 && dice % 1000 == 0) {
      bad_left_ = 1 + static_cast<int>(dice / 1000 % 80);
      bad_ = static_cast<int>(dice / 80000 % 5);
    }
    if (bad_left_ == 0 || bad_ != 2) ++sample.sequence;
    if (bad_left_ == 0) return HSP_OK;
    --bad_left_;
    if (bad_ == 0) return HSP_E_IO;
    if (bad_ == 1) sample.position[0] = std::numeric_limits<double>::quiet_NaN();
    if (bad_ == 3) sample.flags |= HDV_S_FAULT;
    if (bad_ == 4) sample.position[0] = 0.3;
    return HSP_OK;
  }
  hsp_status write(uint64_t, const hdv_command& command) noexcept HSP_RT {
    std::memcpy(log.force, command.torque, sizeof log.force);
    log.mode = command.mode;
    for (const double torque : log.force) log.only_numbers &= std::isfinite(torque);
    ++log.writes;
    int asked = 1;
    if (log.hold.compare_exchange_strong(asked, 2))
      while (log.hold.load() == 2) {
      }
    return HSP_OK;
  }
  const void* extension(const char* name) {
    if (std::strcmp(name, "test.log") == 0) return &log;
    return std::strcmp(name, HDV_EXT_KINEMATICS) == 0 ? &kKinematics : nullptr;
  }

  static const Gantry& of(const hdv_device* device) { return *reinterpret_cast<const Gantry*>(device); }
  static hsp_status forward(const hdv_device* device, const double* q, double position[3],
                            double orientation[4]) noexcept HSP_RT {
    for (int i = 0; i < 3; ++i) position[i] = q[i];
    orientation[0] = of(device).bad_orientation_ ? std::numeric_limits<double>::quiet_NaN() : 1;
    orientation[1] = orientation[2] = orientation[3] = 0;
    return HSP_OK;
  }
  static hsp_status jacobian(const hdv_device* device, const double*, double* J) noexcept HSP_RT {
    for (int i = 0; i < 18; ++i) J[i] = i % 4 == 0 && i < 9 ? 1 : 0;
    if (of(device).bad_jacobian_) J[5] = std::numeric_limits<double>::quiet_NaN();
    return HSP_OK;
  }
  static hsp_status gravity(const hdv_device* device, const double*, const double*, double* torque) noexcept HSP_RT {
    if (!of(device).bad_gravity_) return HSP_E_UNSUPPORTED;
    torque[1] = std::numeric_limits<double>::quiet_NaN();
    return HSP_OK;
  }
  static hsp_status inverse(const hdv_device*, const double position[3], double* q) noexcept HSP_RT {
    for (int i = 0; i < 3; ++i) q[i] = position[i];
    return HSP_OK;
  }
  static constexpr hdv_ext_kinematics kKinematics{
      sizeof(hdv_ext_kinematics), 3, &forward, &jacobian, &gravity, &inverse};

 private:
  uint64_t start_ns_ = 0, random_ = 1;
  double measured_ = -1;  // [s] time of the last measurement
  int bad_left_ = 0, bad_ = 0;
  bool bad_gravity_ = false, bad_orientation_ = false, bad_jacobian_ = false;
};

}  // namespace

HAPTICD_DEVICES(Gantry)
