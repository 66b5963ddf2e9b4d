// SPDX-License-Identifier: MIT
/// The device class for an arm that exchanges reports over a bus (USB, VME): kinematics, samples, calibration.
#pragma once
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "hapticd/device.hpp"
#include "hapticd/device_capture.h"
#include "hapticd/device_pace.h"
#include "hapticd/device_silence.h"
#include "hapticd/device_trouble.h"
#include "kinematics/error_collector.hpp"
#include "kinematics/extension.hpp"
#include "wire_arm/calibration.hpp"
#include "wire_arm/falcon_loader.hpp"
#include "wire_arm/link.hpp"
#include "wire_arm/mechanism.hpp"
#include "wire_arm/parameters.hpp"

namespace hapticd::wire_arm {

/// The base class of these devices. A derived class T adds kInfo, fields() and `std::unique_ptr<Transport>
/// makeTransport() const`, and may replace address().
template <class T>
class Arm : public Device, public Parameters {
 public:
  void open(hdv_info& info) {
    prepare();
    SessionSettings session;
    session.joints = joints();
    session.calibration = static_cast<Calibration>(method);
    session.health.stale = stale, session.health.least_rate = least_rate, session.health.recovery = recovery;
    session.health.ramp = ramp, session.health.max_speed = max_speed;
    LinkSettings settings;
    settings.address = static_cast<const T*>(this)->address();
    settings.session = session;
    settings.log = [this](int level, const std::string& text) { writeLog(level, text); };
    const Address address = settings.address;
    if (session.calibration == Calibration::kPose)
      settings.zero = [address, count = joints()](const Identity& identity) {
        return loadZero(stateFolder(), address, identity, count);
      };
    if (loader == 1) settings.prepare = [this](Transport& to) { return loadFalcon(to, wire_, image_); };
    link_ = std::make_unique<Link>(static_cast<T*>(this)->makeTransport(), wire_, std::move(settings));
    auto opened = link_->open();
    if (!opened) throw std::runtime_error(opened.error());
    describe(info, *opened);
  }

  void start(const hdv_start&) {
    if (auto started = link_->start(); !started) throw std::runtime_error(started.error());
  }

  hsp_status read(uint64_t now_ns, hdv_sample& to) noexcept HSP_RT {
    constexpr uint64_t kHung = 20'000'000;  // [ns] an older sample means that the I/O thread is stuck
    link_->read(sample_);
    trouble_.store(sample_.trouble, std::memory_order_relaxed);
    to.time_ns = sample_.time;
    to.sequence = sample_.sequence;
    to.buttons = sample_.buttons;
    to.flags = (sample_.calibrated ? uint32_t{HDV_S_CALIBRATED} : 0u) | (velocity_ ? uint32_t{HDV_S_VELOCITY} : 0u) |
               (torque_ ? uint32_t{HDV_S_TORQUE} : 0u);
    // For these two no flag is set: the host itself sees that no new sequence number comes. The motors are off by then,
    // and after a short silence the torque ramps in again.
    const bool silent = sample_.trouble == Trouble::kStale || sample_.trouble == Trouble::kOld;
    if (sample_.trouble == Trouble::kUnplugged || sample_.trouble == Trouble::kAbsent)
      to.flags |= HDV_S_LOST;
    else if (sample_.trouble != Trouble::kNone && !silent)
      to.flags |= HDV_S_FAULT;
    if (now_ns > sample_.time + kHung && sample_.trouble == Trouble::kNone) to.flags |= HDV_S_FAULT;
    for (size_t i = 0; i < HDV_MAX_JOINTS; ++i) {
      to.position[i] = sample_.position[i];
      to.velocity[i] = sample_.velocity[i];
      to.torque[i] = sample_.torque[i];
    }
    return HSP_OK;
  }

