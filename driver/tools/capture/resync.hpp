// SPDX-License-Identifier: MIT
/// Finds the next report in raw bytes by its id and checksum, if some bytes are missing or too many.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "codec/wire.hpp"

namespace hapticd::capture {

/// [main] Returns the position of the next report. This is `at` if a good report begins at `at` or a whole number of
/// report sizes later, because then no byte is missing. Otherwise it is the position of the next good report, and the
/// bytes before it are passed to `odd`. For reports without an id or a checksum this is always `at`, because bytes at
/// many positions would look like a report.
size_t skipOddBytes(const codec::Wire& wire, std::span<const uint8_t> bytes, size_t at,
                    const std::function<void(std::span<const uint8_t>)>& odd);

}  // namespace hapticd::capture
