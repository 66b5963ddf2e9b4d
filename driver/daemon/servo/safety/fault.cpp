// SPDX-License-Identifier: MIT
#include "servo/safety/fault.hpp"

#include <algorithm>
#include <cstdio>
#include <string_view>

namespace hapticd::servo {

bool endsByItself(Fault fault) noexcept {
  return fault == Fault::kDeviceLost || fault == Fault::kDeviceFault || fault == Fault::kStale ||
         fault == Fault::kNotCalibrated;
}

const char* describe(Fault fault) {
  switch (fault) {
    case Fault::kNone:
      return "no fault";
    case Fault::kNotFinite:
      return "a force or position was not a number; check its module: hapticd device check FILE, then: hapticd ctl "
             "clear";
    case Fault::kDeviceLost:
      return "the device is lost; plug it in again, then: hapticd device list";
    case Fault::kDeviceFault:
      return "the device reports a hardware fault; switch it off and on, then: hapticd device info FILE";
    case Fault::kStale:
      return "the device sent no new sample; check its cable and rate: hapticd device info FILE";
    case Fault::kTooFast:
      return "the tip moved faster than limits.velocity; hold the arm still, then: hapticd ctl clear";
    case Fault::kLate:
      return "too many ticks in a row were missed; find the cause with: hapticd doctor";
    case Fault::kNotCalibrated:
      return "the device is not calibrated; run: hapticd device calibrate FILE";
    case Fault::kStopped:
      return "stopped by the user";
    case Fault::kStuck:
      return "a tick did not end, and the watchdog cut the motors; find the cause with: hapticd doctor, or, in a "
             "module of your own: hapticd device check FILE";
    case Fault::kOverheated:
      return "a motor is hotter than limits.motors allow; let it cool down, then: hapticd ctl clear";
    case Fault::kJumped:
      return "the position jumped farther than a hand can move; check the encoders and their cables, then: hapticd "
             "device info FILE";
    case Fault::kNotUnit:
      return "the device gave an orientation that is not a unit quaternion; check its module, then: hapticd device "
             "kinematics FILE";
  }
  return "unknown fault";
}

std::string faultMessage(const std::string& device, Fault fault, double measured, const char* why,
                         const std::string& file) {
  std::string words = why != nullptr ? why : describe(fault);
  constexpr std::string_view kFile = " FILE";
  const size_t command = std::min(words.find("hapticd device "), words.size());
  if (const size_t at = words.find(kFile, command); at != std::string::npos)
    words.replace(at + 1, kFile.size() - 1, file);
  const size_t cure = words.find("; ");
  const char* unit = fault == Fault::kTooFast || fault == Fault::kJumped                         ? "m/s"
                     : fault == Fault::kOverheated                                               ? "degC"
                     : fault == Fault::kStale || fault == Fault::kLate || fault == Fault::kStuck ? "s"
                                                                                                 : nullptr;
  std::string text = "device " + device + ": " + words.substr(0, cure);
  if (unit != nullptr) {
    char state[64];
    std::snprintf(state, sizeof state, " (measured: %.3g %s)", measured, unit);
    text += state;
  }
  text += endsByItself(fault) ? "; its forces ended and come back in a ramp once the device works again"
                              : "; its forces ended and stay off until the fault is cleared";
  if (cure != std::string::npos) text += words.substr(cure);
  return text;
}

}  // namespace hapticd::servo
