// SPDX-License-Identifier: MIT
/// Finds numbers of a row that its report cannot carry at all, because other buttons, counters or flags would be sent.
#pragma once
#include <string>

#include "codec/wire.hpp"

namespace hapticd::capture {

/// [main] Returns what is wrong with a button mask, counter, clock or flag for encodeRow(), such as "5, expected 0 to
/// 3: ..."; "" if the report can carry it, or if the column belongs to a joint (see Saturation).
/// @param to_arm true for a command to the arm; false for a report from it
std::string beyondField(const codec::Wire& wire, bool to_arm, const std::string& column, double value);

}  // namespace hapticd::capture
