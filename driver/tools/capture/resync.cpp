// SPDX-License-Identifier: MIT
#include "capture/resync.hpp"

#include <algorithm>

namespace hapticd::capture {
namespace {

bool goodAt(const codec::Wire& wire, std::span<const uint8_t> bytes, size_t at) {
  const size_t size = wire.input.bytes();
  if (at + size > bytes.size() || bytes[at] != wire.input.id) return false;
  codec::State state;
  return codec::decode(wire.input, bytes.subspan(at, size), state) == codec::Verdict::kGood;
}

/// Returns true if a good report is at this place. A place may have the id and a right checksum of one byte by chance,
/// so the report after it must begin correctly too.
bool begins(const codec::Wire& wire, std::span<const uint8_t> bytes, size_t at) {
  const size_t next = at + wire.input.bytes();
  return goodAt(wire, bytes, at) && (next >= bytes.size() || bytes[next] == wire.input.id || goodAt(wire, bytes, next));
}

}  // namespace

size_t skipOddBytes(const codec::Wire& wire, std::span<const uint8_t> bytes, size_t at,
                    const std::function<void(std::span<const uint8_t>)>& odd) {
  const bool judged = wire.input.id >= 0 && wire.input.has(codec::Role::kChecksum);
  const size_t size = wire.input.bytes();
  if (!judged || goodAt(wire, bytes, at) || goodAt(wire, bytes, at + size)) return at;
  constexpr size_t kReports = 8;  // [reports] length of the search; the caller repeats it one report farther on
  for (size_t other = at + 1; other < std::min(at + kReports * size, bytes.size()); ++other) {
    if (!begins(wire, bytes, other)) continue;
    if ((other - at) % size == 0) return at;  // no bytes are missing: the reports in between are bad
    odd(bytes.subspan(at, other - at));
    return other;
  }
  return at;
}

}  // namespace hapticd::capture
