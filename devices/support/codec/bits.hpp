// SPDX-License-Identifier: MIT
/// Numbers of 1 to 64 bits that begin at any bit of a sequence of bytes.
///
/// Little endian counts bits from the lowest bit of the first byte upward. Big endian counts from the highest bit
/// downward, which is the order of bits on paper. For whole bytes this is the usual byte order.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace hapticd::codec {

/// Returns a number whose lowest `bits` bits (0 to 64) are ones.
constexpr uint64_t onesOf(unsigned bits) noexcept {
  return bits >= 64 ? ~uint64_t{0} : (uint64_t{1} << bits) - 1;
}

/// [any] Returns the number of `bits` bits that begins `skip` bits after the beginning of bytes[0].
inline uint64_t getBits(const uint8_t* bytes, size_t skip, unsigned bits, bool big_endian) noexcept {
  bytes += skip / 8;
  auto offset = static_cast<unsigned>(skip % 8);
  uint64_t value = 0;
  for (unsigned got = 0; got < bits; offset = 0, ++bytes) {
    const unsigned take = std::min(8 - offset, bits - got);
    const uint64_t part = *bytes >> (big_endian ? 8 - offset - take : offset) & onesOf(take);
    value = big_endian ? value << take | part : value | part << got;
    got += take;
  }
  return value;
}

/// [any] Writes a number of `bits` bits to the same place. The bits around it stay.
inline void putBits(uint64_t value, uint8_t* bytes, size_t skip, unsigned bits, bool big_endian) noexcept {
  bytes += skip / 8;
  auto offset = static_cast<unsigned>(skip % 8);
  for (unsigned done = 0; done < bits; offset = 0, ++bytes) {
    const unsigned take = std::min(8 - offset, bits - done);
    const unsigned shift = big_endian ? 8 - offset - take : offset;
    const auto part = static_cast<uint8_t>((value >> (big_endian ? bits - done - take : done) & onesOf(take)) << shift);
    *bytes = static_cast<uint8_t>((*bytes & ~(onesOf(take) << shift)) | part);
    done += take;
  }
}

}  // namespace hapticd::codec
