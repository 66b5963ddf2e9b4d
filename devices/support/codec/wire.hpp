// SPDX-License-Identifier: MIT
/// The wire format of an arm as its device file gives it: reports, framing, start-up sequence and timing. It is checked
/// when it is read, so that the codec can trust every offset.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "codec/report.hpp"
#include "codec/tree.hpp"

namespace hapticd::codec {

constexpr double kLeastRate = 50, kMostRate = 20000;  ///< [Hz] reports a second that an arm may have

/// Whether the arm sends reports by itself.
enum class Exchange : uint8_t {
  kStream,  ///< the arm sends by itself
  kPoll,    ///< the arm answers each command
};

/// How a byte is sent that may not appear inside a report: as the escape mark and a second byte. In HDLC and PPP the
/// second byte is the original byte with some bits flipped. SLIP has a code for each such byte.
struct Escape {
  bool used = false;
  uint8_t mark = 0;
  uint8_t flip = 0x20;  ///< bits that are flipped in the byte after the mark; used if there are no codes
  size_t count = 0;     ///< number of codes
  std::array<uint8_t, 8> plain{}, code{};
  std::array<uint8_t, 16> also{};  ///< bytes that are escaped in addition to the marks; used if there are no codes
  size_t also_count = 0;

  /// encoded() returns the byte that follows the mark for `byte`; decoded() is its inverse.
  uint8_t encoded(uint8_t byte) const noexcept {
    for (size_t i = 0; i < count; ++i)
      if (plain[i] == byte) return code[i];
    return count > 0 ? byte : static_cast<uint8_t>(byte ^ flip);
  }
  uint8_t decoded(uint8_t byte) const noexcept {
    for (size_t i = 0; i < count; ++i)
      if (code[i] == byte) return plain[i];
    return count > 0 ? byte : static_cast<uint8_t>(byte ^ flip);
  }
};

/// How reports lie in a stream of bytes: each packet may begin with bytes of the USB chip, and each report may begin
/// and end with a mark.
struct Framing {
  bool used = false;
  size_t header = 0;         ///< bytes at the head of each USB packet that belong to the USB chip
  size_t packet = 64;        ///< bytes of one USB packet
  int start = -1, end = -1;  ///< marks: first and last byte of a report; -1 if there is no such mark
  Escape escape;

  /// True for a byte that must be escaped.
  bool escapes(uint8_t byte) const noexcept {
    if (escape.count > 0)
      return std::find(escape.plain.begin(), escape.plain.begin() + escape.count, byte) !=
             escape.plain.begin() + escape.count;
    return byte == escape.mark || byte == start || byte == end ||
           std::find(escape.also.begin(), escape.also.begin() + escape.also_count, byte) !=
               escape.also.begin() + escape.also_count;
  }
};

/// One step of the start-up sequence: a control request, bytes to send, and bytes that must come as the answer.
struct StartStep {
  bool is_control = false;
  uint8_t request_type = 0, request = 0;
  uint16_t value = 0, index = 0;
  std::vector<uint8_t> send, expect;
  int tries = 1;
  double wait = 0;     ///< [s] pause after the step
  double timeout = 1;  ///< [s] longest time until the answer
};

/// The description of the wire. The address of the device is not part of it (see wire_arm::Address).
struct Wire {
  Exchange exchange = Exchange::kStream;
  double rate = 1000;   ///< [Hz] rate of the arm's reports, and of commands
  double watchdog = 0;  ///< [s] time without commands until the hardware switches its motors off; 0: never
  Framing framing;
  std::vector<StartStep> startup;
  Report input, output;
  uint8_t endpoint_in = 0x81, endpoint_out = 0x02;
  /// True if the arm's own watchdog switches the motors off soon enough to protect a hand. If it does not, the daemon
  /// starts a guard process.
  bool cutsSoon() const noexcept { return watchdog > 0 && watchdog <= 0.1; }
  /// True if the arm's clock has a new value in each report, so that two reports with the same value are the same
  /// report. For this the clock must advance at least twice per report, wrap after more than two reports, and not
  /// become coarser as it grows, as a 32-bit float does.
  bool clockTells() const noexcept {
    return std::any_of(input.fields.begin(), input.fields.end(), [this](const Field& field) {
      const double ticks = 1 / (field.scale * rate);
      return field.role == Role::kTime && ticks >= 2 &&
             (field.type == Type::kFloat ? field.bits > 32 : 2 * ticks < std::ldexp(1, field.bits));
    });
  }
};

/// [main] Reads JSON text (the parameter `wire` of a device file). Throws std::invalid_argument with the key's path,
/// its value and what was expected. @param joints number of joints of the arm; each needs a position field in the input
/// report and a torque field in the output report
Wire readWire(const std::string& json, size_t joints);

/// [main] Reads the correct parts of a wire description with mistakes, so that a check can judge them. The fields keep
/// their order. A wrong value becomes its default. Do not use the result for encoding or decoding: its fields may lie
/// outside of their report, and it has no startup steps. Throws only if the text is not JSON.
Wire draftOfWire(const std::string& json, size_t joints);

/// [main] Returns the blocks of a wire description that readWire() and draftOfWire() read in the place of others,
/// because their keys are misspelt or stand one level too deep. Throws only if the text is not JSON.
std::vector<ReadInstead> misplacedInWire(const std::string& json, size_t joints);

}  // namespace hapticd::codec