  hsp_status write(uint64_t now_ns, const hdv_command& command) noexcept HSP_RT {
    command_.time = now_ns;
    ++command_.sequence;
    command_.follow = command.mode == HDV_POSITION && follows_;
    command_.on = command.mode == HDV_TORQUE || command_.follow;
    const size_t count = joints_;
    for (size_t i = 0; i < count; ++i) {
      const double most = limit_[i], asked = command.torque[i];
      if (!std::isfinite(asked)) command_.on = false;
      command_.torque[i] = std::clamp(std::isfinite(asked) ? asked : 0.0, -most, most);
      if (!command_.follow) continue;
      if (!std::isfinite(command.position[i])) command_.on = false;
      command_.position[i] = command_.on ? std::clamp(command.position[i], least_[i], most_[i]) : 0.0;
    }
    link_->write(command_);
    if (command.mode == HDV_OFF) link_->endCut();  // last, so that the I/O thread sends no command from before the cut
    return HSP_OK;
  }

  void stop() {
    if (link_) link_->stop();
  }
  void close() { link_.reset(); }

  /// The USB address of the device. A class for another bus replaces this function.
  Address address() const { return addressOf(*this); }

  const kinematics::Arm& kinematics() const { return *arm_; }
  const void* extension(const char* name) {
    if (std::string_view(name) == HDV_EXT_KINEMATICS) {
      try {
        prepare();
      } catch (const std::exception& e) {
        writeLog(HSP_LOG_ERROR, e.what());
        return nullptr;
      }
      kinematics_ = kinematics::Extension<T>::of(*arm_);
      return &kinematics_;
    }
    if (std::string_view(name) == HDV_EXT_LINKS && arm_ != nullptr) {
      links_ = kinematics::Extension<T>::linksOf(*arm_);
      return &links_;
    }
    if (std::string_view(name) == HDV_EXT_CALIBRATION && method != 0) {
      calibration_ = {sizeof calibration_, 0, instructions.c_str(), &calibrate};
      return &calibration_;
    }
    return constantExtension(name);
  }

 protected:
  const codec::Wire& format() const { return wire_; }  ///< valid after the parameters were read

 private:
  /// Returns an extension that is the same for all arms of this class; null if it is none of them.
  static const void* constantExtension(const char* name) {
    if (std::string_view(name) == HDV_EXT_CUT) {
      static constexpr hdv_ext_cut kCut{sizeof(hdv_ext_cut), 0, &cut};
      return &kCut;
    }
    if (std::string_view(name) == HDV_EXT_SILENCE) {
      static constexpr hdv_ext_silence kSilence{sizeof(hdv_ext_silence), 0, &cutLeft, &silence};
      return &kSilence;
    }
    if (std::string_view(name) == HDV_EXT_PACE) {
      static constexpr hdv_ext_pace kPace{sizeof(hdv_ext_pace), 0, &waitForSample};
      return &kPace;
    }
    if (std::string_view(name) == HDV_EXT_CAPTURE) {
      static constexpr hdv_ext_capture kCapture{sizeof(hdv_ext_capture), 0, &capture};
      return &kCapture;
    }
    if (std::string_view(name) == HDV_EXT_TROUBLE) {
      static constexpr hdv_ext_trouble kTrouble{sizeof(hdv_ext_trouble), 0, &why};
      return &kTrouble;
    }
    return nullptr;
  }

  size_t joints() const { return static_cast<size_t>(arm_->jointCount()); }

  /// Makes everything that depends only on the parameters. Throws std::invalid_argument with all problems, one per
  /// line.
  void prepare() {
    kinematics::ErrorCollector wrong;
    joints_ = jointsOf(*this);  // also if the mechanism is wrong otherwise
    wrong.attempt([&] { arm_ = makeMechanism(*this); });
    bool wire_known = false;
    wrong.attempt([&] { wire_ = codec::readWire(wire, joints_), wire_known = true; });
    wrong.attempt([&] { (void)static_cast<const T*>(this)->address(); });
    wrong.attempt([&] { checkCount("arm.max_torque", max_torque.size(), true); });
    if (method == static_cast<int>(Calibration::kPose) || !pose.empty())
      wrong.attempt([&] { checkCount("calibration.pose", pose.size(), false); });
    if (wire_known)
      wrong.attempt([&] { takeWire(); });
    else
      wrong.attempt([&] { needCalibrated(draft()); });
    wrong.attempt([&] { takeFirmware(); });
    wrong.check();
    for (size_t i = 0; i < joints_; ++i)
      limit_[i] = std::min(max_torque[max_torque.size() == 1 ? 0 : i], largestTorque(i));
    takeLimits();
  }

