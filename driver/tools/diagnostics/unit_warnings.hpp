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

/// [main] Warns of whole numbers that begin with a zero, as in [0,05, 0], where a comma was meant as a decimal point.
void warnOfZeros(const document::Node& root, const std::string& file, document::Problems& warnings);

/// [main] Warns of an arm that a scene puts metres away, because millimetres were meant.
void warnOfMounts(const document::Node& root, const std::string& file, document::Problems& warnings);

/// [main] Warns of orientations in a scene that were probably written x, y, z, w. @param key path of `root`, for
/// messages
void warnOfTurns(const document::Node& root, const std::string& file, document::Problems& warnings,
                 const std::string& key = "");

}  // namespace hapticd::diagnostics
