// SPDX-License-Identifier: MIT
/// Finds the next report by its id and checksum in raw bytes in which some bytes are missing or too many.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "codec/wire.hpp"

namespace hapticd::capture {

/// [main] Returns where the next report begins. This is `at`, unless there is no good report at `at`, none one or more
/// report sizes later, and a good one at another place. The bytes in between are passed to `odd`. For reports without
/// an id or a checksum this is always `at`, because too many places would look like a report.
size_t skipOddBytes(const codec::Wire& wire, std::span<const uint8_t> bytes, size_t at,
                    const std::function<void(std::span<const uint8_t>)>& odd);

}  // namespace hapticd::capture
