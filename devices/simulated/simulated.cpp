// SPDX-License-Identifier: MIT
/// The device module `simulated`: an arm simulated at torque level, and the hand that holds it. Time is the argument of
/// its functions, so it reads no clock.
#include <atomic>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "hapticd/device_pace.h"
#include "kinematics/extension.hpp"
#include "simulated/nearest_place.hpp"
#include "simulated/parameter_table.hpp"

namespace hapticd::simulated {
namespace {

using Eigen::Vector3d;

/// Most substeps in one read (1 s at the default substep). The rest of a longer gap is left out.
constexpr int kMaxSubsteps = 5000;

class SimulatedArm : public Device, public Parameters {
 public:
  static constexpr DeviceInfo kInfo{"org.hapticd.device.simulated", "simulated", "1.0.0", "MIT",
                                    "An arm simulated at torque level (PHANToM Premium 1.5, an arm built like it, a "
                                    "delta, or any serial chain), and the hand that holds it."};
  static constexpr auto fields() {
    using Table = ParameterTable<SimulatedArm>;
    return join(Table::arm(), Table::device(), Table::joint(), Table::hand());
  }

  void given(const char* id) {
    if (std::strcmp(id, "device.continuous_force") == 0) force_stated_ = true;
  }

  void open(hdv_info& info) {
    arm_ = makeArm(*this);
    joints_ = jointsOf(*this, arm_->jointCount());
    makePlant(*this, joints_, Vector3d::Zero());  // only to report wrong parameters now instead of in start()
    hand_ = std::make_unique<Hand>(handOf(*this), path.empty() ? HandPath{} : HandPath::read(path));
    describe(info);
  }

  void start(const hdv_start& how) {
    plant_ = makePlant(*this, joints_, Vector3d(how.gravity[0], how.gravity[1], how.gravity[2]));
    start_ns_ = now_ns_ = how.time_ns;
    sequence_ = 0;
    noise_ = static_cast<uint64_t>(seed);
    written_ = 0;
    cut_ = false;
    written_ns_ = how.time_ns;
    const JointVector off = JointVector::Zero(arm_->jointCount());
    drives_.fill({false, off, off, off});
    target_ = hand_->at(0);
    JointVector q = arm_->neutral().cwiseMax(arm_->limits().min).cwiseMin(arm_->limits().max);
    if (hand_->holds() && !arm_->inverse(target_.position, q)) throw std::invalid_argument(unreachable());
    plant_->reset(q);
  }

  hsp_status read(uint64_t now_ns, hdv_sample& sample) noexcept HSP_RT {
    if (now_ns > now_ns_ || sequence_ == 0) ++sequence_;
    if (now_ns > now_ns_) advance(now_ns);
    sample.time_ns = now_ns_;
    sample.sequence = sequence_;
    sample.flags = HDV_S_CALIBRATED | (torque_sensors ? uint32_t{HDV_S_TORQUE} : 0u);
    if (isWithin(unplugged)) sample.flags |= HDV_S_LOST;
    sample.buttons = isWithin(pressed) ? 1 : 0;
    const JointVector q = plant_->position(), tau = plant_->transmitted();
    for (int i = 0; i < q.size(); ++i) {
      const double step = joints_.step[i];
      sample.position[i] = step > 0 ? std::round(q[i] / step) * step : q[i];
      sample.torque[i] = torque_sensors ? tau[i] + torque_noise * noise() : 0;
    }
    return HSP_OK;
  }

  hsp_status write(uint64_t now_ns, const hdv_command& command) noexcept HSP_RT {
    const Drive& last = drives_[written_ % drives_.size()];
    Drive& drive = drives_[++written_ % drives_.size()];
    const bool follows = last.position_mode && now_ns > written_ns_;  // if not, the reference has no velocity yet
    const double since = static_cast<double>(now_ns - written_ns_) * 1e-9;
    written_ns_ = now_ns;
    if (command.mode == HDV_OFF) cut_.store(false);
    drive.position_mode = command.mode == HDV_POSITION && joints_.stiffness.size() > 0;
    for (int i = 0; i < arm_->jointCount(); ++i) {
      const bool on = command.mode != HDV_OFF && std::isfinite(command.torque[i]);
      drive.torque[i] = on ? std::clamp(command.torque[i], -joints_.max_torque[i], joints_.max_torque[i]) : 0;
      drive.reference[i] = command.position[i];
      drive.reference_rate[i] = follows ? (drive.reference[i] - last.reference[i]) / since : 0;
      drive.position_mode = drive.position_mode && std::isfinite(command.position[i]);
    }
    return HSP_OK;
  }

