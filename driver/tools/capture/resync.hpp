// SPDX-License-Identifier: MIT
/// Raw bytes of numbered reports in which some bytes are missing or too many: the next report is found by its id and
/// checksum.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "codec/wire.hpp"

namespace hapticd::capture {

/// [main] Where the next report begins: at `at`, unless no good report is there, none follows it in step, and a good
/// one is found at another place. The bytes between go to `odd`. Reports without an id or a checksum stay where they
/// are, because too many places would look like one.
size_t skipOddBytes(const codec::Wire& wire, std::span<const uint8_t> bytes, size_t at,
                    const std::function<void(std::span<const uint8_t>)>& odd);

}  // namespace hapticd::capture
