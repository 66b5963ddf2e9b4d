// SPDX-License-Identifier: MIT
/// One instance of a device module, from create() to destroy(). The calls of the set-up may fail with a message; read()
/// and write() are real-time calls.
#pragma once
#include <memory>
#include <string>

#include "base/code_owner.hpp"
#include "base/result.hpp"
#include "description/scene.hpp"
#include "hapticd/device.h"
#include "hapticd/device_links.h"
#include "hapticd/device_pace.h"
#include "hapticd/device_silence.h"
#include "hapticd/device_trouble.h"
#include "host/library.hpp"
#include "host/services.hpp"

namespace hapticd::host {

/// The samples of a recording that is replayed. They replace the samples of the hardware, which is not opened.
struct Playback {
  hdv_info info{};      ///< description that the device gave when it was opened
  hdv_sample sample{};  ///< sample that the next read returns
  hsp_status read_status = HSP_OK, write_status = HSP_OK;
};

class DeviceInstance {
 public:
  /// [main] Loads the library (once per process), creates the instance and sets the parameters of the device file.
  static Result<std::unique_ptr<DeviceInstance>> create(const scene::Device& device, Services::Log log);
  ~DeviceInstance();  ///< [main] stops, closes and destroys
  DeviceInstance(const DeviceInstance&) = delete;
  DeviceInstance& operator=(const DeviceInstance&) = delete;

  /// [main] Uses a playback in place of the hardware. Call it before open(). The playback must outlive the instance.
  void playBack(const Playback* playback) { playback_ = playback; }

  Result<void> open();                       ///< [main] opens the hardware; ErrorKind::kAbsent if there is none
  Result<void> start(const hdv_start& how);  ///< [main]
  void stop();                               ///< [main] switches the motors off

  hsp_status read(uint64_t now_ns, hdv_sample& sample) noexcept HSP_RT {
    if (playback_ == nullptr) {
      const OwnerScope calling(owner_);
      return class_->read(device_, now_ns, &sample);
    }
    sample = playback_->sample;
    return playback_->read_status;
  }
  hsp_status write(uint64_t now_ns, const hdv_command& command) noexcept HSP_RT {
    if (playback_ != nullptr) return playback_->write_status;
    const OwnerScope calling(owner_);
    return class_->write(device_, now_ns, &command);
  }

  /// [any] Switches the motors off at once by the extension hdv.cut of the module. Returns false if the module does not
  /// have it. Async-signal-safe.
  bool cut() noexcept {
    if (cut_ == nullptr || playback_ != nullptr) return playback_ != nullptr;
    const OwnerScope calling(owner_);
    cut_->cut(device_);
    return true;
  }
  /// [any] True if, as far as the module knows, the cut has been sent to the hardware. Async-signal-safe.
  bool cutLeft() const noexcept {
    if (silence_ == nullptr || silence_->left == nullptr || playback_ != nullptr) return true;
    return silence_->left(device_) != 0;
  }
  /// [any] True if another process may be able to switch the motors off.
  bool silenceable() const noexcept { return silence_ != nullptr && silence_->how != nullptr && playback_ == nullptr; }
  /// [any] Fills in how another process, which outlives this one, can switch the motors off. Returns false if that is
  /// impossible, or impossible now.
  bool silence(hdv_silence& how) noexcept {
    how = {};
    how.struct_size = sizeof how;
    if (!silenceable()) return false;
    const OwnerScope calling(owner_);
    return silence_->how(device_, &how) != 0 && how.size <= sizeof how.bytes;
  }

  /// [any] True if the samples of the arm can drive the servo loop; then waitForSample() waits for them.
  bool canPace() const { return pace_ != nullptr && (info_.capabilities & HDV_C_PACING) != 0; }
  /// [rt] Sleeps between two ticks until the arm has a new sample or reports a trouble, and at most until `until`.
  /// @return time of the next tick
  uint64_t waitForSample(uint64_t until) noexcept {
    if (playback_ != nullptr) return until;
    const OwnerScope calling(owner_);
    return pace_->wait(device_, until);
  }

  /// [any] Returns what was wrong with the arm at the last read, and how to fix it ("cause; cure"), as a text in static
  /// storage; nullptr if it is unknown.
  const char* trouble() const noexcept HSP_RT {
    return trouble_ != nullptr && playback_ == nullptr ? trouble_->why(device_) : nullptr;
  }

  /// Returns the hand of a simulated arm; nullptr if the arm has none, or if it is played back.
  const hdv_ext_hand* hand() const {
    const bool simulated = (info_.capabilities & HDV_C_SIMULATED) != 0;
    return simulated && playback_ == nullptr ? hand_ : nullptr;
  }

  const std::string& name() const { return name_; }
  const hdv_class& description() const { return *class_; }
  const hdv_info& info() const { return info_; }                         ///< valid after open()
  const hdv_ext_kinematics& kinematics() const { return *kinematics_; }  ///< every module has it
  const hdv_ext_calibration* calibration() const { return calibration_; }
  /// Returns the functions for the positions of the arm's links, even if the arm is played back; nullptr if the module
  /// has none.
  const hdv_ext_links* links() const { return links_; }
  hdv_device* handle() const { return device_; }

 private:
  DeviceInstance(std::shared_ptr<Library> library, const scene::Device& device, Services::Log log);
  Result<void> findExtensions(const std::string& module);
  std::shared_ptr<Library> library_;
  std::string name_;
  Services services_;
  const Owner* owner_;
  const hdv_class* class_ = nullptr;
  hdv_device* device_ = nullptr;
  hdv_info info_{};
  const hdv_ext_kinematics* kinematics_ = nullptr;
  const hdv_ext_calibration* calibration_ = nullptr;
  const hdv_ext_links* links_ = nullptr;
  const hdv_ext_cut* cut_ = nullptr;
  const hdv_ext_hand* hand_ = nullptr;
  const hdv_ext_pace* pace_ = nullptr;
  const hdv_ext_trouble* trouble_ = nullptr;
  const hdv_ext_silence* silence_ = nullptr;
  const Playback* playback_ = nullptr;
  bool open_ = false, started_ = false;
};

}  // namespace hapticd::host
