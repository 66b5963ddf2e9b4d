// SPDX-License-Identifier: MIT
#include "capture/leading_byte.hpp"

#include <algorithm>
#include <bit>
#include <functional>

#include "capture/layout_hint.hpp"
#include "capture/report_table.hpp"

namespace hapticd::capture {
namespace {

constexpr size_t kFewest = 3;         ///< [reports] fewer than this may begin with 0x00 by chance
constexpr size_t kFewestOfSize = 20;  ///< [reports] the same, where the size of the reports is the expected one
constexpr size_t kLeastPacket = 8;    ///< [bytes] the smallest packet of USB; others are powers of two

/// Returns true if the byte at `at` is the same in all reports. All reports have the same size.
bool stands(const Capture& capture, size_t at) {
  const uint8_t first = capture.transfers.front().bytes[at];
  return std::all_of(capture.transfers.begin(), capture.transfers.end(),
                     [&](const Transfer& transfer) { return transfer.bytes[at] == first; });
}

/// Returns the size that all reports have, if all of them begin with the same byte; otherwise 0.
size_t sizeOfAll(const Capture& capture) {
  if (!capture.text || capture.transfers.size() < kFewest) return 0;
  const std::vector<uint8_t>& first = capture.transfers.front().bytes;
  const bool alike = std::all_of(capture.transfers.begin(), capture.transfers.end(), [&](const Transfer& transfer) {
    return transfer.bytes.size() == first.size() && !first.empty() && transfer.bytes.front() == first.front();
  });
  return alike ? first.size() : 0;
}

/// Returns true if the file reads byte 0 as the lowest byte of a number whose other bytes change. Such a byte changes
/// most often, so one that stands does not belong to the number.
bool lowestByteStands(const codec::Wire& wire, const Capture& capture, size_t size) {
  for (const codec::Field& field : wire.input.fields) {
    const bool whole = field.type == codec::Type::kUnsigned || field.type == codec::Type::kSigned;
    if (!whole || field.big_endian || field.at != 0 || field.bit_skip != 0 || field.bits < 16) continue;
    for (size_t at = 1; at < std::min(field.bytes(), size); ++at)
      if (!stands(capture, at)) return true;
  }
  return false;
}

/// What the checksum, firmware number and constants of the file say.
enum class Judgement { kNone, kRight, kWrong };

/// Judges the reports without their first byte, or with it.
Judgement judged(codec::Wire wire, Capture capture, size_t size, bool without_first) {
  const std::vector<codec::Field>& fields = wire.input.fields;
  if (std::none_of(fields.begin(), fields.end(), std::mem_fn(&codec::Field::judges))) return Judgement::kNone;
  if (without_first)
    for (Transfer& transfer : capture.transfers) transfer.bytes.erase(transfer.bytes.begin());
  wire.input.size = size - (without_first ? 1 : 0);
  const Decoded decoded = decodeCapture(wire, capture);
  const double good = static_cast<double>(decoded.good()) / static_cast<double>(capture.transfers.size());
  return good > kNearlyAll ? Judgement::kRight : Judgement::kWrong;
}

bool isPacket(size_t bytes) {
  return bytes >= kLeastPacket && std::has_single_bit(bytes);
}

std::string sizeToGive(size_t given, size_t size) {
  return "wire.input size: " + std::to_string(size) + " (it is " + std::to_string(given) + ")";
}

/// Returns the text about a 0x00 in front of reports. @param padded true if the last bytes may be padding
std::string zeroWords(size_t given, size_t size, bool padded) {
  return "each report begins with 0x00 and has " +
         (size == given + 1 ? std::string("one byte too many") : std::to_string(size) + " bytes") +
         ": some programs put 00 in front of reports without an id; "
         "if yours did, remove it from each line of the capture, and " +
         (given == size - 1 ? "leave wire.input as it is" : "give " + sizeToGive(given, size - 1)) +
         (padded
              ? "; if it belongs to the report instead, and the last bytes are padding, give " + sizeToGive(given, size)
              : "") +
         "\n";
}

std::string idWords(int id, size_t given, size_t size) {
  return "each report begins with " + hexByte(id) +
         ", which is not the first byte of a number: if it is the report id, give wire.input id: " +
         std::to_string(id) + " and " + sizeToGive(given, size - 1) + "; size and offsets do not count the id\n";
}

}  // namespace

std::string leadingByte(const codec::Wire& wire, const Capture& capture) {
  if (wire.framing.used || wire.input.id >= 0) return "";
  const size_t given = wire.input.size, size = sizeOfAll(capture);
  if (size < 2 || size < given) return "";
  const int front = capture.transfers.front().bytes.front();
  const bool certain = lowestByteStands(wire, capture, size);
  if (size == given && (!certain || capture.transfers.size() < kFewestOfSize)) return "";
  if (!certain && size != given + 1 && !isPacket(size - 1)) return "";
  if (front != 0 && (!certain || size == given + 1)) return "";  // textHint() handles an id beside the expected bytes
  if (judged(wire, capture, size, true) == Judgement::kWrong) return "";
  const Judgement whole = judged(wire, capture, size, false);
  if (whole == Judgement::kRight) return "";
  if (front != 0) return idWords(front, given, size);
  return zeroWords(given, size, !certain && whole == Judgement::kNone && stands(capture, size - 1));
}

}  // namespace hapticd::capture