  void checkCount(const char* what, size_t count, bool may_be_one) const {
    if (joints_ == 0 || count == joints_ || (may_be_one && count == 1)) return;
    throw std::invalid_argument(std::string(what) + ": " + std::to_string(count) + " numbers, expected " +
                                (may_be_one ? "1 or " : "") + std::to_string(joints_) + ", one per joint");
  }

  /// Reads the wire format, and checks that it fits the arm.
  void takeWire() {
    follows_ = wire_.output.has(codec::Role::kFollow);
    velocity_ = wire_.input.has(codec::Role::kVelocity), torque_ = wire_.input.has(codec::Role::kTorque);
    needCalibrated(wire_);
  }

  /// Returns the largest torque [N m] that a command can have in both directions. If a motor is at its limit, the host
  /// scales all torques, so that the force keeps its direction. So it must know this limit.
  double largestTorque(size_t joint) const {
    double most = HUGE_VAL;
    for (const codec::Field& field : wire_.output.fields)
      if (field.role == codec::Role::kTorque && field.index == joint)
        for (const double raw : {field.least, field.most})
          most = std::min(most, std::abs(raw * field.scale + field.offset));
    return most;
  }

  /// Returns as much of a wire format with mistakes as can be read; they have been noted before.
  codec::Wire draft() const {
    codec::Wire read;
    kinematics::ErrorCollector noted;
    noted.attempt([&] { read = codec::draftOfWire(wire, joints_); });
    return read;
  }

  void needCalibrated(const codec::Wire& read) const {
    const bool needed = method == static_cast<int>(Calibration::kDevice) && read.input.whole;
    if (needed && !read.input.has(codec::Role::kCalibrated))
      throw std::invalid_argument(
          "calibration.method: device, but no field of wire.input says whether the arm has its zero; expected a field "
          "{is: calibrated}, or method: none (absolute encoders) or pose");
  }

  void takeFirmware() {
    if (loader == 0 || firmware.empty()) return;
    auto image = readFalconFirmware(firmware);
    if (!image) throw std::invalid_argument("firmware: " + image.error());
    image_ = *image;
  }

  void takeLimits() {
    for (size_t i = 0; i < joints_; ++i) {
      const auto joint = static_cast<Eigen::Index>(i);
      const bool given = limits.size() == 2 * joints_;
      least_[i] = given ? limits[2 * i] : arm_->limits().min[joint];
      most_[i] = given ? limits[2 * i + 1] : arm_->limits().max[joint];
    }
  }

  void describe(hdv_info& info, const Identity& identity) const {
    info.joint_count = static_cast<uint32_t>(joints_);
    info.capabilities = HDV_C_PACING | (velocity_ ? uint32_t{HDV_C_VELOCITY} : 0u) |
                        (torque_ ? uint32_t{HDV_C_TORQUE} : 0u) | (follows_ ? uint32_t{HDV_C_POSITION} : 0u) |
                        (wire_.cutsSoon() ? uint32_t{HDV_C_WATCHDOG} : 0u) |
                        (method != 0 ? uint32_t{HDV_C_CALIBRATION} : 0u) | (verified ? 0u : uint32_t{HDV_C_UNVERIFIED});
    info.rate_hz = wire_.rate;
    info.max_force = max_force, info.continuous_force = continuous_force, info.max_stiffness = max_stiffness;
    info.mass_kg = mass, info.damping = damping;
    kinematics::Jacobian J;
    const bool has_jacobian = arm_->jacobian(arm_->neutral(), J);
    for (size_t i = 0; i < joints_; ++i) {
      const auto joint = static_cast<Eigen::Index>(i);
      info.max_torque[i] = limit_[i];
      info.position_min[i] = least_[i];
      info.position_max[i] = most_[i];
      for (const codec::Field& field : wire_.input.fields)
        if (has_jacobian && field.role == codec::Role::kPosition && field.index == i)
          info.resolution_m = std::max(info.resolution_m, std::abs(field.scale) * J.col(joint).head<3>().norm());
    }
    for (const codec::Field& field : wire_.input.fields)
      if (field.role == codec::Role::kButton) info.buttons = std::max(info.buttons, field.index + 1u);
    std::snprintf(info.product, sizeof info.product, "%s", identity.product.c_str());
    std::snprintf(info.serial, sizeof info.serial, "%s", identity.serial.c_str());
    std::snprintf(info.firmware, sizeof info.firmware, "%s", identity.firmware.c_str());
  }

