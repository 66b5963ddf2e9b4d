// SPDX-License-Identifier: MIT
#include "capture/stream_hint.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <optional>
#include <vector>

#include "base/counted.hpp"
#include "capture/layout_hint.hpp"

namespace hapticd::capture {
namespace {

using Bytes = std::vector<uint8_t>;

constexpr size_t kFewestAlike = 20;  ///< [reports] fewer than this may have one byte in common by chance

/// A byte that occurs once in every report, and hardly anywhere else.
struct Header {
  uint8_t byte = 0;
  size_t at = 0;  ///< byte of the capture at which it occurs first
};

/// How often each byte occurs in a capture.
using Counts = std::array<size_t, 256>;

/// Returns the byte at `at` if it occurs there in every report. 0 and 0xff do not count, because they are the upper
/// bytes of small numbers; nor does a byte that occurs in many other places.
std::optional<Header> headerAt(const Bytes& bytes, const Counts& counts, size_t size, size_t at) {
  const uint8_t byte = bytes[at];
  const size_t reports = bytes.size() / size;
  if (byte == 0 || byte == 0xff || 2 * counts[byte] > 3 * (reports + 1)) return std::nullopt;
  for (size_t next = at; next < bytes.size(); next += size)
    if (bytes[next] != byte) return std::nullopt;
  return Header{byte, at};
}

std::optional<Header> headerOf(const Bytes& bytes, const Counts& counts, size_t size) {
  if (bytes.size() / size < kFewestAlike) return std::nullopt;
  for (size_t at = 0; at < size; ++at)
    if (const auto header = headerAt(bytes, counts, size, at)) return header;
  return std::nullopt;
}

/// Returns true if the reports of the file begin at the header: byte 0 is that constant, or no field has byte 0 and a
/// field has the byte at which the header was found.
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
  return "framing: {start: " + hexByte(header.byte) + "}";
}

/// Returns true if a report has a checksum, constant or firmware number, which would be wrong at another place.
bool tells(const codec::Report& report) {
  return std::any_of(report.fields.begin(), report.fields.end(), std::mem_fn(&codec::Field::judges));
}

/// Returns the number of bits of a report that are right by chance at a wrong place: of its checksum, and of its
/// constants.
double tellingBits(const codec::Report& report) {
  double bits = 0;
  for (const codec::Field& field : report.fields)
    if (field.judges()) bits += field.bits;
  return bits;
}

/// A byte of the capture from which on reports are good.
struct Beginning {
  size_t before = 0, good = 0, all = 0;  ///< [bytes] before this place; good reports and all reports after it
};

/// Returns the places from which on more reports are good than by chance, the best one first.
std::vector<Beginning> beginnings(const codec::Wire& wire, const Bytes& bytes) {
  constexpr size_t kMostBytes = 8 * 1024;
  constexpr double kSure = 8;  // [bits] one capture in 256 has as many good reports by chance
  const size_t size = wire.input.size, end = std::min(bytes.size(), kMostBytes);
  const double bits = tellingBits(wire.input), places = static_cast<double>(std::bit_width(end));
  std::vector<Beginning> found;
  for (size_t before = 0; before < size && before + size <= end; ++before) {
    Capture later;
    later.transfers.push_back({-1, Bytes(bytes.begin() + static_cast<std::ptrdiff_t>(before),
                                         bytes.begin() + static_cast<std::ptrdiff_t>(end - (end - before) % size))});
    const Decoded decoded = decodeCapture(wire, later);
    const size_t good = decoded.good();
    if (static_cast<double>(good) * bits >= places + kSure) found.push_back({before, good, decoded.reports.size()});
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.good > b.good; });
  return found;
}

std::string howMany(const Beginning& one) {
  if (5 * one.good >= 4 * one.all) return one.all < 3 ? "all reports" : "nearly all reports";
  return std::to_string(one.good) + " of " + std::to_string(one.all) + " reports";
}

/// Says that reports are good from two places on, which are not a whole number of reports apart.
std::string missingBytes(const Beginning& most, const Beginning& next) {
  return "bytes are missing or too many in the middle of the capture: " + std::to_string(most.good) +
         " reports are good if the first one begins at byte " + std::to_string(most.before) + ", and " +
         std::to_string(next.good) + " others if it begins at byte " + std::to_string(next.before) +
         "; record it again, or decode its parts\n";
}

/// Finds where reports begin from the constants and checksum in the file, even if some reports are damaged.
std::string beginHint(const codec::Wire& wire, const Bytes& bytes, const Decoded& decoded) {
  const size_t bad = decoded.reports.size() - decoded.good();
  if (!tells(wire.input) || bad == 0) return "";
  const std::vector<Beginning> found = beginnings(wire, bytes);
  constexpr size_t kMostPlaces = 3;  // reports without contents, such as zeros, are good at most places
  if (found.empty() || found.size() > kMostPlaces) return "";
  if (found.size() > 1 && 3 * found[1].good >= bad) return missingBytes(found[0], found[1]);
  const size_t before = found[0].before;
  if (before == 0) return "";
  const auto& fields = wire.input.fields;
  const auto mark = std::find_if(fields.begin(), fields.end(), [](const codec::Field& field) {
    return field.role == codec::Role::kConstant && field.at == 0 && field.bits == 8 && field.bit_skip == 0;
  });
  const std::string told = "the capture begins in the middle of a report: from byte " + std::to_string(before) +
                           " on, " + howMany(found[0]) + " are good; ";
  if (mark != fields.end())
    return told + "give " + framingOf({static_cast<uint8_t>(mark->code), before}) + ", and the reports are found\n";
  return told + "leave out the first " + counted(before, "byte") + " (tail -c +" + std::to_string(before + 1) +
         " FILE)\n";
}

/// Finds the size of reports, and where they begin, from a byte that they have in common.
std::string headerHint(const codec::Wire& wire, const Bytes& bytes, const Decoded& decoded) {
  const size_t size = wire.input.size;
  Counts counts{};
  for (const uint8_t byte : bytes) ++counts[byte];
  if (const auto header = headerOf(bytes, counts, size)) {
    if (header->at == 0 || !beginsLater(wire.input, *header)) return "";
    return hexByte(header->byte) + " occurs at byte " + std::to_string(header->at) + " of the capture and every " +
           std::to_string(size) +
           " bytes after it: if it begins each report, the capture begins in the middle of one; give " +
           framingOf(*header) + ", and the reports are found\n";
  }
  if (2 * decoded.good() > decoded.reports.size() && bytes.size() % size == 0) return "";
  for (size_t other = size + 1; other <= std::min(2 * size, codec::kMaxReportBytes); ++other)
    if (const auto header = headerOf(bytes, counts, other)) {
      return hexByte(header->byte) + " occurs every " + std::to_string(other) + " bytes, first at byte " +
             std::to_string(header->at) + ": if it begins each report, give " + framingOf(*header) +
             " and wire.input size: " + std::to_string(other) + " (it is " + std::to_string(size) +
             "); size and offsets count this byte\n";
    }
  return "";
}

}  // namespace

std::string streamHint(const codec::Wire& wire, const Capture& capture, const Decoded& decoded) {
  if (wire.framing.used || wire.input.id >= 0 || capture.text || capture.transfers.empty()) return "";
  const Bytes& bytes = capture.transfers.front().bytes;
  const std::string header = headerHint(wire, bytes, decoded);
  return header.empty() ? beginHint(wire, bytes, decoded) : header;
}

}  // namespace hapticd::capture
