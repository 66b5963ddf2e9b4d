// SPDX-License-Identifier: MIT
/// Checksums as data: sums, exclusive ors and cyclic redundancy checks of any width up to 64 bits.
#pragma once
#include <cstdint>
#include <span>

namespace hapticd::codec {

enum class Checksum : uint8_t {
  kSum,  ///< sum of words, modulo 2^bits
  kXor,  ///< exclusive or of words
  kCrc,  ///< cyclic redundancy check, after Williams, "A painless guide to CRC error detection algorithms" (1993)
};

struct Check {
  Checksum method = Checksum::kSum;
  uint8_t bits = 8;         ///< number of bits of the result, 1 to 64
  uint8_t word = 1;         ///< [bytes] size of the words of a sum or xor; a last word may be shorter
  bool big_endian = false;  ///< byte order of a word
  /// true for a CRC that processes the lowest bit of each byte first; the bits of its result are then reversed too
  bool reflected = false;
  /// the checksum is the two's complement of the sum, so that the sum of all words and the checksum is zero
  bool negated = false;
  uint64_t polynomial = 0, initial = 0, final_xor = 0;
};

/// A published CRC with its name, and its published result for the text "123456789".
struct NamedCrc {
  const char* name;
  Check check;
  uint64_t published;
};

/// All published CRCs, those with fewer bits first. Names and numbers are from the catalogue of parametrised CRCs (Greg
/// Cook).
std::span<const NamedCrc> namedCrcs() noexcept;

/// [any] Returns the checksum of `bytes`. The time is proportional to their number.
uint64_t checksumOf(const Check& check, std::span<const uint8_t> bytes) noexcept;

}  // namespace hapticd::codec
