// SPDX-License-Identifier: MIT
/// Finds the report id and size that the reports of a capture have, if they differ from those in the device file.
#pragma once
#include <string>

#include "capture/report_table.hpp"

namespace hapticd::capture {

inline constexpr double kNearlyAll = 0.8;  ///< a layout that fits at least this share of the reports is right

/// [any] Returns the byte as text, such as "0x3c".
std::string hexByte(int byte);

/// [main] Returns one line, or "" if size and id are right. The line names a missing or wrong id, reports without their
/// id, reports of another size, or several reports in one line of text.
std::string layoutHint(const codec::Wire& wire, const Capture& capture, const Decoded& decoded);

}  // namespace hapticd::capture
