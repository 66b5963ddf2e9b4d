// SPDX-License-Identifier: MIT
/// The wire format of an arm as its device file gives it: reports, framing, start-up sequence and timing. Read once and
/// checked then, so that the codec can trust every offset.
#pragma once
#include <string>
#include <vector>

#include "codec/report.hpp"

namespace hapticd::codec {

/// Who speaks first.
enum class Exchange : uint8_t {
  kStream,  ///< the arm sends by itself
  kPoll,    ///< the arm answers each command
};

/// Reports inside a stream of bytes: packets start with bytes of the USB chip, reports start and end with a mark.
struct Framing {
  bool used = false;
  size_t header = 0;         ///< bytes at the head of each USB packet that are not ours
  size_t packet = 64;        ///< bytes of one USB packet
  int start = -1, end = -1;  ///< first and last byte of a report; -1: none
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

/// Everything about the wire but the transport's own addresses.
struct Wire {
  Exchange exchange = Exchange::kStream;
  double rate = 1000;        ///< [Hz] of reports
  double keep_alive = 0.01;  ///< [s] longest pause between commands
  double watchdog = 0;       ///< [s] after which the hardware cuts its motors by itself; 0: it does not
  Framing framing;
  std::vector<StartStep> startup;
  Report input, output;
  uint8_t endpoint_in = 0x81, endpoint_out = 0x02;
};

/// [main] Reads JSON text (the parameter `wire` of a device file). Throws std::invalid_argument: the key's path, what
/// it is, what was expected.
/// @param joints of the arm: every one needs a position in and a torque out
Wire readWire(const std::string& json, size_t joints);

}  // namespace hapticd::codec
