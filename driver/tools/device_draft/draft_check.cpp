// SPDX-License-Identifier: MIT
/// Whether a device file can be made of a draft.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string_view>
#include <utility>

#include "codec/checksum.hpp"
#include "codec/wire_correction.hpp"
#include "device_draft/device_draft.hpp"

namespace hapticd::device_draft {
namespace {

std::string wrongLists(const DeviceDraft& draft) {
  const auto joints = static_cast<size_t>(draft.joints);
  for (const auto& [option, list] :
       {std::pair{"--counts", &draft.counts}, std::pair{"--gear", &draft.gear}, std::pair{"--torque", &draft.torque}}) {
    if (list->size() != 1 && list->size() != joints)
      return fmt::format("{}: {} numbers, expected one, or one for each of the {} joints", option, list->size(),
                         draft.joints);
    if (!std::all_of(list->begin(), list->end(), [](double value) { return value > 0; }))
      return fmt::format("{}: expected numbers above 0", option);
  }
  if (!draft.twists.empty() && (draft.kind != "chain" || draft.twists.size() != joints))
    return fmt::format("--twists: {} numbers, expected one for each joint of a chain", draft.twists.size());
  return "";
}

std::string wrongChecksum(const std::string& name) {
  static const std::vector<std::string> kPlain{"none", "sum", "xor", "sum8", "xor8"};
  const auto crcs = codec::namedCrcs();
  const bool known =
      std::find(kPlain.begin(), kPlain.end(), name) != kPlain.end() ||
      std::any_of(crcs.begin(), crcs.end(), [&](const codec::NamedCrc& one) { return name == one.name; });
  if (known) return "";
  if (name == "crc")
    return "--checksum crc: a CRC without a name needs its numbers, which only the file can give; expected the name of "
           "a CRC, such as crc16-modbus, or none";
  return "--checksum " + name + ": no checksum has this name" + codec::suggestMethod(name) +
         "; expected none, sum, xor or the name of a CRC, such as crc8, "
         "crc16 or crc16-modbus (driver/docs/devices.md lists all)";
}

/// Returns true for two numbers of one to four hexadecimal digits, such as 16c0:0486.
bool isUsbId(std::string_view id) {
  const auto isNumber = [](std::string_view digits) {
    uint16_t number = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number, 16);
    return digits.size() == 4 && error == std::errc() && end == digits.data() + digits.size();
  };
  const size_t colon = id.find(':');
  return colon != id.npos && isNumber(id.substr(0, colon)) && isNumber(id.substr(colon + 1));
}

}  // namespace

std::string wrongIn(const DeviceDraft& draft) {
  const bool hid = draft.bus == "hid", bulk = draft.bus == "bulk";
  if (!hid && !bulk) return "--bus " + draft.bus + ": expected hid or bulk";
  if (draft.kind != "phantom" && draft.kind != "delta" && draft.kind != "chain")
    return "--kind " + draft.kind + ": expected phantom, delta or chain";
  if (draft.kind != "chain" && draft.joints != 3)
    return "--joints " + std::to_string(draft.joints) + ": a " + draft.kind + " has 3 joints";
  if (draft.joints < 1 || draft.joints > 16) return "--joints " + std::to_string(draft.joints) + ": expected 1 to 16";
  if (draft.bits < 2 || draft.bits > 64) return "--bits " + std::to_string(draft.bits) + ": expected 2 to 64";
  const size_t lengths = draft.kind == "phantom" ? 2 : draft.kind == "delta" ? 8 : static_cast<size_t>(draft.joints);
  if (!draft.lengths.empty() && draft.lengths.size() != lengths)
    return fmt::format("--lengths: {} numbers, expected {} for a {}", draft.lengths.size(), lengths, draft.kind);
  if (std::any_of(draft.lengths.begin(), draft.lengths.end(), [](double length) { return length < 0; }))
    return "--lengths: expected 0 m or more each; a link that points the other way has a twist, not a length below 0";
  if (const std::string wrong = wrongLists(draft); !wrong.empty()) return wrong;
  if (!(draft.force > 0)) return "--force: expected a number above 0";
  if (const std::string wrong = wrongChecksum(draft.checksum); !wrong.empty()) return wrong;
  if (draft.report_id < 0 || draft.report_id > 255)
    return "--report-id " + std::to_string(draft.report_id) + ": expected 1 to 255, or 0 if reports have none";
  if (draft.buttons < 0 || draft.buttons > 32)
    return "--buttons " + std::to_string(draft.buttons) + ": expected 0 to 32";
  if (!isUsbId(draft.id))
    return "--id " + draft.id + ": expected vendor:product, four hexadecimal digits each, such as 1234:0006";
  return "";
}

}  // namespace hapticd::device_draft
