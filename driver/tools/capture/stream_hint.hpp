// SPDX-License-Identifier: MIT
/// The byte that begins each report of a stream, where the device file knows of neither an id nor a mark.
#pragma once
#include <string>

#include "capture/report_table.hpp"

namespace hapticd::capture {

/// [main] One line, "" if there is no hint: a header byte that the file's size leaves out, or a capture that begins in
/// the middle of a report.
std::string streamHint(const codec::Wire& wire, const Capture& capture, const Decoded& decoded);

}  // namespace hapticd::capture
