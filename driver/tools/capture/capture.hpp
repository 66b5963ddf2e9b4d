// SPDX-License-Identifier: MIT
/// The form of a capture, which holds bytes of an arm: as they were on the wire, or as text.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace hapticd::capture {

enum class Form : uint8_t {
  kGuess,  ///< read as text if every line is such text, otherwise as raw bytes
  kRaw,    ///< the bytes themselves
  kHex,    ///< one transfer per line: two hex digits per byte; # begins a comment. Also hid-recorder's "E:" lines,
           ///< and those of other_programs.hpp.
};

/// One transfer: a HID report, or a packet of an endpoint. A raw capture is one long transfer.
struct Transfer {
  double time = -1;  ///< [s] when it was captured; -1 if unknown
  std::vector<uint8_t> bytes;
};

struct Capture {
  bool text = false;
  std::vector<Transfer> transfers;
  size_t bytes() const;  ///< sum over all transfers
};

/// [main] Reads a capture. An error names the line. Lines that begin with "> " are bytes that were sent to the arm;
/// they are left out.
Result<Capture> readCapture(const std::string& bytes, Form form);

/// [any] Returns the bytes as hexadecimal text, such as "01 ff 3c".
std::string hexText(const uint8_t* bytes, size_t count);

}  // namespace hapticd::capture
