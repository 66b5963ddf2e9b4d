// SPDX-License-Identifier: MIT
/// Distinguishes joints that slide from those that turn, and angles in degrees from those in rad.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "document/csv.hpp"
#include "host/device_instance.hpp"

namespace hapticd::cli {

/// [main] Returns true for a joint that slides: it moves the tip a metre per metre, and does not turn it.
bool slides(const host::DeviceInstance& device, uint32_t joint);

/// [main] Warns of the first number in a table of joint positions that is more than a turn, because it is probably in
/// degrees. @param columns the column of the table for each joint
void warnOfDegrees(const std::string& file, const document::CsvTable& table, const std::vector<size_t>& columns,
                   const host::DeviceInstance& device);

}  // namespace hapticd::cli
