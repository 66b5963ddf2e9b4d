// SPDX-License-Identifier: MIT
/// Which report id and size the bytes of a capture have, where they do not have those of the device file.
#pragma once
#include <string>

#include "capture/report_table.hpp"

namespace hapticd::capture {

inline constexpr double kNearlyAll = 0.8;  ///< share of the reports: a layout that fits so many is right

/// [any] "0x3c".
std::string hexByte(int byte);

/// [main] One line, "" where size and id are right: an id that the file lacks or another one, reports without their id,
/// reports of another size, several in one line of text.
std::string layoutHint(const codec::Wire& wire, const Capture& capture, const Decoded& decoded);

}  // namespace hapticd::capture
