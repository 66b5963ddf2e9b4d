// SPDX-License-Identifier: MIT
#include "capture/byte_order_hint.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "codec/bits.hpp"

namespace hapticd::capture {
namespace {

using codec::Field;
using codec::Type;

constexpr size_t kFewestSteps = 20;  ///< [steps] least number of steps in which the joint moves

uint64_t swapped(uint64_t code, unsigned bits) {
  uint64_t other = 0;
  for (unsigned byte = 0; byte < bits; byte += 8) other = other << 8 | (code >> byte & 0xff);
  return other;
}

/// The steps of a number from one report to the next, as a number that wraps makes them: at most half of its range.
struct Steps {
  double sum = 0;     ///< sum of their sizes, as a share of the range
  size_t moving = 0;  ///< number of steps that are not zero
  size_t large = 0;   ///< number of steps of more than an eighth of the range
};

Steps stepsOf(const std::vector<uint64_t>& codes, unsigned bits) {
  constexpr double kLarge = 0.125;
  const uint64_t ones = codec::onesOf(bits);
  Steps steps;
  for (size_t i = 1; i < codes.size(); ++i) {
    const uint64_t up = (codes[i] - codes[i - 1]) & ones, down = (codes[i - 1] - codes[i]) & ones;
    const double share = std::ldexp(static_cast<double>(std::min(up, down)), -static_cast<int>(bits));
    steps.sum += share;
    steps.moving += share > 0 ? 1 : 0;
    steps.large += share > kLarge ? 1 : 0;
  }
  return steps;
}

/// True if both the first and the last byte change: otherwise the joint moved too little to show the order, or the
/// board leaves one byte empty.
bool bothEndsChange(const std::vector<uint64_t>& codes, unsigned bits) {
  uint64_t changed = 0;
  for (const uint64_t code : codes) changed |= code ^ codes.front();
  return (changed & 0xff) != 0 && (changed >> (bits - 8) & 0xff) != 0;
}

}  // namespace

std::string wrongByteOrder(const Field& field, const std::vector<double>& positions) {
  constexpr double kSmoother = 8;  // factor: two orders of two bytes differ by up to 256
  const unsigned bits = field.bits;
  const bool whole = field.type == Type::kUnsigned || field.type == Type::kSigned;
  if (!whole || bits > 48 || positions.size() <= kFewestSteps) return "";
  std::vector<uint64_t> codes, other;
  for (const double position : positions) {
    const auto code = static_cast<int64_t>(std::nearbyint((position - field.offset) / field.scale));
    codes.push_back(static_cast<uint64_t>(code) & codec::onesOf(bits));
    if (bits % 8 == 0) other.push_back(swapped(codes.back(), bits));
  }
  const Steps as_read = stepsOf(codes, bits);
  if (as_read.moving < kFewestSteps) return "";
  if (bits > 8 && bits % 8 == 0 && field.bit_skip == 0 && bothEndsChange(codes, bits) &&
      as_read.sum > kSmoother * stepsOf(other, bits).sum)
    return "moves far more smoothly from one report to the next if its bytes "
           "are read in the other order: give endian: " +
           std::string(field.big_endian ? "little" : "big");
  if (!field.wraps || 2 * as_read.large < as_read.moving) return "";
  return "jumps by more than an eighth of its type's range in " + std::to_string(as_read.large) + " of " +
         std::to_string(codes.size() - 1) +
         " steps, like a random number: look at its byte order (endian), "
         "its first byte (at), and the width of its type";
}

}  // namespace hapticd::capture
