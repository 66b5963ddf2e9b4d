// SPDX-License-Identifier: MIT
/// A checksum that also covers one byte before the bytes of a report, such as its id.
#pragma once
#include "codec/checksum.hpp"

namespace hapticd::codec {

/// [any] Returns a check whose result over some bytes is the result of `check` over `first` followed by those bytes. A
/// sum or xor must have words of one byte.
inline Check startedWith(Check check, uint8_t first) noexcept {
  if (check.method == Checksum::kSum) check.initial += first;
  if (check.method == Checksum::kXor) check.initial ^= first;
  if (check.method != Checksum::kCrc) return check;
  Check plain = check;
  plain.final_xor = 0;
  const uint64_t state = checksumOf(plain, {&first, 1});
  check.initial = check.reflected ? 0 : state;  // a result is mirrored if reflected, `initial` is not
  for (unsigned i = 0; check.reflected && i < check.bits; ++i)
    check.initial |= (state >> i & 1) << (check.bits - 1u - i);
  return check;
}

}  // namespace hapticd::codec
