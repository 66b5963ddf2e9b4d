// SPDX-License-Identifier: MIT
#include "capture/hints.hpp"

#include <algorithm>
#include <cstdio>
#include <set>
#include <vector>

#include "codec/checksum_start.hpp"

namespace hapticd::capture {
namespace {

using codec::Checksum;
using codec::Field;

/// Fewer reports than that agree with some method by chance.
constexpr size_t kEnough = 3;
/// Of the reports whose checksum is wrong: some of them are really damaged.
constexpr double kMost = 0.8;
/// Of so many wrong reports one may be right by chance.
constexpr size_t kChance = 50;

std::string hexByte(uint8_t byte) {
  char text[8];
  std::snprintf(text, sizeof text, "0x%02x", byte);
  return text;
}

/// Every bad report is of one and the same wrong size.
bool allOfOneSize(const Decoded& decoded) {
  return !decoded.bad.empty() && decoded.good() == 0 &&
         std::all_of(decoded.bad.begin(), decoded.bad.end(), [&](const BadReport& bad) {
           return bad.wrong == nullptr && bad.bytes.size() == decoded.bad.front().bytes.size();
         });
}

std::string sizeHint(const codec::Wire& wire, const Decoded& decoded) {
  if (!allOfOneSize(decoded)) return "";
  const std::vector<uint8_t>& bytes = decoded.bad.front().bytes;
  const size_t size = bytes.size(), expected = wire.input.bytes();
  const bool same = std::all_of(decoded.bad.begin(), decoded.bad.end(),
                                [&](const BadReport& bad) { return bad.bytes.front() == bytes.front(); });
  if (size == expected + 1 && same && wire.input.id < 0 && bytes.front() != 0)
    return "each begins with " + hexByte(bytes.front()) +
           " and has one byte too many: if this is the report id, give " +
           "wire.input id: " + std::to_string(bytes.front()) + "; size and offsets do not count it\n";
  if (size + 1 == expected && wire.input.id >= 0)
    return "each has one byte too few: if they were captured without the report id, put " +
           hexByte(static_cast<uint8_t>(wire.input.id)) + " in front of each, or leave wire.input id out\n";
  if (size > expected && size % expected == 0)
    return std::to_string(size) + " bytes are " + std::to_string(size / expected) + " reports of " +
           std::to_string(expected) + ": a line of text is one report, expected one a line\n";
  return "";
}

using Reports = std::vector<const BadReport*>;

size_t fitting(const Field& field, const Reports& reports) {
  return static_cast<size_t>(std::count_if(reports.begin(), reports.end(), [&](const BadReport* bad) {
    return codec::codeAt(field, bad->bytes) == codec::checksumAt(field, bad->bytes);
  }));
}

/// A method, and how many reports agree with it.
struct Fit {
  std::string name;
  size_t count = 0;
};

/// The method and byte order that agree with most of them, also with the report id in front (-1: it has none).
Fit bestMethod(Field field, const Reports& reports, int id) {
  Fit best;
  std::vector<codec::NamedCrc> all(codec::namedCrcs().begin(), codec::namedCrcs().end());
  codec::Check plain;
  plain.bits = field.bits;
  plain.method = Checksum::kSum, all.push_back({"sum", plain, 0});
  plain.method = Checksum::kXor, all.push_back({"xor", plain, 0});
  for (const codec::NamedCrc& one : all)
    for (int way = 0; way < (id < 0 ? 2 : 4); ++way) {
      const bool big = way % 2 == 1, over_id = way >= 2;
      if (one.check.bits > field.bits || (big && field.bits <= 8)) continue;
      field.check = over_id ? codec::startedWith(one.check, static_cast<uint8_t>(id)) : one.check;
      field.check.big_endian = field.big_endian = big;
      const size_t count = fitting(field, reports);
      if (count <= best.count) continue;
      best = {std::string(one.name) + ", endian: " + (big ? "big" : "little") + (over_id ? ", over_id: true" : ""),
              count};
    }
  return best;
}

std::string checksumHint(const Decoded& decoded, int id) {
  const Field* field = nullptr;
  Reports sums;
  std::set<std::string> different;
  for (const BadReport& bad : decoded.bad) {
    if (bad.wrong == nullptr || bad.wrong->role != codec::Role::kChecksum) continue;
    if (field != nullptr && bad.wrong != field) return "";
    field = bad.wrong;
    sums.push_back(&bad);
    different.insert(hexText(bad.bytes.data(), bad.bytes.size()));
  }
  // One report in 256 has the bytes of its checksum equal, and is right in the wrong order as well.
  if (decoded.good() * kChance > decoded.reports.size() || different.size() < kEnough) return "";
  const Fit best = bestMethod(*field, sums, id);
  if (static_cast<double>(best.count) < kMost * static_cast<double>(sums.size()))
    return "no method that is known by name fits them either, from byte " + std::to_string(field->from) + " to " +
           std::to_string(field->to - 1) + (id >= 0 ? ", with the report id in front or without" : "") +
           ": see from, to and at of the checksum\n";
  const bool all = best.count == sums.size() && sums.size() == decoded.bad.size();
  return "the checksum of " +
         (all ? "each" : std::to_string(best.count) + " of the " + std::to_string(decoded.bad.size())) +
         " of them is right with method: " + best.name + "\n";
}

}  // namespace

std::string hintsOf(const codec::Wire& wire, const Decoded& decoded) {
  return sizeHint(wire, decoded) + checksumHint(decoded, wire.input.id);
}

}  // namespace hapticd::capture
