// SPDX-License-Identifier: MIT
/// The wire format of an arm as its device file gives it: reports, framing, start-up sequence and timing. Read once and
/// checked then, so that the codec can trust every offset.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "codec/report.hpp"

namespace hapticd::codec {

/// Who speaks first.
enum class Exchange : uint8_t {
  kStream,  ///< the arm sends by itself
  kPoll,    ///< the arm answers each command
};

/// Bytes that may not stand inside a report are sent as the mark and another byte. HDLC and PPP flip a bit, SLIP has a
/// code for each.
struct Escape {
  bool used = false;
  uint8_t mark = 0;
  uint8_t flip = 0x20;  ///< exclusive or of what follows the mark, where there are no codes
  size_t count = 0;     ///< of codes
  std::array<uint8_t, 8> plain{}, code{};
  std::array<uint8_t, 16> also{};  ///< bytes that are escaped besides marks, where there are no codes
  size_t also_count = 0;

  /// The code that follows the mark for a byte, and the byte for a code.
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

/// Reports inside a stream of bytes: packets start with bytes of the USB chip, reports start and end with a mark.
struct Framing {
  bool used = false;
  size_t header = 0;         ///< bytes at the head of each USB packet that belong to the USB chip
  size_t packet = 64;        ///< bytes of one USB packet
  int start = -1, end = -1;  ///< first and last byte of a report; -1: none
  Escape escape;

  /// True for a byte that must not be sent as it is.
  bool escapes(uint8_t byte) const noexcept {
    if (escape.count > 0)
      return std::find(escape.plain.begin(), escape.plain.begin() + escape.count, byte) !=
             escape.plain.begin() + escape.count;
    return byte == escape.mark || byte == start || byte == end ||
           std::find(escape.also.begin(), escape.also.begin() + escape.also_count, byte) !=
               escape.also.begin() + escape.also_count;
  }
};

/// One step of the start-up sequence: a control request, or bytes that the arm must answer.
struct StartStep {
  bool is_control = false;
  uint8_t request_type = 0, request = 0;
  uint16_t value = 0, index = 0;
  std::vector<uint8_t> send, expect;
  int tries = 1;
  double wait = 0;     ///< [s] after the step
  double timeout = 1;  ///< [s] for the answer
};

/// Everything about the wire except the transport's own addresses.
struct Wire {
  Exchange exchange = Exchange::kStream;
  double rate = 1000;        ///< [Hz] of reports
  double keep_alive = 0.01;  ///< [s] longest pause between commands
  double watchdog = 0;       ///< [s] after which the hardware cuts its motors by itself; 0: it does not
  Framing framing;
  std::vector<StartStep> startup;
  Report input, output;
  uint8_t endpoint_in = 0x81, endpoint_out = 0x02;
  /// The arm's own watchdog ends a force soon enough for a hand. A slower one does not count: then a guard process
  /// stands by.
  bool cutsSoon() const noexcept { return watchdog > 0 && watchdog <= 0.1; }
  /// Each report carries another clock value, so two reports with the same time are the same report. The clock advances
  /// at least twice a report, wraps after more than two, and does not get coarser with the hours, as 32 bits of a float
  /// do.
  bool clockTells() const noexcept {
    return std::any_of(input.fields.begin(), input.fields.end(), [this](const Field& field) {
      const double ticks = 1 / (field.scale * rate);
      return field.role == Role::kTime && ticks >= 2 &&
             (field.type == Type::kFloat ? field.bits > 32 : 2 * ticks < std::ldexp(1, field.bits));
    });
  }
};

/// [main] Reads JSON text (the parameter `wire` of a device file). Throws std::invalid_argument with the key's path,
/// its value and what was expected.
/// @param joints of the arm: every one needs a position in and a torque out
Wire readWire(const std::string& json, size_t joints);

}  // namespace hapticd::codec
