// SPDX-License-Identifier: MIT
/// CRC-32C (Castagnoli), the checksum of sections of part files.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace hapticd::brep {

/// [any] CRC-32C of bytes: reflected polynomial 0x82f63b78, initial value and final xor 0xffffffff (RFC 3720, B.4).
std::uint32_t crc32c(std::span<const std::byte> bytes) noexcept;

}  // namespace hapticd::brep
