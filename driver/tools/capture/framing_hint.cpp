// SPDX-License-Identifier: MIT
#include "capture/framing_hint.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "capture/layout_hint.hpp"

namespace hapticd::capture {
namespace {

using codec::Escape;
using codec::Field;
using codec::Role;

constexpr size_t kFewestGood = 5;         ///< [reports] fewer than this may be good by chance
constexpr size_t kTriedBytes = 8 * 1024;  ///< [bytes] only the first are used, because a thousand framings are tried

/// Returns the beginning of the capture, which represents all of it.
Capture beginOf(const Capture& capture) {
  Capture begin;
  begin.text = capture.text;
  size_t left = kTriedBytes;
  for (const Transfer& transfer : capture.transfers) {
    if (left == 0) break;
    begin.transfers.push_back(transfer);
    std::vector<uint8_t>& bytes = begin.transfers.back().bytes;
    bytes.resize(std::min(bytes.size(), left));
    left -= bytes.size();
  }
  return begin;
}

/// Returns the same format with other marks. Constants at the places of the old marks get the values of the new ones.
codec::Wire withMarks(codec::Wire wire, int start, int end) {
  for (Field& field : wire.input.fields) {
    const bool constant = field.role == Role::kConstant && field.bits == 8 && field.bit_skip == 0;
    const bool first = constant && field.at == 0 && static_cast<int>(field.code) == wire.framing.start;
    const bool last = constant && field.at + 1u == wire.input.size && static_cast<int>(field.code) == wire.framing.end;
    if (first || last) field.code = static_cast<uint64_t>(first ? start : end), field.value = first ? start : end;
  }
  wire.framing.start = start, wire.framing.end = end;
  return wire;
}

/// Returns true if a report has a field other than the marks (checksum, firmware number or constant) that would be
/// wrong with a wrong framing.
bool judges(const codec::Wire& wire) {
  return std::any_of(wire.input.fields.begin(), wire.input.fields.end(), [&](const Field& field) {
    const bool mark =
        field.role == Role::kConstant && field.bits == 8 &&
        (field.at == 0 ? wire.framing.start >= 0 : field.at + 1u == wire.input.size && wire.framing.end >= 0);
    return field.judges() && !mark;
  });
}

/// Returns about which share of the bytes is in good reports; 0 if there are fewer than kFewestGood.
double goodWith(const codec::Wire& wire, const Capture& begin) {
  const Decoded decoded = decodeCapture(wire, begin);
  const size_t good = decoded.good();
  if (good < kFewestGood) return 0;
  const double lost = static_cast<double>(decoded.lost) / static_cast<double>(wire.input.bytes());
  return static_cast<double>(good) / (static_cast<double>(decoded.reports.size()) + lost);
}

codec::Wire withEscape(codec::Wire wire, uint8_t mark, uint8_t flip) {
  Escape escape;
  escape.used = true, escape.mark = mark, escape.flip = flip;
  wire.framing.escape = escape;
  return wire;
}

codec::Wire asSlip(codec::Wire wire) {
  Escape escape;
  escape.used = true, escape.mark = 0xdb, escape.count = 2;
  escape.plain = {0xc0, 0xdb}, escape.code = {0xdc, 0xdd};
  wire.framing.escape = escape;
  return wire;
}

bool isMark(const codec::Wire& wire, int byte) {
  return byte == wire.framing.start || byte == wire.framing.end;
}

/// The best of the framings that were tried; the first one among equals.
struct Best {
  const Capture& begin;
  double part;  ///< share of the bytes in good reports, which a framing must exceed
  std::string words;
  void add(const codec::Wire& wire, const std::string& how) {
    const double good = goodWith(wire, begin);
    if (good > part) part = good, words = how;
  }
};

/// Tries other escapes, the usual ones first.
void tryEscapes(const codec::Wire& wire, Best& best) {
  const Escape& escape = wire.framing.escape;
  const auto addEscape = [&](int mark, int flip) {
    if (!isMark(wire, mark))
      best.add(withEscape(wire, static_cast<uint8_t>(mark), static_cast<uint8_t>(flip)),
               "with framing.escape: {mark: " + hexByte(mark) + ", xor: " + hexByte(flip) + "}");
  };
  for (int flip = 1; escape.used && flip < 256; ++flip) addEscape(escape.mark, flip);
  for (const int flip : {0x20, 0xff, 0x80, 0x40})
    for (int mark = 0; mark < 256; ++mark) addEscape(mark, flip);
  if (!isMark(wire, 0xdb))
    best.add(asSlip(wire), "with framing.escape: {mark: 0xdb, codes: [[0xc0, 0xdc], [0xdb, 0xdd]]}");
  codec::Wire plain = wire;
  plain.framing.escape = {};
  if (escape.used) best.add(plain, "without framing.escape");
}

/// Tries another start mark, and with it another end mark if both were the same.
void tryMarks(const codec::Wire& wire, Best& best) {
  const codec::Framing& framing = wire.framing;
  const bool both = framing.start == framing.end;
  for (int mark = 0; mark < 256; ++mark) {
    if (framing.escape.used && mark == framing.escape.mark) continue;
    if (framing.start >= 0)
      best.add(withMarks(wire, mark, both ? mark : framing.end),
               "with framing.start" + std::string(both ? " and end: " : ": ") + hexByte(mark));
    if (framing.end >= 0 && !both) best.add(withMarks(wire, framing.start, mark), "with framing.end: " + hexByte(mark));
  }
}

/// Returns how often each byte occurs in the capture.
std::array<size_t, 256> countsOf(const Capture& capture) {
  std::array<size_t, 256> counts{};
  for (const Transfer& transfer : capture.transfers)
    for (const uint8_t byte : transfer.bytes) ++counts[byte];
  return counts;
}

std::string missingMark(const codec::Wire& wire, const Capture& capture) {
  const auto counts = countsOf(capture);
  for (const auto& [key, mark] : {std::pair{"start", wire.framing.start}, std::pair{"end", wire.framing.end}})
    if (mark >= 0 && counts[static_cast<size_t>(mark)] == 0)
      return "framing." + std::string(key) + " " + hexByte(mark) +
             " does not occur in the capture: look at the bytes with which its reports begin and end\n";
  return "";
}

}  // namespace

std::string framingHint(const codec::Wire& wire, const Capture& capture, const Decoded& decoded) {
  const size_t bytes = capture.bytes();
  if (!wire.framing.used || bytes == 0 || (decoded.good() == decoded.reports.size() && decoded.lost == 0)) return "";
  const Capture begin = beginOf(capture);
  if (judges(wire)) {
    constexpr double kBetter = 0.005;  // a small gain counts, because bytes that must be escaped are rare
    const double now = goodWith(wire, begin);
    Best best{begin, std::max(kNearlyAll, now + kBetter), ""};
    tryEscapes(wire, best);
    if (best.words.empty() && now < kNearlyAll) tryMarks(wire, best);
    if (!best.words.empty())
      return (now < kNearlyAll ? "nearly all reports are good " : "more reports are good ") + best.words + "\n";
  }
  if (const std::string missing = missingMark(wire, capture); !missing.empty()) return missing;
  return 2 * decoded.lost < bytes
             ? ""
             : "most bytes are not between marks: check start, end and escape of framing, and size of wire.input\n";
}

}  // namespace hapticd::capture
