// SPDX-License-Identifier: MIT
/// What takes the force away until the user clears it, and the words for it.
#pragma once
#include <atomic>
#include <cstdint>
#include <string>

namespace hapticd::servo {

/// What took the force away. Recordings keep the number, so new faults come at the end.
enum class Fault : uint8_t {
  kNone,
  kNotFinite,      ///< a force or position that is not a number
  kDeviceLost,     ///< the device cannot be read or written
  kDeviceFault,    ///< the hardware reports a fault
  kStale,          ///< no new sample for too long [s]
  kTooFast,        ///< the tip moved faster than the limit [m/s]
  kLate,           ///< too many ticks missed in a row [s]
  kNotCalibrated,  ///< the device must be calibrated before it may push
  kStopped,        ///< the daemon is stopping
  kStuck,          ///< a tick did not end and the watchdog cut the motors [s]
  kOverheated,     ///< a motor is hotter than it may be, by its model [degC]
  kJumped,         ///< two positions are farther apart than a hand can move [m/s]
  kNotUnit         ///< the device's orientation is not a unit quaternion [its length]
};
constexpr int kFaultCount = 13;

/// True if the fault ends by itself once the device is well: unplugged, silent, at fault, not calibrated. A fault of
/// the daemon or the user stays until the user clears it.
bool endsByItself(Fault fault) noexcept;

/// Words for a fault: what failed, and the command or action that cures it.
const char* describe(Fault fault);

/// [main] One message of four parts: what failed, the measured state, the consequence, what cures it.
/// @param measured in the unit that the enumerator names
/// @param why the device's own words, "cause; cure"; nullptr: it has none
std::string faultMessage(const std::string& device, Fault fault, double measured, const char* why = nullptr);

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
