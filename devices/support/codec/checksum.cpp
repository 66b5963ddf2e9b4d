// SPDX-License-Identifier: MIT
#include "codec/checksum.hpp"

#include <algorithm>

#include "codec/bits.hpp"

namespace hapticd::codec {
namespace {

constexpr NamedCrc crc(const char* name, uint8_t bits, uint64_t polynomial, uint64_t initial, bool reflected,
                       uint64_t final_xor, uint64_t published) {
  return {name, {Checksum::kCrc, bits, 1, false, reflected, false, polynomial, initial, final_xor}, published};
}

constexpr NamedCrc kNamed[] = {
    crc("crc5-usb", 5, 0x05, 0x1f, true, 0x1f, 0x19),
    crc("crc7-mmc", 7, 0x09, 0x00, false, 0x00, 0x75),
    crc("crc8", 8, 0x07, 0x00, false, 0x00, 0xf4),
    crc("crc8-autosar", 8, 0x2f, 0xff, false, 0xff, 0xdf),
    crc("crc8-j1850", 8, 0x1d, 0xff, false, 0xff, 0x4b),
    crc("crc8-maxim", 8, 0x31, 0x00, true, 0x00, 0xa1),
    crc("crc8-rohc", 8, 0x07, 0xff, true, 0x00, 0xd0),
    crc("crc15-can", 15, 0x4599, 0x0000, false, 0x0000, 0x059e),
    crc("crc16", 16, 0x1021, 0xffff, false, 0x0000, 0x29b1),
    crc("crc16-ccitt-false", 16, 0x1021, 0xffff, false, 0x0000, 0x29b1),
    crc("crc16-arc", 16, 0x8005, 0x0000, true, 0x0000, 0xbb3d),
    crc("crc16-genibus", 16, 0x1021, 0xffff, false, 0xffff, 0xd64e),
    crc("crc16-kermit", 16, 0x1021, 0x0000, true, 0x0000, 0x2189),
    crc("crc16-mcrf4xx", 16, 0x1021, 0xffff, true, 0x0000, 0x6f91),
    crc("crc16-modbus", 16, 0x8005, 0xffff, true, 0x0000, 0x4b37),
    crc("crc16-usb", 16, 0x8005, 0xffff, true, 0xffff, 0xb4c8),
    crc("crc16-x25", 16, 0x1021, 0xffff, true, 0xffff, 0x906e),
    crc("crc16-xmodem", 16, 0x1021, 0x0000, false, 0x0000, 0x31c3),
    crc("crc24-openpgp", 24, 0x864cfb, 0xb704ce, false, 0x000000, 0x21cf02),
    crc("crc32", 32, 0x04c11db7, 0xffffffff, true, 0xffffffff, 0xcbf43926),
    crc("crc32-bzip2", 32, 0x04c11db7, 0xffffffff, false, 0xffffffff, 0xfc891918),
    crc("crc32-mpeg2", 32, 0x04c11db7, 0xffffffff, false, 0x00000000, 0x0376e6e7),
    crc("crc32c", 32, 0x1edc6f41, 0xffffffff, true, 0xffffffff, 0xe3069283),
    crc("crc64-ecma", 64, 0x42f0e1eba9ea3693, 0, false, 0, 0x6c40df5f0b497347),
    crc("crc64-xz", 64, 0x42f0e1eba9ea3693, ~uint64_t{0}, true, ~uint64_t{0}, 0x995dc9bbdf1939fa),
};

uint64_t mirrored(uint64_t value, unsigned bits) noexcept {
  uint64_t out = 0;
  for (unsigned i = 0; i < bits; ++i) out |= (value >> i & 1) << (bits - 1 - i);
  return out;
}

/// Works bit by bit: a report has few bytes, and a table for each polynomial would be larger than many reports.
uint64_t remainder(const Check& check, std::span<const uint8_t> bytes) noexcept {
  const uint64_t ones = onesOf(check.bits);
  if (check.reflected) {
    const uint64_t polynomial = mirrored(check.polynomial, check.bits);
    uint64_t sum = mirrored(check.initial, check.bits);
    for (const uint8_t byte : bytes)
      for (unsigned i = 0; i < 8; ++i) sum = sum >> 1 ^ (((sum ^ byte >> i) & 1) != 0 ? polynomial : 0);
    return sum;
  }
  uint64_t sum = check.initial & ones;
  for (const uint8_t byte : bytes)
    for (int i = 7; i >= 0; --i) {
      const bool carry = ((sum >> (check.bits - 1) ^ byte >> i) & 1) != 0;
      sum = (sum << 1 & ones) ^ (carry ? check.polynomial : 0);
    }
  return sum;
}

}  // namespace

std::span<const NamedCrc> namedCrcs() noexcept {
  return kNamed;
}

uint64_t checksumOf(const Check& check, std::span<const uint8_t> bytes) noexcept {
  uint64_t sum = check.initial;
  if (check.method == Checksum::kCrc) {
    sum = remainder(check, bytes);
  } else {
    for (size_t i = 0; i < bytes.size(); i += check.word) {
      const auto bits = static_cast<unsigned>(8 * std::min<size_t>(check.word, bytes.size() - i));
      const uint64_t word = getBits(&bytes[i], 0, bits, check.big_endian);
      sum = check.method == Checksum::kSum ? sum + word : sum ^ word;
    }
    if (check.negated) sum = ~sum + 1;
  }
  return (sum ^ check.final_xor) & onesOf(check.bits);
}

}  // namespace hapticd::codec