  /// May also be called before open() and after close(); then it does nothing.
  static void cut(hdv_device* device) noexcept HSP_RT {
    if (Link* link = reinterpret_cast<T*>(device)->link_.get()) link->cut();
  }

  static hsp_status capture(hdv_device* device, hdv_take_transfer take, void* who) {
    T& self = *reinterpret_cast<T*>(device);
    const auto done = self.link_ ? self.link_->capture(take, who) : Result<void>(Error{"the arm is not open"});
    if (!done) self.writeLog(HSP_LOG_ERROR, done.error());
    return done ? HSP_OK : HSP_E_IO;
  }

  static int32_t cutLeft(const hdv_device* device) noexcept HSP_RT {
    const Link* link = reinterpret_cast<const T*>(device)->link_.get();
    return link == nullptr || link->cutLeft() ? 1 : 0;
  }

  static int32_t silence(hdv_device* device, hdv_silence* how) {
    const Link* link = reinterpret_cast<T*>(device)->link_.get();
    return link != nullptr && link->silence(*how) ? 1 : 0;
  }

  static uint64_t waitForSample(hdv_device* device, uint64_t until_ns) noexcept {
    reinterpret_cast<T*>(device)->link_->waitForNews(until_ns);
    return std::min<uint64_t>(monotonicNow(), until_ns);
  }

  static const char* why(const hdv_device* device) noexcept HSP_RT {
    const Trouble trouble = reinterpret_cast<const T*>(device)->trouble_.load(std::memory_order_relaxed);
    return trouble == Trouble::kNone ? nullptr : wire_arm::describe(trouble);
  }

  static hsp_status calibrate(hdv_device* device) {
    T& self = *reinterpret_cast<T*>(device);
    try {
      return self.method == static_cast<int>(Calibration::kPose) ? self.calibratePose() : self.calibrateDevice();
    } catch (const std::exception& e) {
      self.writeLog(HSP_LOG_ERROR, e.what());
      return HSP_E_IO;
    }
  }

  hsp_status calibratePose() {
    JointArray at{};
    std::copy(pose.begin(), pose.end(), at.begin());
    auto offset = link_->calibrateAt(at);
    if (!offset) return writeLog(HSP_LOG_ERROR, offset.error()), HSP_E_IO;
    auto stored = storeZero(stateFolder(), static_cast<const T*>(this)->address(), link_->identity(), *offset, joints_);
    if (!stored) writeLog(HSP_LOG_ERROR, stored.error());
    return stored ? HSP_OK : HSP_E_IO;
  }

  hsp_status calibrateDevice() {
    constexpr int kLongest = 30'000;  // [ms] time for the user to move every joint past its index mark
    constexpr int kHeard = 500;       // [ms] an arm that had a zero must first say that it searches for a new one
    RealClock clock(0);
    link_->calibrateByDevice(true);
    for (int i = 0; i < kLongest && (i < kHeard || !sample_.calibrated); ++i) {
      clock.waitUntil(clock.now() + 1'000'000);
      link_->read(sample_);
    }
    link_->calibrateByDevice(false);
    if (sample_.calibrated) return HSP_OK;
    writeLog(HSP_LOG_ERROR,
             "found no zero within 30 s\n  the arm stays without force\n  fix: move every joint over its whole "
             "range, then try again");
    return HSP_E_IO;
  }

  std::unique_ptr<kinematics::Arm> arm_;
  std::unique_ptr<Link> link_;
  codec::Wire wire_;
  std::vector<uint8_t> image_;
  hdv_ext_links links_{};
  hdv_ext_kinematics kinematics_{};
  hdv_ext_calibration calibration_{};
  std::atomic<Trouble> trouble_{Trouble::kNone};
  Sample sample_;
  ArmCommand command_;
  JointArray limit_{}, least_{}, most_{};
  size_t joints_ = 0;
  bool velocity_ = false, torque_ = false, follows_ = false;
};

}  // namespace hapticd::wire_arm
