// SPDX-License-Identifier: MIT
/// Finds the byte that begins each report of a stream, if the device file gives neither an id nor a mark.
#pragma once
#include <string>

#include "capture/report_table.hpp"

namespace hapticd::capture {

/// [main] Returns one line about a header byte that is missing in the size in the device file, or about a capture that
/// begins in the middle of a report. Returns "" if neither is found.
std::string streamHint(const codec::Wire& wire, const Capture& capture, const Decoded& decoded);

}  // namespace hapticd::capture
