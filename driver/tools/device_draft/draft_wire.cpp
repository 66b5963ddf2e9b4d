// SPDX-License-Identifier: MIT
#include "device_draft/draft_wire.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace hapticd::device_draft {
namespace {

/// Returns how many bits a checksum takes, in whole bytes, from its name: 16 for crc16-modbus, 8 for crc5-usb.
int checksumBits(const std::string& name) {
  const size_t digits = name.find_first_of("0123456789");
  int bits = 8;  // of sum, xor
  if (digits != std::string::npos) std::from_chars(name.data() + digits, name.data() + name.size(), bits);
  return std::clamp((bits + 7) / 8 * 8, 8, 64);
}

/// Returns the line for a checksum over the first `size` bytes, or a comment that shows how to write one.
std::string checksumOf(const DeviceDraft& draft, int size) {
  const bool given = draft.hasChecksum();
  const std::string name = given ? draft.checksum : "crc16-modbus";
  const int bits = checksumBits(name);
  return fmt::format("        {}- {{is: checksum, at: {}, type: u{}, method: {}, from: 0, to: {}{}}}{}\n",
                     given ? "" : "# ", size, bits, name, size, draft.report_id > 0 ? ", over_id: true" : "",
                     given ? "" : fmt::format("      # then size: {}", size + bits / 8));
}

std::string reportId(const DeviceDraft& draft) {
  return draft.report_id > 0 ? fmt::format("      id: {}\n", draft.report_id) : std::string();
}

std::string inputOf(const DeviceDraft& draft) {
  int bit = 16;
  std::string fields = "        - {is: counter, at: 0, type: u16}               # grows with each report\n";
  for (int i = 0; i < draft.joints; ++i, bit += draft.bits) {
    const std::string place = bit % 8 == 0 ? fmt::format("at: {}", bit / 8) : fmt::format("bit_offset: {}", bit);
    const double turn = DeviceDraft::ofJoint(draft.counts, i) * DeviceDraft::ofJoint(draft.gear, i);
    fields += fmt::format("        - {{is: position, joint: {}, {}, type: i{}, scale: {:.9g}{}}}\n", i + 1, place,
                          draft.bits, 2 * M_PI / turn, draft.bits <= 24 ? ", wraps: true" : "");
  }
  for (int i = 0; i < draft.buttons; ++i, ++bit)
    fields += fmt::format("        - {{is: button, button: {}, bit_offset: {}, type: u1}}\n", i + 1, bit);
  const int payload = (bit + 7) / 8, size = payload + (draft.hasChecksum() ? checksumBits(draft.checksum) / 8 : 0);
  return "    input:                        # what the arm sends; bytes are counted without the report id\n" +
         reportId(draft) + fmt::format("      size: {}\n", size) +
         "      fields:                     # rad = raw * scale: 2 pi / (counts * turns of one joint turn)\n" + fields +
         checksumOf(draft, payload);
}

std::string outputOf(const DeviceDraft& draft) {
  const int enable = 2 * draft.joints;
  std::string text = "    output:                       # what the arm gets\n" + reportId(draft) +
                     fmt::format("      size: {}\n", enable + 2) +
                     "      fields:                     # N m = raw * scale\n";
  for (int i = 0; i < draft.joints; ++i)
    text += fmt::format("        - {{is: torque, joint: {}, at: {}, type: i16, scale: {:.6g}}}\n", i + 1, 2 * i,
                        DeviceDraft::ofJoint(draft.torque, i) / 32767);
  return text + fmt::format("        - {{is: enable, at: {}, type: u8}}\n        - {{is: counter, at: {}, type: u8}}\n",
                            enable, enable + 1);
}

}  // namespace

std::string wireOf(const DeviceDraft& draft) {
  constexpr const char* kHead = R"(  wire:                           # driver/docs/devices.md has every key
    exchange: stream              # or poll: the arm answers each command
    rate: 1000                    # Hz
    # watchdog: 0.02              # s: if the arm has a watchdog, the time after which it switches its motors off
)";
  const char* endpoints = draft.bus == "bulk" ? "    endpoints: {in: 0x81, out: 0x02}\n" : "";
  return std::string(kHead) + endpoints + inputOf(draft) + outputOf(draft);
}

}  // namespace hapticd::device_draft
