// SPDX-License-Identifier: MIT
/// Finds numbers of a device file that seem to be in another unit: degrees instead of radians, millimetres instead of
/// metres.
#pragma once
#include <string>

#include "document/node.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of joint limits and a calibration pose beyond a whole turn, of a mount metres away, and of a quaternion
/// that was probably written x, y, z, w.
void warnOfUnits(const document::Node& root, const std::string& file, document::Problems& warnings);

/// [main] Returns true if the limits of a joint are beyond a whole turn, so that warnOfUnits() warns of them.
bool hasLimitsBeyondATurn(const document::Node& root);

}  // namespace hapticd::diagnostics
