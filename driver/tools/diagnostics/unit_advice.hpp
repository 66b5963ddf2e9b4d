// SPDX-License-Identifier: MIT
/// Numbers of a device file that look like another unit: degrees for radians, millimetres for metres.
#pragma once
#include <string>

#include "document/node.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of joint limits and a calibration pose beyond a whole turn, of a mount metres away, and of a quaternion
/// that was probably written x, y, z, w.
void adviseUnits(const document::Node& root, const std::string& file, document::Problems& warnings);

/// [main] Warns of whole numbers that begin with a zero, as in [0,05, 0]: the comma separated two numbers.
void adviseZeros(const document::Node& root, const std::string& file, document::Problems& warnings);

}  // namespace hapticd::diagnostics
