// SPDX-License-Identifier: MIT
/// Positions that another reading of the same bits makes plausible: the other sign of a type, the other way round.
#pragma once
#include <string>
#include <vector>

#include "codec/report.hpp"

namespace hapticd::capture {

/// Where a joint can be [rad or m].
struct Stops {
  bool given = false;   ///< false: anywhere
  bool placed = false;  ///< false: its zero is unknown, so only the range between them counts
  double low = 0, high = 0;
};

/// [main] True if the positions leave the stops, or span more than the range between them.
bool leavesStops(const std::vector<double>& positions, const Stops& stops);

/// [main] One line about positions that jump by nearly the whole range of their field, or that leave the stops where
/// another reading does not: which type, scale or offset that is. "": nothing to say.
/// @param positions in all good reports, as `field` reads them
std::string otherReading(const codec::Field& field, const std::vector<double>& positions, const Stops& stops);

}  // namespace hapticd::capture