  const void* extension(const char* name) {
    if (std::strcmp(name, HDV_EXT_HAND) == 0) return &kHand;
    if (std::strcmp(name, HDV_EXT_CUT) == 0) return &kCut;
    if (std::strcmp(name, HDV_EXT_PACE) == 0) return &kPace;
    const bool links = std::strcmp(name, HDV_EXT_LINKS) == 0;
    if (!links && std::strcmp(name, HDV_EXT_KINEMATICS) != 0) return nullptr;
    if (links && arm_ == nullptr) return nullptr;  // the host asks for the kinematics before it opens the device
    try {
      if (links) {
        links_ = kinematics::Extension<SimulatedArm>::linksOf(*arm_);
        return &links_;
      }
      arm_ = makeArm(*this);
      extension_ = kinematics::Extension<SimulatedArm>::of(*arm_);
      return &extension_;
    } catch (const std::exception& e) {
      writeLog(HSP_LOG_ERROR, e.what());
      return nullptr;
    }
  }

  const kinematics::Arm& kinematics() const { return *arm_; }

 private:
  static SimulatedArm& self(hdv_device* device) { return *reinterpret_cast<SimulatedArm*>(device); }
  static hsp_status guide(hdv_device* device, const double position[3], const double velocity[3],
                          const double force[3]) noexcept HSP_RT {
    if (guided(device) == 0) return HSP_E_STATE;
    const HandTarget target{Vector3d(position), Vector3d(velocity), Vector3d(force)};
    if (!target.position.allFinite() || !target.velocity.allFinite() || !target.force.allFinite()) return HSP_E_ARG;
    self(device).hand_->guide(target);
    return HSP_OK;
  }
  static hsp_status truth(hdv_device* device, double position[3], double velocity[3], double force[3]) noexcept HSP_RT {
    const Plant* plant = self(device).plant_.get();
    if (plant == nullptr) return HSP_E_STATE;
    Eigen::Map<Vector3d>(position, 3) = plant->tip();
    Eigen::Map<Vector3d>(velocity, 3) = plant->tipVelocity();
    Eigen::Map<Vector3d>(force, 3) = plant->handForce();
    return HSP_OK;
  }
  static int32_t guided(const hdv_device* device) noexcept HSP_RT {
    const Hand* hand = reinterpret_cast<const SimulatedArm*>(device)->hand_.get();
    return hand != nullptr && hand->settings().script == Script::kGuided ? 1 : 0;
  }
  static void cut(hdv_device* device) noexcept HSP_RT { self(device).cut_.store(true); }
  static uint64_t nextSample(hdv_device* device, uint64_t until_ns) noexcept {
    const SimulatedArm& arm = self(device);
    if (arm.sequence_ == 0) return std::min(until_ns, arm.now_ns_);
    const auto period = static_cast<uint64_t>(std::llround(1e9 / arm.rate));
    // Samples are counted from the start, so that a late read does not delay the next sample.
    const uint64_t samples = (arm.now_ns_ - arm.start_ns_) / period + 1;
    return std::min(until_ns, arm.start_ns_ + samples * period);
  }
  static constexpr hdv_ext_pace kPace = {sizeof(hdv_ext_pace), 0, &nextSample};
  static constexpr hdv_ext_cut kCut = {sizeof(hdv_ext_cut), 0, &cut};
  static constexpr hdv_ext_hand kHand = {sizeof(hdv_ext_hand), 0, &guide, &truth, &guided};

  /// Returns whether the arm is now within one of some times. @param times [s] since the start: begin, end, ...
  bool isWithin(const std::vector<double>& times) const noexcept HSP_RT {
    const double t = static_cast<double>(now_ns_ - start_ns_) * 1e-9;
    for (size_t i = 0; i + 1 < times.size(); i += 2)
      if (t >= times[i] && t < times[i + 1]) return true;
    return false;
  }

  /// Fills in the description of the arm. Its resolution and damping follow from its kinematics at the neutral pose.
  void describe(hdv_info& info) const {
    const int count = arm_->jointCount();
    info.joint_count = static_cast<uint32_t>(count);
    info.capabilities = HDV_C_SIMULATED | HDV_C_PACING | (torque_sensors ? uint32_t{HDV_C_TORQUE} : 0u) |
                        (joints_.stiffness.size() > 0 ? uint32_t{HDV_C_POSITION} : 0u);
    // the default is what the motors of a Premium 1.5 sustain
    if (arm() != Kind::kPremium15 && !force_stated_) info.capabilities |= HDV_C_FORCE_ASSUMED;
    info.rate_hz = rate;
    info.buttons = pressed.empty() ? 0 : 1;
    info.max_force = max_force;
    info.continuous_force = continuous_force;
    info.max_stiffness = max_stiffness;
    info.mass_kg = felt_mass;
    for (int i = 0; i < count; ++i) {
      info.max_torque[i] = joints_.max_torque[i];
      info.position_min[i] = arm_->limits().min[i];
      info.position_max[i] = arm_->limits().max[i];
    }
    kinematics::Jacobian J;
    if (arm_->jacobian(arm_->neutral(), J)) {
      double least = HUGE_VAL;
      for (int i = 0; i < count; ++i) {
        const double lever = J.col(i).head<3>().norm();
        info.resolution_m = std::max(info.resolution_m, joints_.step[i] * lever);
        if (lever > 1e-6) least = std::min(least, joints_.damping[i] / (lever * lever));
      }
      info.damping = std::isfinite(least) ? least : 0;
    }
    std::snprintf(info.product, sizeof info.product, "simulated %s",
                  arm() == Kind::kPremium15 ? "PHANToM Premium 1.5"
                  : arm() == Kind::kPhantom ? "arm like the PHANToM"
                  : arm() == Kind::kDelta   ? "delta"
                                            : "serial arm");
    std::snprintf(info.serial, sizeof info.serial, "seed %d", seed);
  }

