// SPDX-License-Identifier: MIT
#include "kernels/part/crc32c.hpp"

#include <array>
#include <cstring>

namespace hapticd::brep {
namespace {

constexpr std::uint32_t kPolynomial = 0x82f63b78u;  // bits in reflected order
constexpr std::size_t kSlices = 8;
using Tables = std::array<std::array<std::uint32_t, 256>, kSlices>;

constexpr Tables makeTables() {
  Tables tables{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t crc = i;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? kPolynomial : 0u);
    tables[0][i] = crc;
  }
  for (std::size_t slice = 1; slice < kSlices; ++slice)
    for (std::size_t i = 0; i < 256; ++i) {
      const std::uint32_t before = tables[slice - 1][i];
      tables[slice][i] = (before >> 8) ^ tables[0][before & 0xffu];
    }
  return tables;
}
constexpr Tables kTables = makeTables();

}  // namespace

/// Takes eight bytes per step, with eight tables (Kounavis & Berry 2005, "A systematic approach to building high
/// performance software-based CRC generators").
std::uint32_t crc32c(std::span<const std::byte> bytes) noexcept {
  std::uint32_t crc = 0xffffffffu;
  std::size_t i = 0;
  for (; i + kSlices <= bytes.size(); i += kSlices) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, bytes.data() + i, sizeof eight);
    eight ^= crc;
    crc = 0;
    for (std::size_t k = 0; k < kSlices; ++k) crc ^= kTables[kSlices - 1 - k][(eight >> (8 * k)) & 0xffu];
  }
  for (; i < bytes.size(); ++i) crc = (crc >> 8) ^ kTables[0][(crc ^ static_cast<std::uint32_t>(bytes[i])) & 0xffu];
  return ~crc;
}

}  // namespace hapticd::brep
