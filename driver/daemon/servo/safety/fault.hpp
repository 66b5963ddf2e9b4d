// SPDX-License-Identifier: MIT
/// Faults and their texts. A fault takes the force of an arm away until the user clears it, or until it ends by itself.
#pragma once
#include <atomic>
#include <cstdint>
#include <string>

namespace hapticd::servo {

/// The reason why an arm's force was taken away. A unit in brackets is the unit of the measured value. Recordings
/// contain the number of the fault, so new faults are added at the end.
enum class Fault : uint8_t {
  kNone,
  kNotFinite,      ///< a force or position is not a number
  kDeviceLost,     ///< the device cannot be read or written
  kDeviceFault,    ///< the hardware reports a fault
  kStale,          ///< the device sent no new sample for too long [s]
  kTooFast,        ///< the tip moved faster than the limit [m/s]
  kLate,           ///< too many ticks were missed in a row [s]
  kNotCalibrated,  ///< the device must be calibrated before it may push
  kStopped,        ///< a user holds the arm, or the run ends
  kStuck,          ///< a tick did not end in time, so the watchdog cut the motors [s]
  kOverheated,     ///< a motor is hotter than allowed, as the model of its heat estimates [degC]
  kJumped,         ///< the tip moved farther between two samples than a hand can move it [m/s]
  kNotUnit         ///< the device's orientation is not a unit quaternion [its length]
};
constexpr int kFaultCount = 13;

/// True if the fault ends by itself once the device works again: kDeviceLost, kDeviceFault, kStale, kNotCalibrated.
/// Other faults stay until the user clears them.
bool endsByItself(Fault fault) noexcept;

/// Returns the text for a fault: what failed, and the command or action that cures it.
const char* describe(Fault fault);

/// [main] Returns a message of four parts: what failed, the measured value, the consequence, and the cure.
/// @param measured value, in the unit that is named at the enumerator
/// @param why the device's own text, "cause; cure"; nullptr if it has none
/// @param file the device file, which the commands of the cure take
std::string faultMessage(const std::string& device, Fault fault, double measured, const char* why = nullptr,
                         const std::string& file = "FILE");

/// A fault that one thread latches and other threads read.
class LatchedFault {
 public:
  LatchedFault() = default;
  LatchedFault(const LatchedFault& other) noexcept : fault_(other.get()) {}
  LatchedFault& operator=(const LatchedFault& other) noexcept {
    set(other.get());
    return *this;
  }
  Fault get() const noexcept { return fault_.load(std::memory_order_acquire); }
  void set(Fault fault) noexcept { fault_.store(fault, std::memory_order_release); }

 private:
  std::atomic<Fault> fault_{Fault::kNone};
};

}  // namespace hapticd::servo