  /// Says why the hand cannot start. For a path, the text begins with the file and the line of its first row.
  std::string unreachable() const {
    const Vector3d& p = target_.position;
    const auto text = [](const char* format, const Vector3d& v) {
      char all[160];
      std::snprintf(all, sizeof all, format, v.x(), v.y(), v.z());
      return std::string(all);
    };
    const bool follows = hand_->settings().script == Script::kPath;
    std::string told = follows ? hand_->path().firstPlace() + ": x: " : "";
    told += text("the hand starts at (%.3f, %.3f, %.3f) m in the device frame, which the arm cannot reach", p);
    constexpr double kFar = 2;  // [m] no arm of the kinds that are simulated reaches so far
    if (JointVector q = arm_->neutral(); p.norm() > kFar && arm_->inverse(1e-3 * p, q))
      return told + text("; is it in mm? It must be in m: [%.4g, %.4g, %.4g]", 1e-3 * p);
    if (const auto near = nearestPlace(*arm_, p))
      told += text("; the nearest place that it reaches is [%.3f, %.3f, %.3f]", *near);
    return told + (follows ? "; expected rows within its workspace (hapticd device info)"
                           : "; expected a script within its workspace: see hand.center, arm.limits and the mount of "
                             "the device file");
  }

  void advance(uint64_t now_ns) noexcept {
    const double seconds = static_cast<double>(now_ns - now_ns_) * 1e-9;
    const double wanted = std::ceil(seconds / substep * (1 - 1e-9));
    const int steps = static_cast<int>(std::clamp(wanted, 1.0, double{kMaxSubsteps}));
    const double h = std::min(seconds / steps, substep);
    const HandTarget before = target_;
    target_ = hand_->at(static_cast<double>(now_ns - start_ns_) * 1e-9);
    now_ns_ = now_ns;
    const auto late = static_cast<uint64_t>(delay);
    Drive drive = drives_[(written_ + drives_.size() - late) % drives_.size()];
    if (cut_.load() || isWithin(unplugged)) {
      drive.position_mode = false;
      drive.torque.setZero();
    }
    const bool holds = hand_->holds();
    HandCoupling pull;
    pull.stiffness = holds ? hand_->settings().stiffness : 0;
    pull.damping = holds ? hand_->settings().damping : 0;
    for (int i = 0; i < steps; ++i) {
      const double s = (i + 1.0) / steps;
      pull.target = before.position + s * (target_.position - before.position);
      pull.velocity = before.velocity + s * (target_.velocity - before.velocity);
      pull.force = holds ? Vector3d(before.force + s * (target_.force - before.force)) : Vector3d::Zero();
      plant_->step(h, drive, pull);
    }
  }

  /// Noise of unit variance. A sum of uniform random numbers is close enough to a normal distribution for a sensor.
  double noise() noexcept {
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
      noise_ = noise_ * 6364136223846793005u + 1442695040888963407u;
      sum += static_cast<double>(noise_ >> 11) * 0x1p-53 - 0.5;
    }
    return sum * std::sqrt(3.0);
  }

  std::unique_ptr<kinematics::Arm> arm_;
  std::unique_ptr<Plant> plant_;
  std::unique_ptr<Hand> hand_;
  hdv_ext_kinematics extension_{};
  hdv_ext_links links_{};
  bool force_stated_ = false;  ///< the device file gives device.continuous_force
  JointSettings joints_;
  HandTarget target_;
  std::array<Drive, kMaxDelay + 1> drives_;  ///< the newest drive is at index written_
  std::atomic<bool> cut_{false};             ///< the watchdog cut the motors; a write of HDV_OFF ends the cut
  uint64_t written_ = 0, written_ns_ = 0, start_ns_ = 0, now_ns_ = 0, sequence_ = 0, noise_ = 1;
};

}  // namespace
}  // namespace hapticd::simulated

HAPTICD_DEVICES(hapticd::simulated::SimulatedArm)
