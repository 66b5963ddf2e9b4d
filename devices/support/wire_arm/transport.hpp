// SPDX-License-Identifier: MIT
/// What carries bytes to and from an arm. Implementations own one USB library each; tests put a fake one here.
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "base/clock.hpp"
#include "base/descriptors.hpp"
#include "base/result.hpp"
#include "codec/wire.hpp"
#include "hapticd/device_silence.h"

namespace hapticd::wire_arm {

enum class Status : uint8_t {
  kOk,
  kNothing,  ///< nothing came within the time given
  kGone,     ///< unplugged
  kStalled,  ///< the endpoint refuses
  kAbsent,   ///< on a bus without plugs: nobody answers at the address
  kFailed,   ///< another error of the bus: unplugging often begins with some of these
};

/// Which device to open.
struct Address {
  uint16_t vendor = 0, product = 0;
  int interface = -1;  ///< -1: any
  std::string serial;  ///< empty: the first device that is free
  bool operator==(const Address&) const = default;
};

/// What a device says about itself when it is opened.
struct Identity {
  std::string serial, product, firmware;
  std::string epoch;  ///< changes whenever the device was plugged in anew
};

/// [main] or the I/O thread, but only one at a time.
class Transport {
 public:
  virtual ~Transport() = default;
  /// Finds and opens the device; the error says what was looked for and what to do.
  virtual Result<Identity> open(const Address& address, const codec::Wire& wire) = 0;
  virtual void close() noexcept = 0;
  /// Receives the next report or packet. @param size bytes written to `to`
  virtual Status receive(std::span<uint8_t> to, size_t& size, Nanoseconds wait) noexcept = 0;
  virtual Status send(std::span<const uint8_t> bytes) noexcept = 0;
  /// Sends a control request without data (USB set-up packets of a start-up sequence).
  virtual Status control(const codec::StartStep& step) noexcept = 0;
  /// While the device is open, gives another way to it, for a process that outlives this one. Fills in all but the
  /// bytes, whose size becomes the number of zeros before a report.
  /// @return a descriptor of its own; nothing if there is none
  virtual Descriptor wayIn(hdv_silence&) noexcept { return {}; }
};

}  // namespace hapticd::wire_arm
