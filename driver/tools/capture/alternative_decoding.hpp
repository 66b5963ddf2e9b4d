// SPDX-License-Identifier: MIT
/// Finds positions that become plausible if the same bits are read differently, such as signed instead of unsigned,
/// or reversed.
#pragma once
#include <string>
#include <vector>

#include "codec/report.hpp"

namespace hapticd::capture {

/// The range between the stops of a joint [rad or m].
struct Stops {
  bool given = false;  ///< false if the stops are unknown, so that every position is possible
  /// false if the zero of the positions is unknown: then only the distance between the stops is used
  bool placed = false;
  double low = 0, high = 0;
};

/// [main] Returns whether the positions leave the range between the stops. If the zero is unknown, returns whether they
/// span more than this range.
bool leavesStops(const std::vector<double>& positions, const Stops& stops);

/// [main] Returns one line if the positions jump by nearly the whole range of their field, or if they leave the stops
/// and another reading does not. The line names the type, scale or offset of that reading. Returns "" if neither is
/// true. @param positions in all good reports, as `field` reads them
std::string alternativeDecoding(const codec::Field& field, const std::vector<double>& positions, const Stops& stops);

}  // namespace hapticd::capture
