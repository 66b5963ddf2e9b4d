// SPDX-License-Identifier: MIT
#include "capture/layout_hint.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <optional>
#include <vector>

#include "capture/leading_byte.hpp"

namespace hapticd::capture {
namespace {

using Bytes = std::vector<uint8_t>;

constexpr size_t kRepeated = 3;  ///< [reports] fewer than this may look alike by chance

std::string idLacks(int id) {
  return "each bad report begins with " + hexByte(id) + " and has one byte too many: if this is the report id, give " +
         "wire.input id: " + std::to_string(id) + "; size and offsets do not count it\n";
}

/// Returns the text of idLacks() and a second possibility, because raw bytes may come from a stream without ids.
std::string idOrMarkLacks(int id) {
  std::string words = idLacks(id);
  words.pop_back();
  return words + ". If the bytes are a stream without ids, give framing: {start: " + hexByte(id) +
         "}, with size and all offsets one larger\n";
}

std::string idIsMissing(int id) {
  return "each bad report has one byte too few: if they were captured without the report id, put " + hexByte(id) +
         " in front of each, or leave wire.input id out\n";
}

/// Returns the hint for reports that begin with the id, if the size in the file counts the id by mistake.
std::string sizeCountsTheId(const codec::Wire& wire) {
  return "each bad report begins with " + hexByte(wire.input.id) +
         ", the report id, and has one byte too few: wire.input size must not "
         "include the id; give wire.input size: " +
         std::to_string(wire.input.size - 1) + " (it is " + std::to_string(wire.input.size) + ")\n";
}

/// Returns true if nearly all bad reports have one byte less than expected and begin with the id.
bool idWasCounted(const codec::Wire& wire, const Decoded& decoded) {
  if (wire.input.id < 0 || decoded.bad.size() < kRepeated || 2 * decoded.good() > decoded.reports.size()) return false;
  const auto counted = std::count_if(decoded.bad.begin(), decoded.bad.end(), [&](const BadReport& bad) {
    return bad.wrong == nullptr && bad.bytes.size() == wire.input.size && bad.bytes.front() == wire.input.id;
  });
  return 10 * counted >= 9 * static_cast<std::ptrdiff_t>(decoded.bad.size());
}

/// Returns true if all bad reports have the same wrong size.
bool allOfOneSize(const Decoded& decoded) {
  return !decoded.bad.empty() && decoded.good() == 0 &&
         std::all_of(decoded.bad.begin(), decoded.bad.end(), [&](const BadReport& bad) {
           return bad.wrong == nullptr && bad.bytes.size() == decoded.bad.front().bytes.size();
         });
}

/// Declared before paddingHint(), which calls it; its definition has the description.
std::optional<double> goodWith(codec::Wire wire, int id, size_t size, const Capture& capture);

/// Returns true if the bytes from `from` on are the same in all reports of this size, so that they are probably
/// padding.
bool tailStands(const Capture& capture, size_t size, size_t from) {
  const Bytes* first = nullptr;
  size_t reports = 0;
  for (const Transfer& transfer : capture.transfers) {
    const Bytes& bytes = transfer.bytes;
    if (bytes.size() % size != 0) return false;
    if (first == nullptr) first = &bytes;
    for (size_t at = 0; at < bytes.size(); at += size, ++reports)
      for (size_t i = from; i < size; ++i)
        if (bytes[at + i] != (*first)[i]) return false;
  }
  return reports >= kRepeated;
}

/// Returns a hint if reports are longer than the fields need and end with padding, as with HID and bulk endpoints.
std::string paddingHint(const codec::Wire& wire, const Capture& capture, size_t size) {
  const size_t used = wire.input.bytes(), body = size - (used - wire.input.size);
  if (size <= used || !tailStands(capture, size, used)) return "";
  if (goodWith(wire, wire.input.id, body, capture).value_or(1) <= kNearlyAll) return "";
  return "every report has " + std::to_string(size) + " bytes, and those behind byte " + std::to_string(used) +
         " never change: if they are padding, give wire.input size: " + std::to_string(body) + " (it is " +
         std::to_string(wire.input.size) + ")\n";
}

/// Returns true if every line has the size of a report without its id.
bool linesLackTheId(const codec::Wire& wire, const Capture& capture) {
  return wire.input.id >= 0 && capture.text && !capture.transfers.empty() &&
         std::all_of(capture.transfers.begin(), capture.transfers.end(),
                     [&](const Transfer& transfer) { return transfer.bytes.size() == wire.input.size; });
}

std::string textHint(const codec::Wire& wire, const Capture& capture, const Decoded& decoded) {
  if (!allOfOneSize(decoded)) return "";
  const Bytes& bytes = decoded.bad.front().bytes;
  const size_t size = bytes.size(), expected = wire.input.bytes();
  const bool same = std::all_of(decoded.bad.begin(), decoded.bad.end(),
                                [&](const BadReport& bad) { return bad.bytes.front() == bytes.front(); });
  if (size == expected + 1 && same && wire.input.id < 0 && bytes.front() != 0) return idLacks(bytes.front());
  if (size + 1 == expected && wire.input.id >= 0) return idIsMissing(wire.input.id);
  // If the rest of a line repeats one byte, it is padding and not further reports.
  const bool one_byte = size > expected && std::all_of(bytes.begin() + static_cast<long>(expected), bytes.end(),
                                                       [&](uint8_t byte) { return byte == bytes.back(); });
  const std::string padded = size % expected != 0 || one_byte ? paddingHint(wire, capture, size) : "";
  if (!padded.empty()) return padded;
  if (size > expected && size % expected == 0)
    return std::to_string(size) + " bytes in a line are " + std::to_string(size / expected) + " reports of " +
           std::to_string(expected) + " bytes; expected one report per line\n";
  return "";
}

/// Returns the byte at every multiple of `size`; nothing if these bytes differ or are too few.
std::optional<int> everyFirst(const Bytes& bytes, size_t size) {
  if (size == 0 || bytes.size() % size != 0 || bytes.size() / size < kRepeated) return std::nullopt;
  for (size_t at = size; at < bytes.size(); at += size)
    if (bytes[at] != bytes[0]) return std::nullopt;
  return bytes[0];
}

/// Returns which share of the reports would be good with another id and size. Returns nothing if every report would be
/// good, because there is no checksum, firmware number or constant.
std::optional<double> goodWith(codec::Wire wire, int id, size_t size, const Capture& capture) {
  std::vector<codec::Field>& fields = wire.input.fields;
  if (std::none_of(fields.begin(), fields.end(), std::mem_fn(&codec::Field::judges))) return std::nullopt;
  wire.input.id = id, wire.input.size = size;
  for (codec::Field& field : fields) {
    if (field.at + field.bytes() > size || field.to > size) return 0.0;
  }
  const Decoded decoded = decodeCapture(wire, capture);
  return static_cast<double>(decoded.good()) / static_cast<double>(std::max<size_t>(decoded.reports.size(), 1));
}

/// Returns the smallest size with which every report begins with the id.
size_t sizeWithId(const Bytes& bytes, int id) {
  for (size_t size = 2; size <= codec::kMaxReportBytes; ++size)
    if (everyFirst(bytes, size) == id) return size;
  return 0;
}

std::string withoutAnId(const codec::Wire& wire, const Capture& capture, const Bytes& bytes) {
  const size_t size = wire.input.size;
  const auto first = everyFirst(bytes, size + 1);
  if (first && *first != 0 && !everyFirst(bytes, size) &&
      goodWith(wire, *first, size, capture).value_or(1) > kNearlyAll)
    return idOrMarkLacks(*first);
  for (size_t other = 1; other <= std::min(2 * size, codec::kMaxReportBytes - 1); ++other)
    if (other != size && bytes.size() % other == 0 && bytes.size() / other >= kRepeated &&
        goodWith(wire, -1, other, capture).value_or(0) > kNearlyAll)
      return "as reports of " + std::to_string(other) +
             " bytes they are good: give wire.input size: " + std::to_string(other) + "\n";
  for (const size_t padded : {8, 16, 32, 64, 128, 256, 512})  // sizes to which USB devices pad their packets
    if (padded > size)
      if (const std::string told = paddingHint(wire, capture, padded); !told.empty()) return told;
  return "";
}

std::string withAnId(const codec::Wire& wire, const Capture& capture, const Bytes& bytes) {
  const int id = wire.input.id;
  const size_t size = wire.input.size;
  // there is an id at the beginning of each report, which another hint handles
  if (everyFirst(bytes, size + 1)) return "";
  if (goodWith(wire, -1, size, capture).value_or(0) > kNearlyAll) return idIsMissing(id);
  const size_t whole = sizeWithId(bytes, id);
  if (whole == 0) return "";
  return hexByte(id) + " occurs every " + std::to_string(whole) + " bytes: if it begins each report, give " +
         "wire.input size: " + std::to_string(whole - 1) + " (it is " + std::to_string(size) +
         "); size does not count the report id\n";
}

/// Returns a hint if the reports have an id other than the one in the file.
std::string otherIdHint(const codec::Wire& wire, const Decoded& decoded) {
  if (!decoded.reports.empty() || decoded.other_ids.size() != 1 || decoded.others < kRepeated) return "";
  const int id = *decoded.other_ids.begin();
  return "each report begins with " + hexByte(id) + ", expected " + hexByte(wire.input.id) +
         ": if this is the report id, give wire.input id: " + std::to_string(id) + "\n";
}

}  // namespace

std::string hexByte(int byte) {
  char text[8];
  std::snprintf(text, sizeof text, "0x%02x", static_cast<unsigned>(byte));
  return text;
}

std::string layoutHint(const codec::Wire& wire, const Capture& capture, const Decoded& decoded) {
  if (wire.framing.used) return "";
  if (const std::string front = leadingByte(wire, capture); !front.empty()) return front;
  if (capture.text && idWasCounted(wire, decoded)) return sizeCountsTheId(wire);
  if (decoded.good() == 0 && linesLackTheId(wire, capture)) return idIsMissing(wire.input.id);
  if (const std::string other = otherIdHint(wire, decoded); !other.empty()) return other;
  if (capture.text) return textHint(wire, capture, decoded);
  const size_t all = decoded.reports.size() + decoded.others;
  const Bytes& bytes = capture.transfers.empty() ? Bytes() : capture.transfers.front().bytes;
  const bool fits = bytes.size() % wire.input.bytes() == 0 && 2 * decoded.good() > all;
  if (fits || bytes.empty()) return "";
  return wire.input.id < 0 ? withoutAnId(wire, capture, bytes) : withAnId(wire, capture, bytes);
}

}  // namespace hapticd::capture
