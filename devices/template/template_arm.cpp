// SPDX-License-Identifier: MIT
/// A gantry: the smallest complete device module. Copy the folder, give it a name, and replace board.hpp with code for
/// your hardware.
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstring>

#include "board.hpp"
#include "hapticd/device.hpp"

namespace template_arm {
namespace {

class TemplateArm : public hapticd::Device {
 public:
  static constexpr hapticd::DeviceInfo kInfo{
      "org.hapticd.device.template_arm", "template_arm", "0.1.0", "MIT",
      "A simulated gantry with three motors: a template for new device modules."};
  double reach = 0, force = 0, mass = 0;

  static constexpr auto fields() {
    using F = hapticd::Fields<TemplateArm>;
    return std::array{
        F::real("reach", &TemplateArm::reach, "m", 0.01, 1, 0.15, "Travel of each axis to either side of its middle."),
        F::real("force", &TemplateArm::force, "N", 0.1, 100, 10, "Largest force of each motor."),
        F::real("mass", &TemplateArm::mass, "kg", 0.01, 10, 0.15, "Mass of the carriage."),
    };
  }

  /// Finds the hardware and describes it. It may block, and may throw a std::exception with a message for the user.
  void open(hdv_info& info) {
    info.joint_count = 3;
    // A real arm does not claim HDV_C_SIMULATED. It claims HDV_C_UNVERIFIED until somebody has tried it, HDV_C_WATCHDOG
    // if its hardware cuts the motors when commands stop, and HDV_C_CALIBRATION if the zero of its encoders is unknown.
    info.capabilities = HDV_C_SIMULATED;
    info.rate_hz = 1000;
    info.max_force = info.continuous_force = force;
    info.max_stiffness = 2000;
    info.resolution_m = Board::kEncoderStep;
    info.damping = Board::kFriction;
    info.mass_kg = mass;
    for (int i = 0; i < 3; ++i) {
      info.max_torque[i] = force;
      info.position_min[i] = -reach;
      info.position_max[i] = reach;
    }
    std::snprintf(info.product, sizeof info.product, "template gantry");
  }

  /// May allocate. A module with an I/O thread starts the thread here and waits for the first sample.
  void start(const hdv_start& how) {
    board_.start(how.time_ns, mass, {how.gravity[0], how.gravity[1], how.gravity[2]});
    cut_ = false;
    now_ns_ = 0;
  }

  /// Called in every tick: returns the newest sample and never waits. A real module sets HDV_S_LOST while the hardware
  /// is gone, and HDV_S_FAULT while it reports a fault. It returns the same sequence number while there is no new
  /// sample.
  hsp_status read(uint64_t now_ns, hdv_sample& sample) noexcept HSP_RT {
    if (cut_.load(std::memory_order_relaxed)) board_.send({});
    if (now_ns > now_ns_) ++sequence_;
    now_ns_ = now_ns;
    const Vec3 position = board_.receive(now_ns);
    std::copy(position.begin(), position.end(), sample.position);
    sample.time_ns = now_ns;
    sample.sequence = sequence_;
    sample.flags = HDV_S_CALIBRATED;
    sample.buttons = 0;
    return HSP_OK;
  }

  /// Called in every tick: takes the newest command. It limits the command again, although the host has limited it.
  hsp_status write(uint64_t, const hdv_command& command) noexcept HSP_RT {
    if (command.mode == HDV_OFF) cut_.store(false, std::memory_order_relaxed);
    const bool off = command.mode != HDV_TORQUE || cut_.load(std::memory_order_relaxed);
    Vec3 motors{};
    for (int i = 0; i < 3; ++i)
      if (!off && std::isfinite(command.torque[i])) motors[i] = std::clamp(command.torque[i], -force, force);
    board_.send(motors);
    return HSP_OK;
  }

  void stop() { board_.send({}); }

  const void* extension(const char* name) {
    if (std::strcmp(name, HDV_EXT_KINEMATICS) == 0) return &kKinematics;
    if (std::strcmp(name, HDV_EXT_CUT) == 0) return &kCut;
    return nullptr;
  }

 private:
  static TemplateArm& self(hdv_device* device) { return *reinterpret_cast<TemplateArm*>(device); }
  static const TemplateArm& self(const hdv_device* device) { return *reinterpret_cast<const TemplateArm*>(device); }

  /// The joints of a gantry are the coordinates of its tip; the orientation never changes.
  static hsp_status forward(const hdv_device*, const double* q, double position[3],
                            double orientation[4]) noexcept HSP_RT {
    std::copy(q, q + 3, position);
    orientation[0] = 1;
    orientation[1] = orientation[2] = orientation[3] = 0;
    return HSP_OK;
  }
  /// J[row * 3 + joint]: rows 0 to 2 are the velocity of the tip, rows 3 to 5 its angular velocity.
  static hsp_status jacobian(const hdv_device*, const double*, double* J) noexcept HSP_RT {
    std::fill(J, J + 18, 0.0);
    for (int i = 0; i < 3; ++i) J[i * 3 + i] = 1;
    return HSP_OK;
  }
  /// Motor forces that carry the carriage's weight.
  static hsp_status weight(const hdv_device* device, const double*, const double gravity[3],
                           double* tau) noexcept HSP_RT {
    for (int i = 0; i < 3; ++i) tau[i] = -self(device).mass * gravity[i];
    return HSP_OK;
  }
  static hsp_status inverse(const hdv_device* device, const double position[3], double* q) noexcept HSP_RT {
    for (int i = 0; i < 3; ++i)
      if (!(std::fabs(position[i]) <= self(device).reach)) return HSP_E_NUMERIC;
    std::copy(position, position + 3, q);
    return HSP_OK;
  }
  /// May be called from any thread, even in a signal handler, for example by the watchdog. The motors stay off until a
  /// command says HDV_OFF.
  static void cut(hdv_device* device) noexcept HSP_RT { self(device).cut_.store(true, std::memory_order_relaxed); }

  static constexpr hdv_ext_kinematics kKinematics = {
      sizeof(hdv_ext_kinematics), 3, &forward, &jacobian, &weight, &inverse};
  static constexpr hdv_ext_cut kCut = {sizeof(hdv_ext_cut), 0, &cut};

  Board board_;
  std::atomic<bool> cut_{false};
  uint64_t now_ns_ = 0, sequence_ = 0;
};

}  // namespace
}  // namespace template_arm

HAPTICD_DEVICES(template_arm::TemplateArm)
