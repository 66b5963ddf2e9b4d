// SPDX-License-Identifier: MIT
/// Checksums as data: sums, exclusive ors and cyclic redundancy checks of any width up to 64 bits.
#pragma once
#include <cstdint>
#include <span>

namespace hapticd::codec {

enum class Checksum : uint8_t {
  kSum,  ///< of words, modulo 2^bits
  kXor,  ///< of words
  kCrc,  ///< of bits, after Williams, "A painless guide to CRC error detection algorithms" (1993)
};

struct Check {
  Checksum method = Checksum::kSum;
  uint8_t bits = 8;         ///< of the result, 1 to 64
  uint8_t word = 1;         ///< [bytes] that a sum or xor takes at a time; a shorter rest is taken as it is
  bool big_endian = false;  ///< the order of the bytes of a word
  bool reflected = false;   ///< a CRC that takes the lowest bit of each byte first, and gives its result in that order
  bool negated = false;     ///< the two's complement of a sum: all words and the checksum together give zero
  uint64_t polynomial = 0, initial = 0, final_xor = 0;
};

/// A published CRC by its name, with the result that it must give for the text "123456789".
struct NamedCrc {
  const char* name;
  Check check;
  uint64_t published;
};

/// All published CRCs, smaller ones first. Names and numbers are from the catalogue of parametrised CRCs (Greg Cook).
std::span<const NamedCrc> namedCrcs() noexcept;

/// [any] The checksum of some bytes. The time it takes is bounded by their number.
uint64_t checksumOf(const Check& check, std::span<const uint8_t> bytes) noexcept;

}  // namespace hapticd::codec
