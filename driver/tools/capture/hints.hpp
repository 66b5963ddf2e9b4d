// SPDX-License-Identifier: MIT
/// What the bad reports of a capture have in common, and so what is probably wrong in the device file.
#pragma once
#include <string>

#include "capture/report_table.hpp"

namespace hapticd::capture {

/// [main] One line per hint, "" if there is none: a report id that the file does not give or another one, a wrong size,
/// several reports in one line, a checksum of another method, byte order or range.
std::string hintsOf(const codec::Wire& wire, const Capture& capture, const Decoded& decoded);

}  // namespace hapticd::capture
