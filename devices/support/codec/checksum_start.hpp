// SPDX-License-Identifier: MIT
/// A checksum that begins with a byte which is not among the bytes of a report, such as its id.
#pragma once
#include "codec/checksum.hpp"

namespace hapticd::codec {

/// [any] A check whose result over some bytes is that of `check` over `first` and then those bytes. A sum or xor takes
/// one byte at a time.
inline Check startedWith(Check check, uint8_t first) noexcept {
  if (check.method == Checksum::kSum) check.initial += first;
  if (check.method == Checksum::kXor) check.initial ^= first;
  if (check.method != Checksum::kCrc) return check;
  Check plain = check;
  plain.final_xor = 0;
  const uint64_t state = checksumOf(plain, {&first, 1});
  check.initial = check.reflected ? 0 : state;  // a reflected check gives its state mirrored, and takes it straight
  for (unsigned i = 0; check.reflected && i < check.bits; ++i)
    check.initial |= (state >> i & 1) << (check.bits - 1u - i);
  return check;
}

}  // namespace hapticd::codec
