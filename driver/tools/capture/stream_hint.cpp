// SPDX-License-Identifier: MIT
#include "capture/stream_hint.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <vector>

namespace hapticd::capture {
namespace {

using Bytes = std::vector<uint8_t>;

constexpr size_t kFewestAlike = 20;  ///< reports: fewer may have one byte in common by chance

/// A byte that occurs once in every report, and hardly anywhere else.
struct Header {
  uint8_t byte = 0;
  size_t at = 0;  ///< of the capture
};

/// 0 and 0xff are the upper bytes of small numbers; a byte that occurs in many places is no mark either.
std::optional<Header> headerAt(const Bytes& bytes, size_t size, size_t at) {
  const uint8_t byte = bytes[at];
  if (byte == 0 || byte == 0xff) return std::nullopt;
  for (size_t next = at; next < bytes.size(); next += size)
    if (bytes[next] != byte) return std::nullopt;
  const auto all = static_cast<size_t>(std::count(bytes.begin(), bytes.end(), byte));
  const size_t reports = bytes.size() / size;
  return 2 * all <= 3 * (reports + 1) ? std::optional(Header{byte, at}) : std::nullopt;
}

std::optional<Header> headerOf(const Bytes& bytes, size_t size) {
  if (bytes.size() / size < kFewestAlike) return std::nullopt;
  for (size_t at = 0; at < size; ++at)
    if (const auto header = headerAt(bytes, size, at)) return header;
  return std::nullopt;
}

/// True if the file says that byte 0 begins a report, or says nothing about it, and has other numbers where the header
/// is.
bool beginsLater(const codec::Report& report, const Header& header) {
  const auto covers = [](const codec::Field& field, size_t byte) {
    return field.role != codec::Role::kChecksum && field.at <= byte && byte < field.at + field.bytes();
  };
  bool first = false, there = false;
  for (const codec::Field& field : report.fields) {
    const bool constant = field.role == codec::Role::kConstant || field.role == codec::Role::kFirmware;
    if (constant && field.at == 0 && field.code == header.byte) return true;
    first |= covers(field, 0);
    there |= covers(field, header.at);
  }
  return !first && there;
}

std::string framingOf(const Header& header) {
  char text[48];
  std::snprintf(text, sizeof text, "framing: {start: 0x%02x}", static_cast<unsigned>(header.byte));
  return text;
}

}  // namespace

std::string streamHint(const codec::Wire& wire, const Capture& capture, const Decoded& decoded) {
  if (wire.framing.used || wire.input.id >= 0 || capture.text || capture.transfers.empty()) return "";
  const Bytes& bytes = capture.transfers.front().bytes;
  const size_t size = wire.input.size;
  char begins[64];
  if (const auto header = headerOf(bytes, size)) {
    if (header->at == 0 || !beginsLater(wire.input, *header)) return "";
    std::snprintf(begins, sizeof begins, "0x%02x", static_cast<unsigned>(header->byte));
    return std::string(begins) + " stands at byte " + std::to_string(header->at) + " of the capture and every " +
           std::to_string(size) +
           " bytes after it: if it begins each report, the capture begins in the middle of one; give " +
           framingOf(*header) + ", and they are found\n";
  }
  if (2 * decoded.good() > decoded.reports.size() && bytes.size() % size == 0) return "";
  for (size_t other = size + 1; other <= std::min(2 * size, codec::kMaxReportBytes); ++other)
    if (const auto header = headerOf(bytes, other)) {
      std::snprintf(begins, sizeof begins, "0x%02x", static_cast<unsigned>(header->byte));
      return std::string(begins) + " stands at every " + std::to_string(other) + " bytes, first at byte " +
             std::to_string(header->at) + ": if it begins each report, give " + framingOf(*header) +
             " and wire.input size: " + std::to_string(other) + " (it is " + std::to_string(size) +
             "); size and offsets count this byte\n";
    }
  return "";
}

}  // namespace hapticd::capture
