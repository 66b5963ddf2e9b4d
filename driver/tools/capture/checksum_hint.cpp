// SPDX-License-Identifier: MIT
#include "capture/checksum_hint.hpp"

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "codec/bits.hpp"
#include "codec/checksum_start.hpp"

namespace hapticd::capture {
namespace {

using codec::Checksum;
using codec::Field;

/// [reports] If fewer different reports than this are bad, a wrong method may fit them by chance, so no hint is given.
constexpr size_t kFewestDifferent = 3;
/// A hint is given only if the checksum is wrong in at least this share of the reports.
constexpr double kMost = 0.8;

using BadReports = std::vector<const BadReport*>;

size_t fitting(const Field& field, const BadReports& reports) {
  size_t count = 0, seen = 0;
  for (const BadReport* bad : reports) {
    count += codec::codeAt(field, bad->bytes) == codec::checksumAt(field, bad->bytes) ? 1 : 0;
    if (++seen == 2 * kFewestDifferent && count == 0) return 0;
  }
  return count;
}

/// A checksum in words, and how many reports agree with it.
struct Fit {
  std::string words;
  size_t count = 0;
};

/// A method, with the words for it in a device file.
struct Method {
  std::string words;
  codec::Check check;
};

std::string onesText(unsigned bits) {
  return "0x" + std::string(bits / 4, 'f');
}

std::vector<Method> methodsFor(const Field& field) {
  std::vector<Method> all;
  for (const codec::NamedCrc& named : codec::namedCrcs()) all.push_back({named.name, named.check});
  const auto add = [&all](const std::string& name, Checksum method, unsigned bits) {
    codec::Check plain;
    plain.method = method, plain.bits = static_cast<uint8_t>(bits);
    all.push_back({name, plain});
  };
  add("sum", Checksum::kSum, field.bits), add("xor", Checksum::kXor, field.bits);
  if (field.bits > 8) add("sum8", Checksum::kSum, 8), add("xor8", Checksum::kXor, 8);
  for (size_t i = codec::namedCrcs().size(), plain = all.size(); i < plain; ++i) {
    const Method method = all[i];
    if (method.check.method == Checksum::kSum)
      all.push_back(method), all.back().check.negated = true, all.back().words += ", negated: true";
    if (method.check.bits % 4 != 0) continue;
    all.push_back(method);
    all.back().check.final_xor = codec::onesOf(method.check.bits);
    all.back().words += ", final_xor: " + onesText(method.check.bits);
  }
  return all;
}

/// A checksum field with another range of bytes, and the words for the difference from the file's field.
struct Range {
  Field field;
  std::string words;
};

/// Finds the method and byte order that agree with most reports over one range of bytes, also with the report id in
/// front of the bytes. @param id report id; -1 if there is none
void tryMethods(const Range& range, const BadReports& reports, int id, Fit& best) {
  Field field = range.field;
  for (const Method& one : methodsFor(field))
    for (int variant = 0; variant < (id < 0 ? 2 : 4); ++variant) {
      const bool big = variant % 2 == 1, over_id = variant >= 2;
      if (one.check.bits > field.bits || (big && field.bits <= 8)) continue;
      field.check = over_id ? codec::startedWith(one.check, static_cast<uint8_t>(id)) : one.check;
      field.check.big_endian = field.big_endian = big;
      const size_t count = fitting(field, reports);
      if (count <= best.count) continue;
      best.words = "method: " + one.words + ", endian: " + (big ? "big" : "little") + range.words;
      if (id >= 0) best.words += over_id ? ", over_id: true" : ", over_id: false";
      best.count = count;
    }
}

/// Returns the checksum field at another place or with another range; nothing if the checksum would cover itself or lie
/// outside the report.
std::optional<Range> otherRange(const codec::Wire& wire, const Field& field, int at, int from, int to) {
  const int end = at + static_cast<int>(field.bytes()), most = static_cast<int>(wire.input.size);
  if (from < 0 || to <= from || to > most || at < 0 || end > most || (at < to && end > from)) return std::nullopt;
  Range range{field, ""};
  if (at != field.at) range.words += ", at: " + std::to_string(at);
  if (from != field.from) range.words += ", from: " + std::to_string(from);
  if (to != field.to) range.words += ", to: " + std::to_string(to);
  range.field.at = static_cast<uint16_t>(at);
  range.field.from = static_cast<uint16_t>(from), range.field.to = static_cast<uint16_t>(to);
  return range;
}

/// Tries other places and ranges, first with the method that the device file gives, which may be a CRC given by its
/// polynomial.
void tryRanges(const codec::Wire& wire, const Field& field, const BadReports& reports, Fit& best) {
  for (const int at : {0, 1, -1})
    for (const int from : {int{field.from}, 0, field.from + 1, field.from - 1})
      for (const int to : {field.at + at, int{field.to}, field.to + 1, field.to - 1}) {
        const auto range = otherRange(wire, field, field.at + at, from, to);
        if (!range || range->words.empty()) continue;
        if (const size_t count = fitting(range->field, reports); count > best.count)
          best = {range->words.substr(2), count};
        tryMethods(*range, reports, wire.input.id, best);
        if (best.count == reports.size()) return;
      }
}

/// Returns the checksum field, and in `sums` the bad reports, if all reports with a wrong checksum have it in the same
/// field.
const Field* onlyChecksum(const Decoded& decoded, BadReports& sums) {
  const Field* field = nullptr;
  std::set<std::string> different;
  for (const BadReport& bad : decoded.bad) {
    if (bad.wrong == nullptr || bad.wrong->role != codec::Role::kChecksum) continue;
    if (field != nullptr && bad.wrong != field) return nullptr;
    field = bad.wrong;
    sums.push_back(&bad);
    different.insert(hexText(bad.bytes.data(), bad.bytes.size()));
  }
  return different.size() < kFewestDifferent ? nullptr : field;
}

}  // namespace

std::string checksumHint(const codec::Wire& wire, const Decoded& decoded) {
  // A wrong method gives the right checksum by chance now and then, such as for one report in 256.
  if (static_cast<double>(decoded.good()) > (1 - kMost) * static_cast<double>(decoded.reports.size())) return "";
  BadReports sums;
  const Field* field = onlyChecksum(decoded, sums);
  if (field == nullptr) return "";
  const double needed = kMost * static_cast<double>(sums.size());
  Fit best;
  tryMethods({*field, ""}, sums, wire.input.id, best);
  if (static_cast<double>(best.count) < needed) tryRanges(wire, *field, sums, best);
  if (static_cast<double>(best.count) < needed)
    return "no method that is known by name fits them either, over the bytes " + std::to_string(field->from) + " to " +
           std::to_string(field->to - 1) + " or one byte more or less" +
           (wire.input.id >= 0 ? ", with or without the report id" : "") + ": check from, to and at of the checksum\n";
  const bool all = best.count == sums.size() && sums.size() == decoded.bad.size();
  return "the checksum of " +
         (all ? "each" : std::to_string(best.count) + " of the " + std::to_string(decoded.bad.size())) +
         " of them is right with " + best.words + "\n";
}

}  // namespace hapticd::capture
