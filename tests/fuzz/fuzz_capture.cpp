// SPDX-License-Identifier: MIT
/// Fuzzes captures of arms: the reader, the decoder, and the hints about what does not fit. The first byte of the input
/// gives the form of the capture and, in its lower five bits, the number of joints; a wire format as JSON follows, and
/// after a zero byte the capture.
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "capture/hints.hpp"
#include "capture/plausible.hpp"

using namespace hapticd;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string all(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::size_t end = all.find('\0');
  if (end == std::string::npos) return 0;
  const std::size_t joints = data[0] % 32 % (codec::kMaxJoints + 1);
  const auto captured = capture::readCapture(all.substr(end + 1), static_cast<capture::Form>(data[0] / 32 % 3));
  if (!captured) return 0;
  try {
    const codec::Wire wire = codec::readWire(all.substr(0, end), joints);
    const capture::Decoded decoded = capture::decodeCapture(wire, *captured);
    std::string told = capture::csvOf(wire, joints, decoded) + capture::summaryOf(decoded);
    told += capture::hintsOf(wire, *captured, decoded);
    const capture::ArmFacts arm{joints, std::vector<double>(2 * joints, 0.5), false, {0.5}};
    told += capture::implausible(wire, arm, decoded);
    if (told.find('\0') != std::string::npos) __builtin_trap();
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
