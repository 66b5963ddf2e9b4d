// SPDX-License-Identifier: MIT
#include "vendor_hd/servo.hpp"

#include <algorithm>

#include "base/clock.hpp"

namespace hapticd::vendor_hd {

namespace {

constexpr double kMetrePerMm = 1e-3;

}  // namespace

using vendor_arm::ArmReading;

bool Servo::start(HHD device) {
  device_ = device;
  end_ = false;
  last_ = {};
  ticks_ = 0;
  vendor_.make_current(device);
  vendor_.enable(HD_FORCE_OUTPUT);
  handle_ = vendor_.schedule(&Servo::callback, this, HD_MAX_SCHEDULER_PRIORITY);
  scheduled_ = handle_ != HD_INVALID_HANDLE;
  if (scheduled_) vendor_.start_scheduler();
  return scheduled_;
}

void Servo::stop() {
  if (!scheduled_) return;
  scheduled_ = false;
  end_ = true;
  vendor_.stop_scheduler();
  vendor_.unschedule(handle_);
  vendor_.make_current(device_);
  vendor_.disable(HD_FORCE_OUTPUT);
}

HDCallbackCode HDCALLBACK Servo::callback(void* self) {
  auto& servo = *static_cast<Servo*>(self);
  servo.tick();
  return servo.end_ ? HD_CALLBACK_DONE : HD_CALLBACK_CONTINUE;
}

/// Reads the position first and sets the force last, so that the daemon's tick can run in between.
void Servo::tick() {
  vendor_.begin_frame(device_);
  ArmReading seen = last_;
  look(seen);
  double force[3];
  exchange_.force(force);
  if (end_) std::fill_n(force, 3, 0.0);
  vendor_.set_doubles(HD_CURRENT_FORCE, force);
  vendor_.end_frame(device_);
  notice(seen);
  last_ = seen;
  exchange_.show(seen);
}

void Servo::look(ArmReading& seen) {
  double position[3] = {};
  HDint buttons = 0;
  vendor_.get_doubles(HD_CURRENT_POSITION, position);
  vendor_.get_integers(HD_CURRENT_BUTTONS, &buttons);
  for (int i = 0; i < 3; ++i) seen.position[i] = position[i] * kMetrePerMm;
  seen.buttons = static_cast<uint32_t>(buttons);
  seen.time_ns = monotonicNow();
  ++seen.sequence;
  constexpr uint64_t kEvery = 100;  // ticks between two checks: not every tick, because a check may call the hardware
  if (ticks_++ % kEvery == 0) seen.calibrated = vendor_.check_calibration() == HD_CALIBRATION_OK;
}

/// Takes the library's errors. A lost arm stays lost until the next start, because the library may report old positions
/// for ever. A fault stays as well.
void Servo::notice(ArmReading& seen) {
  constexpr int kMost = 64;
  for (int i = 0; i < kMost; ++i) {
    switch (vendor_.get_error().errorCode) {
      case HD_SUCCESS:
        return;
      case HD_COMM_ERROR:
      case HD_COMM_CONFIG_ERROR:
        seen.lost = true;
        break;
      case HD_DEVICE_FAULT:
      case HD_WARM_MOTORS:
        seen.fault = true;
        break;
      default:
        break;  // an error about forces: this frame had zero force
    }
  }
}

}  // namespace hapticd::vendor_hd
