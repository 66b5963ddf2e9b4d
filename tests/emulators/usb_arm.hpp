// SPDX-License-Identifier: MIT
/// An emulated arm as a USB function: descriptors, control requests and endpoints, for whatever carries transfers
/// (USB/IP into a kernel, a played usbfs). Full speed, one interface, one endpoint in and one out.
#pragma once
#include <cerrno>
#include <deque>
#include <string>

#include "emulators/emulated_arm.hpp"
#include "emulators/ftdi_chip.hpp"

namespace hapticd::emulator {

using Bytes = std::vector<uint8_t>;

/// A HID report descriptor: vendor page, unnumbered, one input and one output report of so many bytes.
Bytes hidDescriptor(const About& about);

class UsbArm {
 public:
  static constexpr uint8_t kIn = 0x81, kOut = 0x02;

  UsbArm(const std::string& kind, const simulated::Parameters& hand, std::string serial);

  /// A control request. @param setup 8 bytes; `data` comes in or goes out.
  /// @return bytes, or -EPIPE: stalled
  int control(const uint8_t* setup, Bytes& data);
  /// A transfer of the host.
  void out(std::span<const uint8_t> bytes);
  /// The next packet for the host; false: none yet.
  bool in(Bytes& packet);
  void advance(double seconds);
  void spoil(Fault fault);
  /// The endpoint in has no transfers but those that end with -EPIPE.
  bool halted() const { return halted_; }

  Bytes deviceDescriptor() const;
  Bytes configuration() const;
  EmulatedArm& arm() { return arm_; }
  FtdiChip& chip() { return chip_; }
  const About& about() const { return arm_.about(); }
  const std::string& serial() const { return serial_; }

 private:
  void queue(Bytes report);
  int descriptor(uint16_t value, size_t most, Bytes& data) const;
  Bytes stringDescriptor(int index) const;

  EmulatedArm arm_;
  FtdiChip chip_;
  std::string serial_;
  std::deque<Bytes> packets_;
  double since_report_ = 0;
  bool stalls_ = false, halted_ = false;
};

}  // namespace hapticd::emulator
