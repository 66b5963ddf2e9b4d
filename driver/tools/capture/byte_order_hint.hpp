// SPDX-License-Identifier: MIT
/// Finds positions that are read in the wrong byte order.
#pragma once
#include <string>
#include <vector>

#include "codec/report.hpp"

namespace hapticd::capture {

/// [main] Returns one line if a joint moves far more smoothly when its bytes are read in the other order, or if its
/// positions look like random numbers in either order; otherwise "".
/// @param positions in all good reports, as `field` reads them; of positions that wrap, turns may have been counted
std::string wrongByteOrder(const codec::Field& field, const std::vector<double>& positions);

}  // namespace hapticd::capture
