// SPDX-License-Identifier: MIT
/// Carries bytes to and from an arm. Each implementation uses one library or driver; tests use a fake one.
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "base/clock.hpp"
#include "base/descriptors.hpp"
#include "base/result.hpp"
#include "codec/wire.hpp"
#include "hapticd/device_silence.h"
#include "wire_arm/address.hpp"

namespace hapticd::wire_arm {

enum class Status : uint8_t {
  kOk,
  kNothing,  ///< nothing came within the time given
  kGone,     ///< unplugged
  kStalled,  ///< the endpoint refuses transfers
  kAbsent,   ///< on a bus without plugs: no board answers at the address
  kFailed,   ///< another error of the bus; often the first sign that the device is unplugged
};

/// Facts about a device that are read when it is opened.
struct Identity {
  std::string serial, product, firmware;
  std::string epoch;  ///< changes each time the device is plugged in
};

/// The connection to one device. Its functions are called from [main] or from the I/O thread, but never from both at
/// once.
class Transport {
 public:
  virtual ~Transport() = default;
  /// Finds and opens the device. The error says which device was searched for and what to do.
  virtual Result<Identity> open(const Address& address, const codec::Wire& wire) = 0;
  virtual void close() noexcept = 0;
  /// Receives the next report or packet. @param size becomes the number of bytes in `to`
  /// @param wait longest time to wait
  virtual Status receive(std::span<uint8_t> to, size_t& size, Nanoseconds wait) noexcept = 0;
  virtual Status send(std::span<const uint8_t> bytes) noexcept = 0;
  /// Sends a control request without data (USB set-up packets of a start-up sequence).
  virtual Status control(const codec::StartStep& step) noexcept = 0;
  /// True if the arm reads commands from memory into which send() writes. It may then read a command half written.
  virtual bool sharesMemory() const noexcept { return false; }
  /// Opens the device a second time while it is open, for a process that switches the motors off if this process ends.
  /// Fills in everything except the bytes; `size` becomes the number of zeros to put before a report.
  /// @return a new descriptor, or an empty one if the device cannot be opened twice
  virtual Descriptor openForSilence(hdv_silence&) noexcept { return {}; }
};

}  // namespace hapticd::wire_arm
