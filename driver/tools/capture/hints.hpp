// SPDX-License-Identifier: MIT
/// Looks for a property that most bad reports of a capture share, and finds from it what is probably wrong in the
/// device file.
#pragma once
#include <string>

#include "capture/report_table.hpp"

namespace hapticd::capture {

/// [main] Returns one line per hint, or "" if there is none. Hints are about a missing or wrong report id, a wrong
/// size, several reports in one line, or a checksum with another method, byte order or range.
std::string hintsOf(const codec::Wire& wire, const Capture& capture, const Decoded& decoded);

}  // namespace hapticd::capture
