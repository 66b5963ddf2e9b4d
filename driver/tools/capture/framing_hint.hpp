// SPDX-License-Identifier: MIT
/// Finds out why hardly any reports are found in a stream with framing: the marks or escapes in the device file are
/// wrong or missing.
#pragma once
#include <string>

#include "capture/report_table.hpp"

namespace hapticd::capture {

/// [main] Returns one line, or "" if the framing is right. The line names the marks and escapes with which most reports
/// would be good, or says that a mark of the file does not occur in the capture or that most bytes are not between
/// marks.
std::string framingHint(const codec::Wire& wire, const Capture& capture, const Decoded& decoded);

}  // namespace hapticd::capture
